"""What a float is made of: significant bits, wider and back, by number type.

Formulas know no types; the methods that compute in more bits than their numbers have must. Balls and
exact numbers stay as they are: they already say how far they may be off.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from reference_tracer.lanes.ball import Ball
from reference_tracer.numbers import Number

SPLITTERS = {24: 4097.0, 53: 134217729.0}
"""2^⌈p/2⌉ + 1 for p significant bits (Veltkamp)."""


def significant_bits(x: Number) -> int | None:
    """24 or 53 for floats, alone or in lanes; None for numbers that carry their own error."""
    if isinstance(x, float):  # np.float64 too
        return 53
    if isinstance(x, np.ndarray | np.floating):
        return 24 if x.dtype == np.float32 else 53
    if _is_drjit(x):
        import drjit as dr

        return 24 if dr.itemsize_v(type(x)) == 4 else 53
    return None


def widen(x: Number) -> Number:
    """The same value in float64."""
    if isinstance(x, np.ndarray | np.floating):
        return x.astype(np.float64)
    if _is_drjit(x):
        import drjit as dr

        kind: Any = dr.float64_array_t(type(x))
        return kind(x)
    return x


def narrow(x: Number, like: Number) -> Number:
    """The float64 x rounded to the type of `like`."""
    if isinstance(like, np.ndarray | np.floating):
        return np.asarray(x).astype(like.dtype)
    if _is_drjit(like):
        narrowed: Any = type(like)
        return narrowed(x)
    # a ball has not yet seen the rounding to the narrow type; times 1 adds it
    return x * 1.0 if isinstance(x, Ball) else x


def _is_drjit(x: Number) -> bool:
    return type(x).__module__.startswith("drjit.")
