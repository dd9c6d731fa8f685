"""Rays at spheres in the regimes where methods fail, and what a correct tracer may answer.

The judge solves |b + λv| = r, b = o - c, for the numbers as given (v need not be unit) in the perpendicular form:
λ = λm ∓ sqrt((r - d)(r + d)/v∘v) with λm = -b∘v/v∘v and d = |b + λm v|. Its own error is 4u(D + D·s/cos)·r
at u = 2^-53, D = |b|/r, s = d/r, cos² = 1 - s² (error laws: docs/laws.md).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracles.laws.arrays import JUDGE, Reals, dot, length, scaled, table
from oracles.laws.dice import Dice

Flags = NDArray[np.bool_]

SAFETY = 2.0
"""On the maxima that were measured for the lecture's formula (docs/laws.md)."""

EXTENT = 6.0
"""No scene of the catalogue in which rays start on surfaces reaches farther from its origin."""

NEAR = EXTENT * np.sqrt(8.0 * 2.0**-24)
"""Hits nearer than this may be skipped: a tracer has one least distance for all scenes, and L·sqrt(8u) is
lawful in the largest of these (docs/tolerance.md, "Where a ray starts")."""

REGIMES = ("ordinary", "far", "grazing", "huge floor", "far from the origin", "inside")


@dataclass(frozen=True)
class Rays:
    """Rays (o, v) and spheres (c, r), as the tracer's precision holds them."""

    o: Reals
    v: Reals
    c: Reals
    r: Reals

    def table(self) -> Reals:
        """The arguments of `sphere`."""
        return table(self.o, self.v, self.c, self.r)


@dataclass(frozen=True)
class Roots:
    """The truth about a ray and a sphere, and how far a correct tracer may be from it.

    near, far: λ1 <= λ2 (of the closest approach where there is no hit); dt: bound on the error of
    either; inside: s < 1 beyond doubt, outside: s > 1 beyond doubt; cos: |n∘v| at the hits.
    """

    near: Reals
    far: Reals
    dt: Reals
    inside: Flags
    outside: Flags
    cos: Reals

    @property
    def hits_near(self) -> Flags:
        """The near root is the answer, beyond doubt."""
        sure: Flags = self.inside & (self.near > NEAR + self.dt)
        return sure

    @property
    def hits_far(self) -> Flags:
        """The near root lies behind and the far one is the answer, beyond doubt."""
        sure: Flags = self.inside & (self.near < -self.dt) & (self.far > NEAR + self.dt)
        return sure

    @property
    def misses(self) -> Flags:
        """There is no hit before the ray, beyond doubt."""
        return self.outside | (self.inside & (self.far < -self.dt))

    @property
    def first(self) -> Reals:
        """The answer where it is beyond doubt."""
        return np.where(self.hits_near, self.near, self.far)


def rays(dice: Dice, s_low: float = 0.0, s_high: float = 1.0, regimes: tuple[str, ...] = REGIMES) -> Rays:
    """Rays that pass the centre at the distance s·r, s in [s_low, s_high), towards the sphere from D radii away.

    Regimes: D up to 2^30 (far), |1-s| down to 2^-40 (grazing), D = 1 + h with h down to 2^-20 and r up to 2^20
    (huge floor), c at up to 2^20 r (far from the origin), D < 1 (inside).
    """
    regime = np.array([REGIMES.index(name) for name in regimes])[dice.regime(*regimes)]
    v, a, b = dice.frame()
    x, y = dice.circle()
    e = scaled(a, x) + scaled(b, y)
    r = dice.size(-2, 3)
    r = np.where(regime == 3, np.ldexp(r, 8 + dice.choice(8)), r)
    s = s_low + (s_high - s_low) * dice.roll()
    edge = 1.0 + np.copysign(np.ldexp(1.0, -3 - dice.choice(37)), (s_low + s_high) - 2.0)
    s = np.where(regime == 2, edge, s)
    distance = _distance(dice, regime, s)
    c = dice.point(4.0) + scaled(dice.point(1.0), np.where(regime == 4, np.ldexp(r, dice.choice(21)), 0.0))
    s = np.where(regime == 5, s * distance, s)
    along = np.sqrt(np.maximum(0.0, distance * distance - s * s))
    v, c, r = dice.round(v), dice.round(c), dice.round(r)
    return Rays(dice.round(c + scaled(scaled(e, s) - scaled(v, along), r)), v, c, r)


def _distance(dice: Dice, regime: NDArray[np.int64], s: Reals) -> Reals:
    """D: how many radii from the centre the rays begin."""
    small, fraction = dice.size(-2, 4), dice.roll()
    far, height = np.ldexp(small, 4 + dice.choice(22)), np.ldexp(1.0, -1 - dice.choice(20))
    beyond = np.maximum(1.0, s)
    return np.select(
        [regime == 1, regime == 3, regime == 5], [beyond * far, beyond * (1.0 + height), fraction], beyond + small
    )


def roots(given: Rays, u: float) -> Roots:
    """The truth about these rays for a tracer of unit roundoff u.

    Error laws of the lecture's formula, twice what was measured at most, which the more careful forms stay under:
    |dλ| <= 4u(D + D²/cos)·r, wrong decisions only where |s - 1| < 3u·D². Near tangency the root of a discriminant
    that is off by e is off by at most sqrt(e), so the error stays under sqrt(6u)·D too. D counts at least 1.
    """
    b = given.o - given.c
    vv = dot(given.v, given.v)
    closest = -dot(b, given.v) / vv
    d = length(b + scaled(given.v, closest))
    D = np.maximum(length(b) / given.r, 1.0)
    s = d / given.r
    cos2 = (1.0 - s) * (1.0 + s)
    cos = np.sqrt(np.maximum(cos2, 0.0))
    half = given.r * cos / np.sqrt(vv)
    with np.errstate(divide="ignore", over="ignore"):
        steep = SAFETY * 4.0 * u * (D + D * D / cos) + 4.0 * JUDGE * D * (1.0 + 1.0 / cos)
    flat = SAFETY * 4.0 * u * D + np.sqrt(SAFETY * 6.0 * u) * D
    band = (SAFETY * 3.0 * u * D + 4.0 * JUDGE) * D
    dt = given.r * np.minimum(steep, flat)
    return Roots(closest - half, closest + half, dt, s < 1.0 - band, s > 1.0 + band, cos)
