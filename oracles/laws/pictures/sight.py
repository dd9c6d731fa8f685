"""What a picture says about linear light: an interval for each value, and how far a correct tracer may be off.

Sums and differences of sights are sights, so a law between pictures is one expression, and its tolerance is the sum
of theirs. An 8-bit code stands for all the light that it encodes; the first and the last code also for what was
clamped. So the laws hold for pictures of any format.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracles.compare import ENCODING_ROUNDINGS
from oracles.images.picture import Picture
from oracles.truth import ROUNDOFF, Truth

Reals = NDArray[np.float64]
Map = Callable[[Reals], Reals]


@dataclass(frozen=True)
class Sight:
    """Low <= light <= high in each value, (height, width, 3); tolerance: of a correct tracer; middle: truth.

    The sum of the middles is 0 where a law holds of truth; where truth is in doubt and its midpoint takes another
    branch in each picture it is not, and is then allowed to the tracer too. It never exceeds the sum of the
    tolerances.
    """

    low: Reals
    high: Reals
    tolerance: Reals
    middle: Reals

    def __add__(self, other: Sight) -> Sight:
        return Sight(
            self.low + other.low, self.high + other.high, self.tolerance + other.tolerance, self.middle + other.middle
        )

    def __sub__(self, other: Sight) -> Sight:
        return self + other * -1.0

    def __mul__(self, factor: float) -> Sight:
        ends = (self.low * factor, self.high * factor)
        low, high = ends if factor >= 0.0 else ends[::-1]
        return Sight(low, high, self.tolerance * abs(factor), self.middle * factor)

    def seen(self, change: Map) -> Sight:
        """Pixels or channels in other places."""
        return Sight(*(change(part) for part in (self.low, self.high, self.tolerance, self.middle)))

    def above(self, limit: float) -> Sight:
        """Black where the light is at most the limit."""
        return Sight(
            self.low - limit, np.full_like(self.low, np.inf), self.tolerance, np.maximum(self.middle - limit, 0.0)
        )

    def gap(self) -> Reals:
        """How far from black each value certainly is, signed; 0 where it may be black."""
        return np.where(self.low > 0.0, self.low, np.where(self.high < 0.0, self.high, 0.0))

    def bound(self) -> Reals:
        """How far from black it may be."""
        reach: Reals = self.tolerance + np.abs(self.middle)
        return reach

    def excess(self) -> Reals:
        """The gap in tolerances."""
        gap = np.abs(self.gap())
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio: Reals = np.where(gap == 0.0, 0.0, gap / self.bound())
        return ratio


def sight(picture: Picture, truth: Truth) -> Sight:
    """What this picture of that scene says; for codes of the display encoding `lecture`."""
    if picture.maximum is None:
        stored = np.where(truth.pixels == 0.0, 0.0, np.abs(truth.pixels) * picture.roundoff)
        return Sight(picture.values, picture.values, truth.tolerance + stored, truth.pixels)
    codes, top = picture.values, picture.maximum
    low = np.where(codes <= 0, -np.inf, codes / top)
    high = np.where(codes >= top, np.inf, (codes + 1) / top)
    encoding = np.abs(truth.pixels) * ENCODING_ROUNDINGS * ROUNDOFF[truth.precision]
    return Sight(low, high, truth.tolerance + encoding, truth.pixels)
