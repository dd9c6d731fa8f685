"""Cases from coordinates: each number of a case is a function of coordinates in [0, 1], plainest at 0.

Who makes the coordinates decides what they serve: a random generator a batch, Hypothesis one case that
it may shrink, a list of columns a case that is repeated. Numbers that go to a tracer are rounded to its
precision here, so that the inputs are exact for it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Integers = NDArray[np.int64]
ROUNDOFF = {"float32": 2.0**-24, "float64": 2.0**-53}

PERMUTATIONS = np.array([(0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)])
"""Of the axes; the first is the identity."""


@dataclass(frozen=True)
class Turn:
    """A permutation of the axes with signs: an orthogonal map that is exact in every precision."""

    order: Integers
    signs: Reals

    def __call__(self, vectors: Reals) -> Reals:
        """The turned vectors (n, 3)."""
        turned: Reals = np.take_along_axis(vectors, self.order, axis=1) * self.signs
        return turned


class Dice:
    """The coordinates of n cases for a tracer of some precision, a column at a time."""

    def __init__(self, count: int, precision: str, column: Callable[[], Reals]) -> None:
        self.count = count
        self.precision = precision
        self.u = ROUNDOFF[precision]
        self._column = column
        self.columns: list[Reals] = []
        self.regimes: tuple[str, ...] = ()
        self.regime_of: Integers | None = None

    def roll(self) -> Reals:
        """The next coordinate, (n,)."""
        column = self._column()
        self.columns.append(column)
        return column

    def round(self, values: Reals) -> Reals:
        """The values as the tracer's precision holds them."""
        if self.precision == "float64":
            return values
        return values.astype(np.float32).astype(np.float64)

    def choice(self, options: int) -> Integers:
        """An integer below options; the first is the plainest."""
        return np.minimum((self.roll() * options).astype(np.int64), options - 1)

    def regime(self, *names: str) -> Integers:
        """Which of these regimes each case is in; remembered for the report."""
        self.regimes = names
        self.regime_of = self.choice(len(names))
        return self.regime_of

    def uniform(self, low: float, high: float) -> Reals:
        """Between low (the plainest) and high."""
        return low + (high - low) * self.roll()

    def size(self, low: int, high: int) -> Reals:
        """Log-uniform in [2^low, 2^high).

        A power of two times 1 <= m < 2; plainest 1, or the end that is nearer to it.
        """
        span = high - low
        plainest = min(max(-low, 0), span - 1)
        exponent = low + (self.choice(span) + plainest) % span
        return np.ldexp(1.0 + np.minimum(self.roll(), 1.0 - 2.0**-52), exponent)

    def point(self, reach: float) -> Reals:
        """A point (n, 3) with components in [-reach, reach], the origin at coordinates 0."""
        parts = [self.uniform(0.0, 2.0 * reach) for _ in range(3)]
        return np.stack([np.where(part > reach, reach - part, part) for part in parts], axis=1)

    def frame(self) -> tuple[Reals, Reals, Reals]:
        """Orthonormal v, a, b, each (n, 3), not yet rounded; v = (0, 0, 1) at coordinates 0.

        v is uniform on the sphere: its height is uniform (Archimedes).
        """
        z = 1.0 - 2.0 * self.roll()
        ring = np.sqrt(np.maximum(0.0, 1.0 - z * z))
        x, y = self.circle()
        zero = np.zeros_like(z)
        v = np.stack([ring * x, ring * y, z], axis=1)
        return v, np.stack([z * x, z * y, -ring], axis=1), np.stack([-y, x, zero], axis=1)

    def circle(self) -> tuple[Reals, Reals]:
        """Cosine and sine of an angle, exactly 0 and ±1 at quarter turns."""
        turn = self.roll()
        angle, half = 2.0 * np.pi * turn, turn % 0.5
        return np.where(half == 0.25, 0.0, np.cos(angle)), np.where(half == 0.0, 0.0, np.sin(angle))

    def turn(self) -> Turn:
        """An exact rotation or mirroring, the identity at coordinates 0."""
        order = PERMUTATIONS[self.choice(len(PERMUTATIONS))]
        signs = np.stack([1.0 - 2.0 * self.choice(2) for _ in range(3)], axis=1)
        return Turn(order, signs)


def seeded(count: int, precision: str, seed: int) -> Dice:
    """A batch of cases; an eighth has only quarters as coordinates, another eighth about half of them.

    Quarters make what chance never does: directions along the axes, powers of two, exactly normal incidence.
    """
    generator = np.random.default_rng(seed)
    coarse, mixed = count // 8, count // 4

    def column() -> Reals:
        values = generator.random(count)
        snapped = np.floor(values[:mixed] * 4.0) / 4.0
        keep = generator.random(mixed - coarse) < 0.5
        values[:coarse] = snapped[:coarse]
        values[coarse:mixed] = np.where(keep, values[coarse:mixed], snapped[coarse:])
        return values

    return Dice(count, precision, column)


def repeated(columns: Reals, precision: str) -> Dice:
    """The cases of these coordinates (n, columns); coordinates beyond them are 0."""
    left = iter(columns.T)
    return Dice(len(columns), precision, lambda: next(left, np.zeros(len(columns))))
