"""Lanes that err as much as a precision allows: every operation is off by a random factor 1 + δ, |δ| <= u.

What bounds must contain. A float32 tracer rounds to nearest, one way, and rarely by the most that it may; these
lanes stand for all tracers of that unit roundoff, whatever their order of operations does to the signs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer import numbers
from reference_tracer.image import Image
from reference_tracer.lanes.floats import Floats
from reference_tracer.lanes.numpy_backend import NumPyBackend, NumPyOperations
from reference_tracer.lanes.tables import Tables
from reference_tracer.lanes.wavefront import Wavefront
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

Reals = NDArray[np.float64]


class Error:
    """A source of factors 1 + δ: half of them at the ends of [-u, u], half anywhere between."""

    def __init__(self, u: float, seed: int) -> None:
        self.u = u
        self.chance = np.random.default_rng(seed)

    def __call__(self, value: Any) -> Any:
        share = self.chance.uniform(-2.0, 2.0, np.shape(value))
        return value * (1.0 + self.u * np.clip(share, -1.0, 1.0))


class Sloppy:
    """A float64 value that went through operations with errors."""

    __slots__ = ("error", "value")
    __array_ufunc__ = None

    def __init__(self, value: Any, error: Error) -> None:
        self.value = value
        self.error = error

    @property
    def parts(self) -> tuple[Any]:
        return (self.value,)

    def with_parts(self, parts: tuple[Any]) -> Sloppy:
        return Sloppy(parts[0], self.error)

    def _done(self, value: Any) -> Sloppy:
        return Sloppy(self.error(value), self.error)

    def __neg__(self) -> Sloppy:
        return Sloppy(-self.value, self.error)

    def __add__(self, other: Any) -> Sloppy:
        return self._done(self.value + of(other))

    def __sub__(self, other: Any) -> Sloppy:
        return self._done(self.value - of(other))

    def __rsub__(self, other: Any) -> Sloppy:
        return self._done(of(other) - self.value)

    def __mul__(self, other: Any) -> Sloppy:
        return self._done(self.value * of(other))

    def __truediv__(self, other: Any) -> Sloppy:
        return self._done(self.value / of(other))

    def __rtruediv__(self, other: Any) -> Sloppy:
        return self._done(of(other) / self.value)

    def __eq__(self, other: object) -> Any:
        return self.value == of(other)

    def __ne__(self, other: object) -> Any:
        return self.value != of(other)

    __hash__ = None  # type: ignore[assignment]
    __radd__ = __add__
    __rmul__ = __mul__


def of(number: Any) -> Any:
    """The value of a sloppy number, any other number itself."""
    return number.value if isinstance(number, Sloppy) else number


class SloppyOperations(numbers.Composed):
    """Formulas with errors; comparisons and selections have none."""

    rank = 6
    exact = NumPyOperations()

    def less(self, a: Any, b: Any) -> Any:
        return of(a) < of(b)

    def at_least(self, a: Any, b: Any) -> Any:
        return of(a) >= of(b)

    def select(self, condition: Any, a: Any, b: Any) -> Sloppy:
        error = a.error if isinstance(a, Sloppy) else b.error
        return Sloppy(np.where(condition, of(a), of(b)), error)

    def sqrt0(self, x: Sloppy) -> Sloppy:
        return Sloppy(x.error(self.exact.sqrt0(x.value)), x.error)

    def clamp0(self, x: Sloppy) -> Sloppy:
        return Sloppy(self.exact.clamp0(x.value), x.error)

    def power(self, x: Sloppy, n: Any) -> Sloppy:
        result = x * 0.0 + 1.0
        base, n = x, np.asarray(n)
        while n.any():
            result = self.select(n & 1 == 1, result * base, result)
            base, n = base * base, n >> 1
        return result

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        return (a + b) + c


numbers.register(SloppyOperations(), Sloppy)


class SloppyNumbers(Floats):
    """Scene numbers read into float32 as a tracer of a large u does, then computed with errors."""

    def __init__(self, error: Error, single: bool) -> None:
        self.error = error
        self.single = single

    def read(self, array: Any) -> Sloppy:
        return Sloppy(array.astype(np.float32).astype(np.float64) if self.single else array, self.error)

    def exact(self, array: Any) -> Sloppy:
        return Sloppy(array, self.error)


def render(scene: Scene, u: float, seed: int, rules: Rulebook = LECTURE) -> Image:
    """The picture of a tracer that errs by up to u in every operation; pixels (height, width, 3) float64."""
    lanes = NumPyBackend(64)
    front = Wavefront(scene, rules, lanes, SloppyNumbers(Error(u, seed), u > 2.0**-40), Tables(scene, lanes))
    total = scene.image.width * scene.image.height
    with np.errstate(all="ignore"):
        colour, _ = front.colours(lanes.indices(0, total))
    pixels = np.stack([part.value for part in colour], axis=-1)
    return Image(pixels.reshape(scene.image.height, scene.image.width, 3))
