"""Laws of ray and plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from oracles.laws.arrays import Reals, dot, length, scaled, table, wide
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law
from oracles.laws.rays import NEAR, Flags
from oracles.laws.sphere import hit_flags

PLANE = "Object Modeling in uObj"
FORMULA = "λ = (offset - n∘o)/(n∘v)"


@dataclass(frozen=True)
class Meeting:
    """Rays (o, v) and planes n∘p = offset, with the truth: λ, its bound, and whether the ray certainly meets or misses.

    The numerator is off by at most 8u(|offset| + |n||o|), the denominator by 8u|n||v|: 3u for each product of a sum of
    three, 4u for a tracer that first makes the normal unit, 1u for the quotient (Higham, Accuracy and Stability, 3.1).
    """

    o: Reals
    v: Reals
    n: Reals
    offset: Reals
    distance: Reals
    bound: Reals
    meets: Flags
    misses: Flags

    def table(self) -> Reals:
        """The arguments of `plane`."""
        return table(self.o, self.v, self.n, self.offset)


def meeting(o: Reals, v: Reals, n: Reals, offset: Reals, u: float) -> Meeting:
    """The truth about these rays for a tracer of unit roundoff u."""
    toward, above = dot(n, v), offset - dot(n, o)
    lost = 8.0 * u * (np.abs(offset) + length(n) * length(o))
    blur = 8.0 * u * length(n) * length(v)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = above / toward
        bound = (lost + np.abs(distance) * blur) / (np.abs(toward) - blur)
    sure = np.abs(toward) > blur
    bound = np.where(sure, bound, np.inf)
    return Meeting(
        o,
        v,
        n,
        offset,
        distance,
        bound,
        sure & (distance > NEAR + bound),
        (sure & (distance < -bound)) | (toward == 0.0),
    )


def meetings(dice: Dice) -> Meeting:
    """Planes of any normal at up to 2^20 from the origin, and rays above them.

    They start from a height of 2^-4 to 2^10 and fall steeply or grazing (|n∘v| down to 2^-12).

    A third of them rise and miss.
    """
    regime = dice.regime("ordinary", "grazing", "far from the origin", "rising")
    n, a, b = dice.frame()
    x, y = dice.circle()
    e = scaled(a, x) + scaled(b, y)
    down = np.where(regime == 1, np.ldexp(1.0, -1 - dice.choice(12)), dice.uniform(1.0, 0.25))
    v = scaled(n, np.where(regime == 3, down, -down)) + scaled(e, np.sqrt(1.0 - down * down))
    height = dice.size(-4, 10)
    foot = scaled(n, np.where(regime == 2, dice.size(4, 20), dice.uniform(0.0, 4.0)))
    k = dice.size(-4, 4)
    normal = dice.round(scaled(n, k))
    offset = dice.round(dot(normal, foot))
    o = dice.round(foot + scaled(n, height) + scaled(e, dice.uniform(0.0, 4.0)))
    return meeting(o, dice.round(v), normal, offset, dice.u)


@law("plane/point-on-plane", "the point at λ satisfies the plane's equation", PLANE, "n∘(o + λv) = offset")
def point_on_plane(dice: Dice, ask: Ask) -> Reading:
    """The definition of a hit. An error dλ moves the point off the plane by |n∘v|·dλ; dλ as derived in `Meeting`."""
    given = meetings(dice)
    answer = ask("plane", given.table())[:, 0]
    found = dot(given.n, given.o + scaled(given.v, answer))
    bound = given.bound * np.abs(dot(given.n, given.v))
    return Reading("n∘(o + λv)", found, given.offset, wide(bound, given.meets))


@law("plane/behind", "a plane behind the origin is not met", "Modified FindRGB", "λ > 0")
def behind(dice: Dice, ask: Ask) -> Reading:
    """The root is negative beyond its bound: the ray rises from the plane."""
    given = meetings(dice)
    answers = ask("plane", given.table())
    zeros = np.zeros(dice.count)
    return Reading("hit (1) or miss (0)", hit_flags(answers), zeros, wide(zeros, given.misses))


@law("plane/meets", "a ray that falls towards a plane meets it", PLANE, "λ > 0")
def meets(dice: Dice, ask: Ask) -> Reading:
    """The root is positive beyond its bound and beyond what a tracer may skip."""
    given = meetings(dice)
    answers = ask("plane", given.table())
    ones = np.ones(dice.count)
    return Reading("hit (1) or miss (0)", hit_flags(answers), ones, wide(0.0 * ones, given.meets))


@law("plane/parallel", "a ray parallel to a plane never meets it", PLANE, "n∘v = 0: no λ")
def parallel(dice: Dice, ask: Ask) -> Reading:
    """N lies along an axis and v across it, so n∘v is exactly 0 in every precision and order of summation."""
    x, y = dice.circle()
    zero, one = np.zeros(dice.count), np.ones(dice.count)
    turn = dice.turn()
    n = turn(np.stack([zero, one, zero], axis=1)) * 1.0
    v = dice.round(turn(np.stack([x, zero, y], axis=1)))
    o, offset = dice.round(dice.point(8.0)), dice.round(dice.uniform(0.0, 4.0))
    answers = ask("plane", table(o, v, n, offset))
    above = np.abs(offset - dot(n, o)) > 0.0
    return Reading("hit (1) or miss (0)", hit_flags(answers), zero, wide(zero, above))


@law("plane/normal-length", "the normal's length does not matter", PLANE, "λ(o, v, kn, k·offset) = λ(o, v, n, offset)")
def normal_length(dice: Dice, ask: Ask) -> Reading:
    """Both equations name the same points. k is a power of two, so the inputs are exact; both answers' tolerances."""
    given = meetings(dice)
    k = np.ldexp(1.0, 1 + dice.choice(8))
    first = ask("plane", given.table())[:, 0]
    second = ask("plane", table(given.o, given.v, scaled(given.n, k), given.offset * k))[:, 0]
    return Reading("λ'", second, first, wide(2.0 * given.bound, given.meets))


@law("plane/two-sided", "a plane is met from either side", PLANE, "λ(o, v, -n, -offset) = λ(o, v, n, offset)")
def two_sided(dice: Dice, ask: Ask) -> Reading:
    """The equation with all signs changed names the same points: a plane has no back that rays pass through."""
    given = meetings(dice)
    first = ask("plane", given.table())[:, 0]
    second = ask("plane", table(given.o, given.v, -given.n, -given.offset))[:, 0]
    return Reading("λ'", second, first, wide(2.0 * given.bound, given.meets))


@law(
    "plane/rotate",
    "a turned or mirrored world gives the same distance",
    PLANE,
    "λ(Ro, Rv, Rn, offset) = λ(o, v, n, offset)",
)
def rotate(dice: Dice, ask: Ask) -> Reading:
    """Inner products do not depend on the axes; R permutes and negates components, which is exact."""
    given = meetings(dice)
    turn = dice.turn()
    first = ask("plane", given.table())[:, 0]
    second = ask("plane", table(turn(given.o), turn(given.v), turn(given.n), given.offset))[:, 0]
    return Reading("λ'", second, first, wide(2.0 * given.bound, given.meets))
