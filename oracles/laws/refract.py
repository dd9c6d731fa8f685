"""Laws of refraction. v travels, n is the outward normal: v∘n < 0 enters, v∘n > 0 leaves."""

from __future__ import annotations

import numpy as np

from oracles.laws.arrays import JUDGE, Reals, cross, dot, length, table, unit, wide
from oracles.laws.crossings import Crossing, crossing, crossings
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law

SNELL = "Refraction"
VECTOR = "Various Types of Transparency"
CODE = "Get Refraction Vector"


def total(answers: Reals) -> Reals:
    """1 where the tracer says tir, 0 where it gives a direction."""
    return np.where(np.isnan(answers).any(axis=1), 1.0, 0.0)


@law("refract/snell", "n1 sinθ1 = n2 sinθ2, entering and leaving", SNELL, "n1 sinθ1 = n2 sinθ2")
def snell(dice: Dice, ask: Ask) -> Reading:
    """The tangential component of the wave vector is continuous across the surface. |t × n| is sinθ2 of the answer.

    Tolerance: that of the direction (`Crossing.bound`), wide near the critical angle and, for the slide's form, near
    normal incidence.
    """
    given = crossings(dice)
    t = ask("refract", given.table())
    return Reading("sinθ2", length(cross(t, unit(given.n))), given.sin2, wide(given.bound, given.passes))


@law("refract/coplanar", "v, n and t lie in one plane", VECTOR, "(v × n)∘t = 0")
def coplanar(dice: Dice, ask: Ask) -> Reading:
    """By symmetry about the plane of incidence. |v × n| = sinθ1 scales the direction's error."""
    given = crossings(dice)
    side = cross(given.v, given.n)
    found = dot(side, ask("refract", given.table()))
    bound = given.bound * length(side) + 4.0 * dice.u
    return Reading("(v × n)∘t", found, np.zeros(dice.count), wide(bound, given.passes))


@law("refract/unit", "the refracted direction has length 1", VECTOR, "|t| = 1")
def is_unit(dice: Dice, ask: Ask) -> Reading:
    """The next distances along it are lengths.

    Tolerance of the direction: the slide's form is off by sqrt(u) near the normal.
    """
    given = crossings(dice)
    t = ask("refract", given.table())
    return Reading("|t|", length(t), np.ones(dice.count), wide(given.bound, given.passes))


@law("refract/forward", "the ray goes on to the other side", VECTOR, "sign(t∘n) = sign(v∘n)")
def forward(dice: Dice, ask: Ask) -> Reading:
    """A leaving ray whose normal is not turned comes back inside: L11's code does that. Compared is t∘n with ∓cosθ2."""
    given = crossings(dice)
    t = ask("refract", given.table())
    expected = np.where(given.leaving, given.cos2, -given.cos2)
    return Reading("t∘n", dot(t, unit(given.n)), expected, wide(given.bound, given.passes))


@law("refract/normal-incidence", "along the normal it goes straight through", CODE, "t(±n, n) = ±n")
def normal_incidence(dice: Dice, ask: Ask) -> Reading:
    """sinθ1 = 0, so sinθ2 = 0. p = 0 there, and the slide's p/|p| is 0/0: a missing direction breaks the law.

    Tolerance: what the slide's form errs where it does not fail, 3·sqrt(u)/eta, doubled.
    """
    given = crossings(dice, ("exactly normal",))
    t = ask("refract", given.table())
    return Reading("t", t, given.v, given.bound[:, None])


@law("refract/index-one", "without a change of medium nothing bends", SNELL, "n1 = n2: t = v")
def index_one(dice: Dice, ask: Ask) -> Reading:
    """What the invisible sphere of the catalogue rests on. Asked where cosθ1 > 2^-4."""
    drawn = crossings(dice, ("ordinary", "near normal", "exactly normal", "grazing"), lowest=-4)
    given = crossing(drawn.v, drawn.n, np.ones(dice.count), dice.u)
    t = ask("refract", given.table())
    return Reading("t", t, given.v, wide(given.bound, given.passes)[:, None])


@law("refract/beyond-critical", "beyond the critical angle there is total reflection", CODE, "n1 sinθ1 > n2: none")
def beyond_critical(dice: Dice, ask: Ask) -> Reading:
    """sinθ2 would exceed 1. Asked where it does by more than the band of wrong decisions (`Crossing.band`)."""
    given = crossings(dice, ("near critical", "grazing", "ordinary"))
    answers = ask("refract", given.table())
    return Reading(
        "tir (1) or not (0)", total(answers), np.ones(dice.count), wide(np.zeros(dice.count), given.reflects)
    )


@law("refract/below-critical", "below the critical angle there is a refracted ray", CODE, "n1 sinθ1 < n2: t exists")
def below_critical(dice: Dice, ask: Ask) -> Reading:
    """In particular always into the denser medium. The band as beyond the critical angle."""
    given = crossings(dice)
    answers = ask("refract", given.table())
    zeros = np.zeros(dice.count)
    return Reading("tir (1) or not (0)", total(answers), zeros, wide(zeros, given.passes))


