"""Lanes on NumPy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer.lanes.backend import State
from reference_tracer.numbers import TINY_32, TINY_64, Composed, register


class NumPyOperations(Composed):
    """Formulas on NumPy arrays and scalars."""

    rank = 1

    def less(self, a: Any, b: Any) -> Any:
        return a < b

    def at_least(self, a: Any, b: Any) -> Any:
        return a >= b

    def select(self, condition: Any, a: Any, b: Any) -> Any:
        return np.where(condition, a, b)

    def sqrt0(self, x: Any) -> Any:
        return np.sqrt(np.where(x > 0.0, x, np.zeros_like(x)))

    def clamp0(self, x: Any) -> Any:
        return np.where(x > 0.0, x, np.zeros_like(x))

    def power(self, x: Any, n: Any) -> Any:
        result = np.ones_like(x)
        n = np.asarray(n)
        while n.any():
            result = np.where(n & 1 == 1, result * x, result)
            x = x * x
            n = n >> 1
        tiny = TINY_64 if result.dtype == np.float64 else TINY_32
        return np.where(result > tiny, result, np.zeros_like(result))

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        return (a + b) + c


register(NumPyOperations(), np.ndarray, np.float64, np.float32, np.bool_, np.int64)


class NumPyBackend:
    """NumPy in tiles that fit the processor's cache."""

    name = "numpy"
    tile = 8192

    def __init__(self, precision: int) -> None:
        self.precision = precision
        self.dtype = np.float64 if precision == 64 else np.float32

    def packets(self, values: Sequence[tuple[float, float, float, float]]) -> list[NDArray[Any]]:
        return list(np.array(values or [(0.0,) * 4], dtype=self.dtype).T.copy())

    def integers(self, values: Sequence[int]) -> NDArray[Any]:
        return np.array(values or [0], dtype=np.int64)

    def scalar(self, value: float) -> float:
        return value

    def count(self, n: int) -> int:
        return n

    def indices(self, begin: int, end: int) -> NDArray[Any]:
        return np.arange(begin, end)

    def zeros(self, like: Any) -> Any:
        return np.zeros_like(like)

    def to_single(self, reals: Any) -> Any:
        return reals.astype(np.float32).astype(self.dtype)

    def to_real(self, integers: Any) -> Any:
        return integers.astype(self.dtype)

    def gather(self, table: Any, index: Any) -> Any:
        return table[..., index]

    def packet(self, table: Any, row: Any) -> Any:
        return tuple(column[row] for column in table)

    def gather_or_zero(self, table: Any, index: Any) -> Any:
        return np.where(index >= 0, table[..., index], np.zeros(1, dtype=table.dtype))

    def fold(
        self, count: int, step: Callable[[Any, State], State], state: State, wanted: Callable[[State], Any]
    ) -> State:
        for k in range(count):
            if not np.any(wanted(state)):
                break
            state = step(k, state)
        return state

    def compress(self, mask: Any) -> Any:
        return np.flatnonzero(mask)

    def concatenate(self, a: Any, b: Any) -> Any:
        return np.concatenate([a, b])

    def positions(self, lanes: int, index: Any, begin: int) -> Any:
        found = np.full(lanes, -1, dtype=np.int64)
        found[index] = np.arange(begin, begin + len(index))
        return found

    def evaluate(self, state: State) -> None:
        """Nothing is recorded: NumPy computes at once."""

    def width(self, array: Any) -> int:
        return int(np.size(array))

    def numpy(self, array: Any) -> NDArray[Any]:
        return np.asarray(array)
