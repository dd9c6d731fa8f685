"""Laws of local light: the cosine, and the lobe about the mirror direction.

Cases are made in the plane of incidence: the light at the angle θ from n, the eye at θ - δ on the other side, so δ is
the eye's distance from the mirror direction and the specular factor is cos^s δ, without the reflection formula.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from oracles.laws.arrays import JUDGE, Reals, dot, length, scaled, table, wide
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law
from oracles.laws.rays import SAFETY
from reference_tracer.numbers import TINY_32, TINY_64

COSINE = "uRT-06-RT2-2DLight"
EFFECT = "Phong Effect"
RESULT = "Phong's effect Result"

BASE = 20.0
"""Units of u that r∘(-v) may be off by: 9 of the reflection, 4 of the inner product, and what rounding leaves of
three unit vectors."""

FLUSHED = {2.0**-24: TINY_32, 2.0**-53: TINY_64}
"""Powers below this may be taken as 0: subnormals are flushed by some processors' vector units, and our own lanes take
so much to be 0 that all of them agree."""


@dataclass(frozen=True)
class Lamp:
    """Light direction i, normal n, travelling ray v, exponent s; x = cosδ, lit = cosθ."""

    i: Reals
    n: Reals
    v: Reals
    s: Reals
    x: Reals
    lit: Reals
    u: float

    def table(self) -> Reals:
        """The arguments of `phong`."""
        return table(self.i, self.n, self.v, self.s)

    @property
    def bound(self) -> Reals:
        """On the specular factor.

        S·x^(s-1) times the error of x, and 5s + 4 roundings of a power (the worst library measured lost 4.3u·s);
        doubled.
        """
        e = SAFETY * BASE * self.u + 16.0 * JUDGE
        top = np.maximum(self.x, 0.0) + e
        return (
            self.s * top ** (self.s - 1.0) * e + SAFETY * (5.0 * self.s + 4.0) * self.u * top**self.s + FLUSHED[self.u]
        )


def lamps(dice: Dice, low: float = 0.0, high: float = 0.45, away: tuple[float, float] = (0.0, 0.45)) -> Lamp:
    """θ from low to high and δ from away[0] to away[1], in turns of π; shininess 1 to 255."""
    n, a, b = dice.frame()
    x, y = dice.circle()
    e = scaled(a, x) + scaled(b, y)
    θ, δ = np.pi * dice.uniform(low, high), np.pi * dice.uniform(*away)
    s = np.floor(dice.size(0, 8))
    i = scaled(n, np.cos(θ)) + scaled(e, np.sin(θ))
    eye = scaled(n, np.cos(θ - δ)) - scaled(e, np.sin(θ - δ))
    return _lamp(dice.round(i), dice.round(n), dice.round(-eye), s, np.cos(δ), dice.u)


def _lamp(i: Reals, n: Reals, v: Reals, s: Reals, x: Reals, u: float) -> Lamp:
    return Lamp(i, n, v, s, x, dot(i, n), u)


@law("phong/lambert", "the diffuse factor is the cosine of the light's angle", COSINE, "cosθ = i∘n")
def lambert(dice: Dice, ask: Ask) -> Reading:
    """By the law of cosines |i - n|² = |i|² + |n|² - 2 i∘n.

    Tolerance: 4u of the inner product, doubled, and the judge's.
    """
    given = lamps(dice)
    gap = length(given.i - given.n)
    cosine = (dot(given.i, given.i) + dot(given.n, given.n) - gap * gap) / 2.0
    answer = ask("phong", given.table())[:, 0]
    return Reading("max(i∘n, 0)", answer, cosine, np.full(dice.count, SAFETY * 4.0 * dice.u + 8.0 * JUDGE))


@law(
    "phong/dark-behind", "a light behind the surface gives nothing", "Ex) Bad and Good Case", "i∘n < 0: both factors 0"
)
def dark_behind(dice: Dice, ask: Ask) -> Reading:
    """Both factors are clamped: exactly 0, no tolerance, where i∘n is below 0 beyond its rounding."""
    given = lamps(dice, 0.55, 1.0, (0.0, 2.0))
    sure = given.lit < -16.0 * dice.u
    zeros = np.zeros((dice.count, 2))
    return Reading("both factors", ask("phong", given.table()), zeros, wide(np.zeros(dice.count), sure)[:, None])


@law("phong/range", "both factors lie between 0 and 1", EFFECT, "0 <= i∘n, (r∘(-v))^s <= 1")
def in_range(dice: Dice, ask: Ask) -> Reading:
    """Cosines of unit vectors, and powers of them. Above 1 by at most the bounds at cosine 1."""
    given = lamps(dice, 0.0, 1.0, (0.0, 2.0))
    answers = ask("phong", given.table())
    outside = np.maximum(np.maximum(answers - 1.0, 0.0), np.maximum(-answers, 0.0))
    bright = replace(given, x=np.ones(dice.count)).bound
    bound = np.stack([np.full(dice.count, SAFETY * 8.0 * dice.u), bright], axis=1)
    return Reading("distance from [0, 1]", outside, np.zeros((dice.count, 2)), bound)


@law("phong/peak", "in the mirror direction the highlight is 1", EFFECT, "(r∘(-v))^s = 1 for -v = r")
def peak(dice: Dice, ask: Ask) -> Reading:
    """The eye stands where the light is mirrored to, made from θ without the reflection formula.

    Tolerance: s times the error of the base.
    """
    given = lamps(dice, away=(0.0, 0.0))
    answer = ask("phong", given.table())[:, 1]
    return Reading("specular factor", answer, np.ones(dice.count), wide(given.bound, given.lit > 16.0 * dice.u))


@law("phong/lobe", "off the mirror direction the highlight falls as cos^s", RESULT, "(r∘(-v))^s = cos^s δ")
def lobe(dice: Dice, ask: Ask) -> Reading:
    """Closed form in the plane of incidence. (The slide's 2n - i has its lobe elsewhere, at atan(sinθ/(2 - cosθ)))."""
    given = lamps(dice)
    answer = ask("phong", given.table())[:, 1]
    sure = (given.lit > 16.0 * dice.u) & (given.x > SAFETY * BASE * dice.u)
    return Reading("specular factor", answer, np.maximum(given.x, 0.0) ** given.s, wide(given.bound, sure))


@law(
    "phong/dark-away",
    "more than a quarter turn from the mirror direction there is no highlight",
    EFFECT,
    "r∘(-v) < 0: 0",
)
def dark_away(dice: Dice, ask: Ask) -> Reading:
    """An even power of a negative cosine is positive: the product is clamped before the power. Exactly 0."""
    given = lamps(dice, away=(0.55, 1.45))
    answer = ask("phong", given.table())[:, 1]
    zeros = np.zeros(dice.count)
    return Reading("specular factor", answer, zeros, wide(zeros, given.x < -SAFETY * BASE * dice.u))


@law("phong/exponents-add", "exponents add", EFFECT, "S(s + t) = S(s)·S(t)")
def exponents_add(dice: Dice, ask: Ask) -> Reading:
    """The base is the same number in all three, whatever its error.

    Only the powers' own roundings count, 5s + 4 each.
    """
    given = lamps(dice)
    t = np.floor(dice.size(0, 6))
    first = ask("phong", given.table())[:, 1]
    second = ask("phong", table(given.i, given.n, given.v, t))[:, 1]
    both = ask("phong", table(given.i, given.n, given.v, given.s + t))[:, 1]
    bound = SAFETY * (10.0 * (given.s + t) + 12.0) * dice.u * np.abs(first * second) + 4.0 * FLUSHED[dice.u]
    return Reading("S(s + t)", both, first * second, wide(bound, given.lit > 16.0 * dice.u))


@law("phong/reciprocal", "light and eye may change places", EFFECT, "S(i, v) = S(-v, -i)")
def reciprocal(dice: Dice, ask: Ask) -> Reading:
    """r(i)∘e = i∘r(e): a mirroring is symmetric (Helmholtz). Asked where both stand before the surface; both bounds."""
    given = lamps(dice, 0.0, 0.45, (0.0, 0.4))
    swapped = table(-given.v, given.n, -given.i, given.s)
    first, second = ask("phong", given.table())[:, 1], ask("phong", swapped)[:, 1]
    sure = (given.lit > 16.0 * dice.u) & (-dot(given.v, given.n) > 16.0 * dice.u)
    return Reading("S(-v, -i)", second, first, wide(2.0 * given.bound, sure))


@law("phong/rotate", "a turned or mirrored world is lit alike", EFFECT, "S(Ri, Rn, Rv) = S(i, n, v)")
def rotate(dice: Dice, ask: Ask) -> Reading:
    """R permutes and negates components, which is exact. Both bounds."""
    given = lamps(dice)
    turn = dice.turn()
    first = ask("phong", given.table())
    second = ask("phong", table(turn(given.i), turn(given.n), turn(given.v), given.s))
    bound = np.stack([np.full(dice.count, SAFETY * 8.0 * dice.u), 2.0 * given.bound], axis=1)
    sure = given.lit > 16.0 * dice.u
    return Reading("both factors", second, first, wide(bound.T, sure).T)
