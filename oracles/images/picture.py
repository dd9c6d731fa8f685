"""What an image file holds, before anybody judges it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

ENDINGS = ("pfm", "exr", "npy", "ppm", "png")
"""Image endings a tracer may write."""


@dataclass
class ImageError(Exception):
    """An image that cannot be judged: what, where in the file or picture, and what was expected."""

    message: str
    place: str = ""
    hint: str = ""

    def __str__(self) -> str:
        place = f" at {self.place}" if self.place else ""
        hint = f"; expected {self.hint}" if self.hint else ""
        return f"{self.message}{place}{hint}"


@dataclass(frozen=True)
class Picture:
    """Decoded values, (height, width, 3), top row first.

    maximum: None for linear values, else the code of white (255 or 65535) of display-encoded
    integers; roundoff: relative spacing of the storage (2^-24 float32, 2^-11 half, 0 float64).
    """

    values: NDArray[np.float64]
    maximum: int | None = None
    roundoff: float = 0.0


def check(picture: Picture) -> Picture:
    """Raise ImageError at the first NaN or Inf; return the picture."""
    bad = np.argwhere(~np.isfinite(picture.values))
    if bad.size:
        j, i, channel = (int(x) for x in bad[0])
        value = picture.values[j, i, channel]
        more = f", {len(bad)} such values" if len(bad) > 1 else ""
        raise ImageError(f"{value} in the image{more}", f"pixel ({i}, {j}) channel {'RGB'[channel]}", "finite numbers")
    return picture


def check_size(width: int, height: int, expected: tuple[int, int]) -> None:
    """Raise ImageError unless the header's size is the expected (width, height)."""
    if (width, height) != expected:
        raise ImageError(f"image is {width}x{height}", "the header", f"{expected[0]}x{expected[1]}")
