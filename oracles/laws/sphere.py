"""Laws of ray and sphere: where the hit is, which hit it is, and whether there is one."""

from __future__ import annotations

import numpy as np

from oracles.laws.arrays import JUDGE, Reals, dot, length, scaled, table, unit, wide
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law
from oracles.laws.rays import NEAR, REGIMES, Rays, rays, roots

SPHERE = "Ray Tracing with a Sphere"
PASSES = "If Ray passes the Sphere or Not"
NEAREST = "Modified FindRGB"
QUADRATIC = "λ = -b∘v ± sqrt((b∘v)² - (|b|² - r²)), b = o - c"


def hit_flags(answers: Reals) -> Reals:
    """1 where the tracer says that there is a hit, 0 where it says miss."""
    return np.where(np.isnan(answers[:, 0]), 0.0, 1.0)


@law(
    "sphere/point-on-surface",
    "the point at λ lies on the sphere",
    SPHERE,
    "|o + λv - c| = r",
)
def point_on_surface(dice: Dice, ask: Ask) -> Reading:
    """The definition of a hit, without its formula.

    Tolerance: |q|² - r² of the point q found is the error of the discriminant, 2·3u·D²·r² (the band in
    which decisions may be wrong), plus what an error of u·D·r along the ray adds; both doubled. The
    judge's own q is off by 4·2^-53·D·r.
    """
    given = rays(dice)
    answer = ask("sphere", given.table())[:, 0]
    truth = roots(given, dice.u)
    found = length(given.o - given.c + scaled(given.v, answer))
    D = np.maximum(length(given.o - given.c) / given.r, 1.0)
    bound = given.r * D * (8.0 * dice.u + 6.0 * dice.u * D + 8.0 * JUDGE)
    return Reading("|o + λv - c|", found, given.r, wide(bound, truth.hits_near | truth.hits_far))


@law("sphere/nearest-root", "of two hits ahead the nearer one is the answer", NEAREST, QUADRATIC)
def nearest_root(dice: Dice, ask: Ask) -> Reading:
    """From outside both roots are positive; light comes from the first.

    Expected from the perpendicular form; tolerance 4u(D + D²/cos)·r, doubled: what the lecture's formula needs.
    """
    given = rays(dice, regimes=REGIMES[:5])
    truth = roots(given, dice.u)
    answer = ask("sphere", given.table())[:, 0]
    return Reading("λ", answer, truth.near, wide(truth.dt, truth.hits_near))


@law("sphere/inside-far-root", "from inside the far root is the hit", PASSES, QUADRATIC)
def inside_far_root(dice: Dice, ask: Ask) -> Reading:
    """Inside, λ1 < 0 < λ2: the product of the roots is |b|² - r² < 0.

    Expected and tolerance as for the nearest root, with D counted as 1.
    """
    given = rays(dice, regimes=("inside",))
    truth = roots(given, dice.u)
    answer = ask("sphere", given.table())[:, 0]
    return Reading("λ", answer, truth.far, wide(truth.dt, truth.hits_far))


@law("sphere/nothing-behind", "a sphere behind the origin is not hit", NEAREST, "λ > 0")
def nothing_behind(dice: Dice, ask: Ask) -> Reading:
    """Both roots are negative: a hit before the ray's origin is no hit.

    Asked only where λ2 is below 0 by more than its tolerance.
    """
    given = rays(dice, regimes=REGIMES[:5])
    back = Rays(given.o, -given.v, given.c, given.r)
    answers = ask("sphere", back.table())
    truth = roots(back, dice.u)
    return Reading("hit (1) or miss (0)", hit_flags(answers), np.zeros(dice.count), wide(0.0 * truth.dt, truth.misses))


@law("sphere/hit", "a line that passes nearer than r is a hit", PASSES, "(b∘v)² - (|b|² - r²) >= 0")
def sees_hit(dice: Dice, ask: Ask) -> Reading:
    """|b - (b∘v)v| < r beyond doubt.

    That is: farther from r than the band 3u·D²·r (doubled) in which the lecture's discriminant can have either sign.

    No bound on λ: this law is about the decision alone.
    """
    given = rays(dice)
    truth = roots(given, dice.u)
    sure = truth.hits_near | truth.hits_far
    answers = ask("sphere", given.table())
    return Reading("hit (1) or miss (0)", hit_flags(answers), np.ones(dice.count), wide(0.0 * truth.dt, sure))


