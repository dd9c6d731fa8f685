"""Student's and Welch's t, by arb's incomplete beta function: no table, no approximation in the far tail."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from flint import arb
from numpy.typing import NDArray

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Welch:
    """Difference of two means, its standard error, and the degrees of freedom (Welch 1947, Satterthwaite 1946)."""

    difference: Reals
    error: Reals
    freedom: Reals


def welch(a: Reals, b: Reals) -> Welch:
    """Compare means along axis 0 of two sets of independent units, of unequal variances and counts (each >= 2)."""
    va, vb = (np.var(x, axis=0, ddof=1) / len(x) for x in (a, b))
    total = va + vb
    freedom = np.where(total > 0.0, total, 1.0) ** 2 / np.where(
        total > 0.0, va**2 / (len(a) - 1) + vb**2 / (len(b) - 1), 1.0
    )
    return Welch(a.mean(axis=0) - b.mean(axis=0), np.sqrt(total), freedom)


def two_sided(t: float, freedom: float) -> float:
    """P(|T| >= |t|) = I_x(ν/2, 1/2) with x = ν/(ν + t²) (DLMF 8.17, Student's distribution)."""
    if t == 0.0:
        return 1.0
    if not np.isfinite(t):
        return 0.0
    x = arb(freedom) / (arb(freedom) + arb(t) * arb(t))
    return float(x.beta_lower(arb(freedom) / 2, arb(0.5), 1).mid())


@cache
def critical(p: float, freedom: float) -> float:
    """The t whose two-sided tail is p, by bisection to 1e-9 of itself."""
    low, high = 0.0, 1.0
    while two_sided(high, freedom) > p:
        high *= 2.0
    while high - low > 1e-9 * high:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if two_sided(middle, freedom) > p else (low, middle)
    return high


def sidak(alpha: float, tests: int) -> float:
    """Rate of each of n tests so that any of them raises a false alarm at rate alpha: 1 - (1 - alpha)^(1/n)."""
    return float(-np.expm1(np.log1p(-alpha) / tests))
