"""From a linear value to the number in an image file."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Codes = NDArray[np.int64]


def lecture_codes(linear: Reals, maximum: int = 255) -> Codes:
    """floor(maximum · clamp(c, 0, 1)). L11 "Ex) Bad and Good Case": both clamps, then the byte cast."""
    return np.floor(np.clip(linear, 0.0, 1.0) * maximum).astype(np.int64)


def srgb_codes(linear: Reals, maximum: int = 255) -> Codes:
    """IEC 61966-2-1 transfer function, rounded to the nearest code."""
    c = np.clip(linear, 0.0, 1.0)
    encoded = np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.power(c, 1.0 / 2.4) - 0.055)
    return np.floor(encoded * maximum + 0.5).astype(np.int64)


def encode(linear: Any, display: str, maximum: int = 255) -> Codes:
    """Display codes 0..maximum of linear values; `display` as in the scene; monotone in `linear`."""
    values = np.nan_to_num(np.asarray(linear, dtype=np.float64), nan=0.0, posinf=1.0, neginf=0.0)
    return srgb_codes(values, maximum) if display == "srgb" else lecture_codes(values, maximum)