@law("sphere/miss", "a line that passes farther than r is a miss", PASSES, "(b∘v)² - (|b|² - r²) < 0")
def sees_miss(dice: Dice, ask: Ask) -> Reading:
    """|b - (b∘v)v| > r beyond doubt, by the same band.

    That the judge's float64 decides such cases as rational arithmetic does is tested.
    """
    given = rays(dice, 1.0, 3.0, REGIMES[:5])
    truth = roots(given, dice.u)
    answers = ask("sphere", given.table())
    zeros = np.zeros(dice.count)
    return Reading("hit (1) or miss (0)", hit_flags(answers), zeros, wide(zeros, truth.outside))


@law("sphere/centre", "a ray at the centre of a sphere hits it one radius before the centre", SPHERE, "λ = |b| - r")
def centre(dice: Dice, ask: Ask) -> Reading:
    """The closed form of the simplest hit.

    v = unit(c - o) rounded passes the centre at up to 2u·|b|, which changes λ by (2uD)²·r/2 only.

    The tolerance is that of a hit at cos = 1.
    """
    given = rays(dice, 0.0, 1.0, ("ordinary", "far", "far from the origin"))
    b = given.c - given.o
    aimed = Rays(given.o, dice.round(unit(b)), given.c, given.r)
    truth = roots(aimed, dice.u)
    answer = ask("sphere", aimed.table())[:, 0]
    stretch = np.sqrt(dot(aimed.v, aimed.v))
    off = 4.0 * dice.u * length(b)
    bound = truth.dt + off * off / given.r + 4.0 * JUDGE * length(b)
    return Reading("λ", answer, (length(b) - given.r) / stretch, wide(bound, truth.hits_near))


@law("sphere/chord", "from a point of the sphere inward, the next hit is at the chord's end", SPHERE, "λ = -2 b∘v")
def chord(dice: Dice, ask: Ask) -> Reading:
    """A ray that starts on the surface has the roots 0 and -2b∘v.

    A tracer may take 0 for a hit or skip it: the answer is one of both, and the nearer one is what it is compared
    with.

    o is rounded, off the surface by up to 2u(|c| + r): λ moves by that over cos. Asked where cos > 1/16 and the chord
    is longer than what a tracer may skip.
    """
    v, a, b = dice.frame()
    tilt = dice.uniform(0.0, 0.9)
    x, y = dice.circle()
    r, c = dice.round(dice.size(-2, 6)), dice.round(dice.point(4.0))
    n = scaled(v, -np.sqrt(1.0 - tilt * tilt)) + scaled(scaled(a, x) + scaled(b, y), tilt)
    given = Rays(dice.round(c + scaled(n, r)), dice.round(v), c, r)
    truth = roots(given, dice.u)
    answer = ask("sphere", given.table())[:, 0]
    short = np.abs(answer - truth.near) <= NEAR + truth.dt
    sure = truth.far > 2.0 * NEAR + 2.0 * truth.dt
    return Reading("λ", answer, truth.far, wide(np.where(short, np.inf, truth.dt), sure))


@law("sphere/leaving", "from a point of the sphere outward, it is not met again", SPHERE, "b∘v > 0: no root beyond 0")
def leaving(dice: Dice, ask: Ask) -> Reading:
    """The other root is -2b∘v < 0. A tracer may take the start itself for a hit, nothing farther away.

    The answer is compared with 0, within what a tracer may skip; a miss counts as 0.
    """
    v, a, b = dice.frame()
    tilt = dice.uniform(0.0, 0.9)
    x, y = dice.circle()
    r, c = dice.round(dice.size(-2, 6)), dice.round(dice.point(4.0))
    n = scaled(v, np.sqrt(1.0 - tilt * tilt)) + scaled(scaled(a, x) + scaled(b, y), tilt)
    given = Rays(dice.round(c + scaled(n, r)), dice.round(v), c, r)
    answer = ask("sphere", given.table())[:, 0]
    truth = roots(given, dice.u)
    found = np.where(np.isnan(answer), 0.0, answer)
    return Reading("λ, or 0 for miss", found, np.zeros(dice.count), NEAR + truth.dt + np.abs(truth.far))


