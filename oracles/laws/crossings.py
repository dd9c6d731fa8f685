"""Rays through surfaces of glass in the regimes where refraction formulas fail, and their tolerance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from oracles.laws.arrays import JUDGE, Reals, cross, dot, length, scaled, table
from oracles.laws.dice import Dice
from oracles.laws.rays import SAFETY, Flags

REGIMES = ("ordinary", "near normal", "exactly normal", "near critical", "grazing")


@dataclass(frozen=True)
class Crossing:
    """Travelling rays v, outward normals n, and the index of the inside over the outside.

    eta: n2/n1 along the ray: the index entering, its inverse leaving; sin1, cos1: of the angle of incidence, for the
    numbers as given; sin2 = sin1/eta, over 1 under total reflection.
    """

    v: Reals
    n: Reals
    index: Reals
    leaving: Flags
    eta: Reals
    sin1: Reals
    cos1: Reals
    u: float

    @property
    def sin2(self) -> Reals:
        """Snell: n1 sinθ1 = n2 sinθ2."""
        return self.sin1 / self.eta

    @property
    def cos2(self) -> Reals:
        """Of the angle of refraction; 0 under total reflection."""
        return np.sqrt(np.maximum(0.0, (1.0 - self.sin2) * (1.0 + self.sin2)))

    def table(self) -> Reals:
        """The arguments of `refract`."""
        return table(self.v, self.n, self.index)

    @property
    def band(self) -> Reals:
        """How near to 1 a computed sinθ2 may lie on the wrong side.

        9u were measured at most, and sinθ1 = sqrt(1 - d²) adds 6u/sinθ1; doubled.
        """
        return (SAFETY * self.u * (9.0 + 6.0 / np.maximum(self.sin1, np.sqrt(self.u))) + 8.0 * JUDGE) / self.eta

    @property
    def passes(self) -> Flags:
        """There is a refracted ray, beyond doubt."""
        return self.sin2 < 1.0 - self.band

    @property
    def reflects(self) -> Flags:
        """There is total reflection, beyond doubt."""
        return self.sin2 > 1.0 + self.band

    @property
    def bound(self) -> Reals:
        """|t - t*| of a correct tracer.

        2u(1 + 1/cosθ2)(1 + 1/eta) for the form without division, 6u/(eta·sinθ1) more for the slide's, which near
        normal incidence is at most 3·sqrt(u)/eta; doubled.
        """
        slide = np.minimum(6.0 * self.u / np.maximum(self.sin1, self.u), 3.0 * np.sqrt(self.u)) / self.eta
        with np.errstate(divide="ignore"):
            plain = 2.0 * (self.u + 4.0 * JUDGE) * (1.0 + 1.0 / self.cos2) * (1.0 + 1.0 / self.eta)
        bound: Reals = SAFETY * (plain + slide)
        return bound


def crossing(v: Reals, n: Reals, index: Reals, u: float) -> Crossing:
    """The truth about these rays for a tracer of unit roundoff u; v and n count as unit vectors of their direction."""
    size = length(v) * length(n)
    cosine, sin1 = dot(v, n) / size, length(cross(v, n)) / size
    leaving = cosine > 0.0
    return Crossing(v, n, index, leaving, np.where(leaving, 1.0 / index, index), sin1, np.abs(cosine), u)


def crossings(dice: Dice, regimes: tuple[str, ...] = REGIMES, lowest: int = -9) -> Crossing:
    """Entering and leaving, index 1 to 2.5 or its inverse.

    Sinθ1 down to 2^-30 (near normal) and 0 (exactly normal), the critical angle to within 2^-40, cosθ1 down to
    2^lowest (grazing).
    """
    regime = np.array([REGIMES.index(name) for name in regimes])[dice.regime(*regimes)]
    n, a, b = dice.frame()
    x, y = dice.circle()
    e = scaled(a, x) + scaled(b, y)
    index = 1.5 + np.where(dice.choice(8) == 0, 0.0, dice.uniform(-0.5, 1.0))
    index = dice.round(np.where(dice.choice(2) == 1, 1.0 / index, index))
    leaving = dice.choice(2) == 1
    eta = np.where(leaving, 1.0 / index, index)
    tiny = np.ldexp(1.0, -1 - dice.choice(30))
    critical = np.where(
        eta < 1.0, eta * (1.0 + (1.0 - 2.0 * dice.choice(2)) * np.ldexp(1.0, -3 - dice.choice(38))), 0.5
    )
    low = np.ldexp(1.0, -1 - dice.choice(-lowest))
    s = np.select(
        [regime == 1, regime == 2, regime == 3, regime == 4],
        [tiny, 0.0, np.minimum(critical, 0.9999), np.sqrt(1.0 - low * low)],
        dice.uniform(0.0, 0.95),
    )
    n = dice.round(n)
    side = np.where(leaving, 1.0, -1.0)
    v = scaled(n, side * np.sqrt(1.0 - s * s)) + scaled(e, s)
    v = np.where((regime == 2)[:, None], scaled(n, side), v)
    return crossing(dice.round(v), n, index, dice.u)
