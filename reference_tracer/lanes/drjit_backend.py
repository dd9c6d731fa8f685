"""Lanes on DrJit's LLVM back end.

Import only after `reference_tracer.llvm.find()` has found a libLLVM that works:
an unfit one aborts the process. DrJit keeps + - * / sqrt as IEEE has them, so
float64 lanes agree with Python bit for bit, with these cares: no table is a
literal (x / literal becomes x * (1/literal)), no dot, norm, rsqrt or power of
DrJit's own, and powers that underflow are 0 in every backend (its workers flush
subnormals).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import drjit as dr
import numpy as np
from drjit import llvm
from numpy.typing import NDArray

from reference_tracer.lanes.backend import State, leaves, rebuild
from reference_tracer.numbers import TINY_32, TINY_64, Composed, register


class DrJitOperations(Composed):
    """Formulas on DrJit arrays."""

    rank = 2

    def less(self, a: Any, b: Any) -> Any:
        return a < b

    def at_least(self, a: Any, b: Any) -> Any:
        return a >= b

    def select(self, condition: Any, a: Any, b: Any) -> Any:
        return dr.select(condition, a, b)

    def sqrt0(self, x: Any) -> Any:
        return dr.sqrt(dr.select(x > 0.0, x, 0.0))

    def clamp0(self, x: Any) -> Any:
        return dr.select(x > 0.0, x, 0.0)

    def power(self, x: Any, n: Any) -> Any:
        def body(result: Any, x: Any, n: Any) -> tuple[Any, Any, Any]:
            return dr.select((n & 1) == 1, result * x, result), x * x, n >> 1

        bright = x > 0.0
        state = (type(x)(1.0), x, dr.select(bright, llvm.UInt32(n), 0))
        result = dr.while_loop(state, lambda result, x, n: n > 0, body)[0]
        tiny = TINY_64 if isinstance(result, llvm.Float64) else TINY_32
        return dr.select(bright & (result > tiny), result, 0.0)

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        return (a + b) + c


register(DrJitOperations(), llvm.Float, llvm.Float64, llvm.Bool, llvm.Int32, llvm.UInt32)


class DrJitBackend:
    """A few kernels for all scenes: objects and lights are loops over opaque tables."""

    name = "drjit"
    tile = 2**20

    def __init__(self, precision: int) -> None:
        self.precision = precision
        self.real = llvm.Float64 if precision == 64 else llvm.Float
        self.four = llvm.Array4f64 if precision == 64 else llvm.Array4f

    def packets(self, values: Sequence[tuple[float, float, float, float]]) -> Any:
        return self._solid(self.real([x for row in values or [(0.0,) * 4] for x in row]))

    def integers(self, values: Sequence[int]) -> Any:
        return self._solid(llvm.Int32(list(values) or [0]))

    def scalar(self, value: float) -> Any:
        return dr.opaque(self.real, value)

    def count(self, n: int) -> Any:
        return dr.opaque(llvm.Int32, n)

    def _solid(self, array: Any) -> Any:
        dr.make_opaque(array)
        return array

    def indices(self, begin: int, end: int) -> Any:
        return dr.arange(llvm.Int32, begin, end)

    def zeros(self, like: Any) -> Any:
        return dr.zeros(type(like), dr.width(like))

    def to_single(self, reals: Any) -> Any:
        return self.real(llvm.Float(reals))

    def to_real(self, integers: Any) -> Any:
        return self.real(integers)

    def gather(self, table: Any, index: Any) -> Any:
        return dr.gather(type(table), table, llvm.UInt32(index))

    def packet(self, table: Any, row: Any) -> Any:
        return tuple(dr.gather(self.four, table, llvm.UInt32(row)))

    def gather_or_zero(self, table: Any, index: Any) -> Any:
        return dr.gather(type(table), table, llvm.UInt32(index), index >= 0)

    def fold(
        self, count: Any, step: Callable[[Any, State], State], state: State, wanted: Callable[[State], Any]
    ) -> State:
        """A loop in the kernel; a vector of lanes of which none is wanted leaves it."""

        def goes_on(k: Any, *arrays: Any) -> Any:
            return (k < count) & wanted(rebuild(state, list(arrays)))

        def body(k: Any, *arrays: Any) -> tuple[Any, ...]:
            after = step(k, rebuild(state, list(arrays)))
            return (k + 1, *leaves(after))

        flat = dr.while_loop((llvm.Int32(0), *leaves(state)), goes_on, body)
        return rebuild(state, list(flat[1:]))

    def compress(self, mask: Any) -> Any:
        return llvm.Int32(dr.compress(mask))

    def concatenate(self, a: Any, b: Any) -> Any:
        if dr.width(a) == 0 or dr.width(b) == 0:
            return b if dr.width(a) == 0 else a
        return dr.concat((a, b))

    def positions(self, lanes: int, index: Any, begin: int) -> Any:
        found = dr.full(llvm.Int32, -1, lanes)
        if dr.width(index) == 0:
            return found
        slots = dr.arange(llvm.Int32, begin, begin + dr.width(index))
        dr.scatter(found, slots, llvm.UInt32(index))
        return found

    def evaluate(self, state: State) -> None:
        dr.make_opaque(*leaves(state))  # also what is a literal, or it would make another kernel

    def width(self, array: Any) -> int:
        return int(dr.width(array))

    def numpy(self, array: Any) -> NDArray[Any]:
        return np.array(array)
