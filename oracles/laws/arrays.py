"""Vector algebra on rows, in float64: what the judge computes with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]

JUDGE = 2.0**-53
"""Unit roundoff of the judge's own arithmetic; it is added to a bound where it is not far below it."""


def dot(a: Reals, b: Reals) -> Reals:
    """a∘b of each row."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def cross(a: Reals, b: Reals) -> Reals:
    """a×b of each row."""
    ax, ay, az = a.T
    bx, by, bz = b.T
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=1)


def length(a: Reals) -> Reals:
    """|a| of each row."""
    return np.sqrt(dot(a, a))


def unit(a: Reals) -> Reals:
    """a/|a| of each row, none of them 0."""
    return a / length(a)[:, None]


def scaled(a: Reals, factor: Reals) -> Reals:
    """Rows times numbers."""
    return a * factor[:, None]


def table(*parts: Reals) -> Reals:
    """Vectors (n, 3) and numbers (n,) side by side: the arguments of an operation."""
    return np.concatenate([part[:, None] if part.ndim == 1 else part for part in parts], axis=1)


def wide(bound: Reals, sure: NDArray[np.bool_]) -> Reals:
    """The bound where the law can tell, infinity elsewhere."""
    return np.where(sure, bound, np.inf)


def excess_of_unit(a: Reals) -> Reals:
    """How far |a| is from 1: what rounding left of a unit vector."""
    return np.abs(dot(a, a) - 1.0) / 2.0