@law("sphere/grow", "a larger sphere around the same centre is hit no later", SPHERE, "r' > r: λ' <= λ")
def grow(dice: Dice, ask: Ask) -> Reading:
    """λ1 = λm - sqrt(r² - d²) falls as r grows. r' = 5r/4; asked where the origin is outside both.

    Tolerance: the sum of both tolerances.
    """
    given = rays(dice, regimes=("ordinary", "far", "grazing", "far from the origin"))
    larger = Rays(given.o, given.v, given.c, dice.round(1.25 * given.r))
    small, large = roots(given, dice.u), roots(larger, dice.u)
    first, second = ask("sphere", given.table())[:, 0], ask("sphere", larger.table())[:, 0]
    sure = small.hits_near & large.hits_near
    return Reading("max(λ' - λ, 0)", np.maximum(second - first, 0.0), 0.0 * first, wide(small.dt + large.dt, sure))


@law("sphere/scale", "twice the lengths, twice the distance", SPHERE, "λ(ko, v, kc, kr) = k·λ(o, v, c, r)")
def scale(dice: Dice, ask: Ask) -> Reading:
    """Geometry has no unit of length. k is a power of two, so the scaled inputs are exact.

    A tracer of homogeneous formulas answers bit for bit; that is promised by no one (a least distance is
    not homogeneous), so the tolerance is that of both answers.
    """
    given = rays(dice, regimes=("ordinary", "far", "grazing", "inside"))
    k = np.ldexp(1.0, 1 + dice.choice(12))
    truth = roots(given, dice.u)
    first = ask("sphere", given.table())[:, 0]
    second = ask("sphere", table(scaled(given.o, k), given.v, scaled(given.c, k), given.r * k))[:, 0]
    sure = truth.hits_near | truth.hits_far
    return Reading("λ'/k", second / k, first, wide(2.0 * truth.dt, sure))


@law("sphere/translate", "a moved world gives the same distance", SPHERE, "λ(o + d, v, c + d, r) = λ(o, v, c, r)")
def translate(dice: Dice, ask: Ask) -> Reading:
    """Only o - c enters.

    Coordinates lie on a grid of 2^-8 and the world moves by integers up to 2^10, so the sums are exact in float32.
    Tolerance: that of both answers, which does not grow with the distance moved.
    """
    given = rays(dice, regimes=("ordinary", "inside"))
    o, c = np.round(given.o * 256.0) / 256.0, np.round(given.c * 256.0) / 256.0
    given = Rays(o, given.v, c, given.r)
    d = np.round(dice.point(1024.0))
    truth = roots(given, dice.u)
    first = ask("sphere", given.table())[:, 0]
    second = ask("sphere", table(o + d, given.v, c + d, given.r))[:, 0]
    return Reading("λ'", second, first, wide(2.0 * truth.dt, truth.hits_near | truth.hits_far))


@law("sphere/rotate", "a turned or mirrored world gives the same distance", SPHERE, "λ(Ro, Rv, Rc, r) = λ(o, v, c, r)")
def rotate(dice: Dice, ask: Ask) -> Reading:
    """Distances do not depend on the axes.

    R permutes and negates components, which is exact; sums of three may round in another order, so the tolerance is
    that of both answers.
    """
    given = rays(dice)
    turn = dice.turn()
    truth = roots(given, dice.u)
    first = ask("sphere", given.table())[:, 0]
    second = ask("sphere", table(turn(given.o), turn(given.v), turn(given.c), given.r))[:, 0]
    return Reading("λ'", second, first, wide(2.0 * truth.dt, truth.hits_near | truth.hits_far))
