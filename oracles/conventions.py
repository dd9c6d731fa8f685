"""What a picture may follow other than the scene model: a dialect, and slips of convention.

A dialect is lawful and part of what a tracer says of itself. A slip is not: a picture that is upside down, or
encoded twice. Both are known here for one purpose: that a tracer which differs in them alone is told so in one
line, and is judged in everything else as if it did not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.images.picture import Picture
from reference_tracer import dialects
from reference_tracer.dialects import Dialect
from reference_tracer.numbers import Number
from reference_tracer.rulebook import Rulebook

Reals = NDArray[np.float64]
Transfer = Callable[[Reals], Reals]
PlanePoint = Callable[..., tuple[Number, Number]]


@dataclass(frozen=True)
class Slip:
    """Slips of convention; the empty word is none.

    flip, channels, transfer: of the picture; pixel: where in the image plane a pixel lies.
    """

    flip: str = ""
    channels: str = ""
    transfer: str = ""
    pixel: str = ""

    def words(self) -> tuple[str, ...]:
        """What is wrong, for a sentence that begins "the pictures"."""
        return tuple(_SAID[getattr(self, field.name)] for field in fields(self) if getattr(self, field.name))

    def undone(self, picture: Picture) -> Picture:
        """The picture without its flip and channel order."""
        values = picture.values
        if self.flip:
            values = values[_FLIPS[self.flip]]
        if self.channels:
            values = values[:, :, ::-1]
        return replace(picture, values=values)


SLIPS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {
        "flip": ("", "upside down", "mirrored", "turned"),
        "channels": ("", "BGR"),
        "transfer": ("", "sRGB", "gamma 2.2"),
        "pixel": ("", "half", "w-1"),
    }
)
"""The slips that are looked for."""

_SAID = {
    "upside down": "are upside down (row 0 is the top)",
    "mirrored": "are mirrored (column 0 is the left)",
    "turned": "are upside down and mirrored (pixel (0, 0) is at the top left)",
    "BGR": "have red and blue exchanged",
    "sRGB": "have the sRGB encoding applied although linear values or the lecture's encoding are asked for",
    "gamma 2.2": "have gamma 2.2 applied although linear values or the lecture's encoding are asked for",
    "half": "are off by half a pixel: the sample is taken half a pixel to the right and down",
    "w-1": "are stretched: X = -1 + 2i/(w-1) where -1 + 2i/w is asked for, and likewise Y",
}

_FLIPS: dict[str, Any] = {
    "upside down": np.s_[::-1, :],
    "mirrored": np.s_[:, ::-1],
    "turned": np.s_[::-1, ::-1],
}


@dataclass(frozen=True)
class Convention:
    """What a tracer follows: its dialect, and its slips."""

    dialect: Dialect = dialects.SCENE_MODEL
    slip: Slip = Slip()

    def rules(self) -> Rulebook:
        """The rulebook of the pictures before they are flipped or encoded."""
        book = dialects.rules(self.dialect)
        if not self.slip.pixel:
            return book
        return replace(book, plane_point=_PIXELS[self.slip.pixel](book.plane_point))


def transfer_of(slip: Slip) -> Transfer | None:
    """What a picture's values went through that they should not have."""
    return _TRANSFERS.get(slip.transfer)


def _half(base: PlanePoint) -> PlanePoint:
    return lambda i, j, width, height, sample: base(i + 0.5, j + 0.5, width, height, sample)


def _stretched(base: PlanePoint) -> PlanePoint:
    return lambda i, j, width, height, sample: base(i, j, width - 1.0, height - 1.0, sample)


_PIXELS: dict[str, Callable[[PlanePoint], PlanePoint]] = {"half": _half, "w-1": _stretched}


def _gamma(c: Reals) -> Reals:
    found: Reals = np.maximum(c, 0.0) ** (1.0 / 2.2)
    return found


def _srgb(c: Reals) -> Reals:
    found: Reals = np.where(c <= 0.0031308, 12.92 * c, 1.055 * np.maximum(c, 0.0) ** (1.0 / 2.4) - 0.055)
    return found


_TRANSFERS: dict[str, Transfer] = {"sRGB": _srgb, "gamma 2.2": _gamma}
