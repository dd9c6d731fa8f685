"""Laws of reflection. Vectors point away from the surface: i to where the light comes from, r where it goes."""

from __future__ import annotations

import numpy as np

from oracles.laws.arrays import Reals, cross, dot, excess_of_unit, length, scaled, table
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law

SLIDE = "Math of Reflection Vector"
FORMULA = "r = 2(i∘n)n - i"


def meetings(dice: Dice) -> tuple[Reals, Reals, Reals]:
    """Directions i before surfaces n, from exactly normal to grazing incidence, and the bound on r.

    |r - r*| <= 9u was measured at most for unit vectors, doubled here (docs/laws.md). n is unit up to rounding only;
    r = 2(i∘n)n - i carries twice the excess of n∘n, which is known, and a formula may carry it another way.
    """
    regime = dice.regime("ordinary", "near normal", "grazing", "exactly normal")
    n, a, b = dice.frame()
    x, y = dice.circle()
    e = scaled(a, x) + scaled(b, y)
    tiny = np.ldexp(1.0, -1 - dice.choice(30))
    s = np.select(
        [regime == 1, regime == 2, regime == 3], [tiny, np.sqrt(1.0 - tiny * tiny / 4.0), 0.0], dice.uniform(0.0, 1.0)
    )
    n = dice.round(n)
    i = dice.round(np.where((regime == 3)[:, None], n, scaled(n, np.sqrt(1.0 - s * s)) + scaled(e, s)))
    return i, n, 18.0 * dice.u + 8.0 * excess_of_unit(n)


@law("reflect/angle", "the angle out is the angle in", SLIDE, "r∘n = i∘n")
def angle(dice: Dice, ask: Ask) -> Reading:
    """Hero's law: of all paths by way of the mirror the shortest.

    (The slide's second form 2n - i holds it for i = n only.)
    """
    i, n, bound = meetings(dice)
    return Reading("r∘n", dot(ask("reflect", table(i, n)), n), dot(i, n), bound)


@law("reflect/coplanar", "i, n and r lie in one plane", SLIDE, "(i × n)∘r = 0")
def coplanar(dice: Dice, ask: Ask) -> Reading:
    """Nothing else distinguishes a direction across the plane of incidence. |i × n| <= 1, so r's own bound serves."""
    i, n, bound = meetings(dice)
    return Reading("(i × n)∘r", dot(cross(i, n), ask("reflect", table(i, n))), np.zeros(dice.count), bound)


@law("reflect/unit", "reflection keeps the length", SLIDE, "|r| = |i|")
def is_unit(dice: Dice, ask: Ask) -> Reading:
    """A mirroring is orthogonal, so three reflections in a row need no renormalisation."""
    i, n, bound = meetings(dice)
    return Reading("|r|", length(ask("reflect", table(i, n))), length(i), bound)


@law("reflect/tangential", "the part along the surface is reversed", SLIDE, "r - (r∘n)n = -(i - (i∘n)n)")
def tangential(dice: Dice, ask: Ask) -> Reading:
    """I points back to where the light is from, so its tangential part changes sign while the normal part stays."""
    i, n, bound = meetings(dice)
    r = ask("reflect", table(i, n))
    return Reading("r + i, across n", cross(r + i, n), np.zeros((dice.count, 3)), 2.0 * bound)


@law("reflect/involution", "reflected twice, it is as before", SLIDE, "r(r(i, n), n) = i")
def involution(dice: Dice, ask: Ask) -> Reading:
    """Light paths can be reversed. Orthogonal, so the first error is not enlarged: twice the bound."""
    i, n, bound = meetings(dice)
    return Reading(
        "r(r)", ask("reflect", table(dice.round(ask("reflect", table(i, n))), n)), i, 2.0 * bound + 2.0 * dice.u
    )


@law("reflect/normal-incidence", "along the normal it comes straight back", SLIDE, "r(n, n) = n")
def normal_incidence(dice: Dice, ask: Ask) -> Reading:
    """The one case in which r = i: all of i lies along n, and nothing is reversed."""
    n = dice.round(dice.frame()[0])
    bound = 18.0 * dice.u + 8.0 * excess_of_unit(n)
    return Reading("r", ask("reflect", table(n, n)), n, bound)


@law("reflect/either-normal", "a mirror has no sides", SLIDE, "r(i, -n) = r(i, n)")
def either_normal(dice: Dice, ask: Ask) -> Reading:
    """N enters twice. Tolerance of both answers."""
    i, n, bound = meetings(dice)
    return Reading("r(i, -n)", ask("reflect", table(i, -n)), ask("reflect", table(i, n)), 2.0 * bound)


@law("reflect/rotate", "a turned or mirrored world reflects alike", SLIDE, "r(Ri, Rn) = R r(i, n)")
def rotate(dice: Dice, ask: Ask) -> Reading:
    """R permutes and negates components, which is exact. Tolerance of both answers."""
    i, n, bound = meetings(dice)
    turn = dice.turn()
    return Reading("r(Ri, Rn)", ask("reflect", table(turn(i), turn(n))), turn(ask("reflect", table(i, n))), 2.0 * bound)
