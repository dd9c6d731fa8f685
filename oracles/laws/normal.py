"""Laws of the sphere's normal."""

from __future__ import annotations

import numpy as np

from oracles.laws.arrays import Reals, cross, dot, length, scaled, table, unit
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law

SLIDE = "Ray Tracing with a Sphere"
FORMULA = "n = (p - c)/|p - c|"


def points(dice: Dice) -> tuple[Reals, Reals, Reals, Reals]:
    """Points p on spheres (c, r), near the origin or up to 2^10 radii away, and the bound on n.

    p is rounded, so it lies off the sphere: dividing by r instead of |p - c| is lawful and makes the normal too long or
    too short by that share, which is known. Beyond it p - c, the length and the quotient are off by at most 8u.
    """
    regime = dice.regime("ordinary", "far from the origin")
    n, _, _ = dice.frame()
    r = dice.round(dice.size(-3, 10))
    c = dice.round(dice.point(4.0) + scaled(dice.point(1.0), np.where(regime == 1, np.ldexp(r, dice.choice(10)), 0.0)))
    p = dice.round(c + scaled(n, r))
    return p, c, r, 8.0 * dice.u + np.abs(length(p - c) / r - 1.0)


@law("normal/unit", "the normal has length 1", SLIDE, "|n| = 1")
def is_unit(dice: Dice, ask: Ask) -> Reading:
    """Every cosine of the shading rests on it. Tolerance: 8u, and how far p lies off the sphere."""
    p, c, r, bound = points(dice)
    return Reading("|n|", length(ask("normal", table(p, c, r))), np.ones(dice.count), bound)


@law("normal/radial", "the normal lies along p - c", SLIDE, FORMULA)
def is_radial(dice: Dice, ask: Ask) -> Reading:
    """A sphere is perpendicular to its radii: n × (p - c) = 0. A sine of at most 8u."""
    p, c, r, _ = points(dice)
    n = ask("normal", table(p, c, r))
    return Reading(
        "n × unit(p - c)", cross(n, unit(p - c)), np.zeros((dice.count, 3)), np.full(dice.count, 8.0 * dice.u)
    )


@law("normal/outward", "the normal points away from the centre", SLIDE, "n∘(p - c) > 0")
def is_outward(dice: Dice, ask: Ask) -> Reading:
    """Entering and leaving are told apart by the outward normal, so the formula must not turn it to the viewer.

    n∘unit(p - c) is 1 for a unit radial normal; tolerance as for the length.
    """
    p, c, r, bound = points(dice)
    n = ask("normal", table(p, c, r))
    return Reading("n∘unit(p - c)", dot(n, unit(p - c)), np.ones(dice.count), bound)


@law("normal/antipodes", "opposite points have opposite normals", SLIDE, "n(2c - p) = -n(p)")
def antipodes(dice: Dice, ask: Ask) -> Reading:
    """Symmetry about the centre. Coordinates lie on a grid, so 2c - p is exact; tolerance of both answers."""
    n, _, _ = dice.frame()
    r, c = np.round(dice.size(0, 6)), np.round(dice.point(16.0))
    p = c + np.round(scaled(n, r) * 256.0) / 256.0
    first, second = ask("normal", table(p, c, r)), ask("normal", table(2.0 * c - p, c, r))
    bound = 16.0 * dice.u + 2.0 * np.abs(length(p - c) / r - 1.0)
    return Reading("n(2c - p)", second, -first, bound)