def _back(given: Crossing, t: Reals, n: Reals, index: Reals, ask: Ask, dice: Dice) -> tuple[Reals, Reals]:
    """Refract t at (n, index), which restores the old direction's tangent, and the bound on the result.

    The first error grows by eta in the tangent and by sinθ1/cosθ1 in the normal part; the second has θ1 for its θ2.
    """
    total = np.isnan(t)
    t = np.where(total, given.v, t)  # where there is no ray, none can be asked about
    again = np.where(total, np.nan, ask("refract", table(dice.round(t), n, index)))
    with np.errstate(divide="ignore"):
        slope = 1.0 + 1.0 / given.cos1
    second = crossing(t, n, index, dice.u)
    restored = 4.0 * (dice.u + JUDGE) * slope * (1.0 + given.eta) + 2.0 * np.minimum(
        6.0 * dice.u / np.maximum(second.sin1, dice.u), 3.0 * np.sqrt(dice.u)
    ) * np.maximum(given.eta, 1.0)
    return again, (given.bound + dice.u) * np.maximum(given.eta, 1.0) * slope + restored * slope


@law("refract/reversible", "the way back is the way there", SNELL, "t(-t(v)) = -v")
def reversible(dice: Dice, ask: Ask) -> Reading:
    """Helmholtz: light paths can be reversed; entering becomes leaving.

    Tolerances of both refractions, the first one carried through the second; asked where cosθ1 > 2^-4.
    """
    given = crossings(dice, ("ordinary", "near normal", "grazing", "near critical"), lowest=-4)
    t = ask("refract", given.table())
    again, bound = _back(given, -t, given.n, given.index, ask, dice)
    return Reading("t(-t)", again, -given.v, wide(bound, given.passes)[:, None])


@law(
    "refract/slab",
    "behind a pane of glass the ray goes on as before",
    VECTOR,
    "entering and leaving parallel faces: t(t(v)) = v",
)
def slab(dice: Dice, ask: Ask) -> Reading:
    """The second face has the opposite outward normal and restores the angle: n1 sinθ1 = n2 sinθ2 = n1 sinθ3."""
    given = crossings(dice, ("ordinary", "near normal", "grazing", "near critical"), lowest=-4)
    t = ask("refract", given.table())
    again, bound = _back(given, t, -given.n, given.index, ask, dice)
    return Reading("t(t(v))", again, given.v, wide(bound, given.passes)[:, None])


STEP = 2.0**-17
"""Of the path's end on the surface: large against the judge's rounding, small against the curvature of a length."""


@law("refract/fermat", "the optical path is stationary", SNELL, "d/dx (n1|A - x| + n2|x - B|) = 0")
def fermat(dice: Dice, ask: Ask) -> Reading:
    """Fermat's principle, from lengths alone.

    With A = -v and B = t about the point 0, moving the point by ±h along the surface in the plane of incidence
    changes n1|A - x| + n2|x - B| only in second order.

    Tolerance: n2 times the direction's; the difference quotient adds h²·(n1 + n2) and the judge's rounding over h.
    """
    given = crossings(dice, ("ordinary", "grazing", "near critical"))
    t = ask("refract", given.table())
    along = cross(unit(given.n), unit(cross(given.v, given.n)))
    n1, n2 = np.where(given.leaving, given.index, 1.0), np.where(given.leaving, 1.0, given.index)

    def path(step: float) -> Reals:
        return n1 * length(given.v + step * along) + n2 * length(t - step * along)

    slope = (path(STEP) - path(-STEP)) / (2.0 * STEP)
    bound = n2 * given.bound + (n1 + n2) * (4.0 * STEP * STEP + 8.0 * JUDGE / STEP + 4.0 * dice.u)
    sure = given.passes & (given.sin1 > 0.0)
    return Reading("dL/dx", slope, np.zeros(dice.count), wide(bound, sure))


@law("refract/rotate", "a turned or mirrored world refracts alike", VECTOR, "t(Rv, Rn) = R t(v, n)")
def rotate(dice: Dice, ask: Ask) -> Reading:
    """R permutes and negates components, which is exact. Tolerance of both answers."""
    given = crossings(dice)
    turn = dice.turn()
    first = turn(ask("refract", given.table()))
    second = ask("refract", table(turn(given.v), turn(given.n), given.index))
    return Reading("t(Rv, Rn)", second, first, wide(2.0 * given.bound, given.passes)[:, None])


@law(
    "refract/denser-bends-inward", "into the denser medium the ray bends towards the normal", SNELL, "n2 > n1: θ2 < θ1"
)
def bends_inward(dice: Dice, ask: Ask) -> Reading:
    """The sign of the effect, which an inverted ratio has wrong: sinθ2 <= sinθ1 for eta > 1, and >= for eta < 1."""
    given = crossings(dice, ("ordinary", "grazing"))
    found = length(cross(ask("refract", given.table()), unit(given.n)))
    wrong = np.maximum(0.0, np.where(given.eta >= 1.0, found - given.sin1, given.sin1 - found))
    return Reading("bend away from Snell's side", wrong, 0.0 * given.sin1, wide(given.bound, given.passes))
