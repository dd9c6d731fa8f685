"""The few operations that formulas need beyond + - * /, for every number type.

Formulas are written once, on a generic number: a Python float, a NumPy or DrJit
array of lanes, or a ball (value and error radius). So they never branch on a
number (`select` instead of `if`), never use `**` (`power`), and take roots and
positive parts through functions that are total. Each number type registers its
operations here; the highest rank among the arguments decides.
"""

from __future__ import annotations

import math
from typing import Any, Protocol

Number = Any
"""A generic number; every operation keeps its type, shape and unit."""

Condition = Any
"""What `less` returns: a bool, an array of bools, or a three-valued `Doubtful`."""


class Operations(Protocol):
    """What a number type must offer to be put into a formula."""

    rank: int

    def less(self, a: Number, b: Number) -> Condition:
        """Is a < b."""

    def at_least(self, a: Number, b: Number) -> Condition:
        """Is a >= b."""

    def select(self, condition: Condition, a: Number, b: Number) -> Number:
        """A where the condition holds, b elsewhere; both are evaluated."""

    def sqrt0(self, x: Number) -> Number:
        """The square root of max(x, 0)."""

    def clamp0(self, x: Number) -> Number:
        """max(x, 0), with +0 for every x <= 0."""

    def power(self, x: Number, n: Any) -> Number:
        """X to the integer n >= 1 by repeated squaring, for 0 <= x; tiny results become 0."""

    def sum3(self, a: Number, b: Number, c: Number) -> Number:
        """(a + b) + c."""

    def over_pi(self, x: Number) -> Number:
        """x/π."""

    def unit3(self, x: Number, y: Number, z: Number) -> tuple[Number, Number, Number]:
        """The unit vector of (x, y, z); zero stays zero."""


class Composed:
    """Operations made of the others, for types that need no better."""

    def over_pi(self, x: Number) -> Number:
        return x * (1.0 / math.pi)

    def unit3(self, x: Number, y: Number, z: Number) -> tuple[Number, Number, Number]:
        size = sqrt0(sum3(x * x, y * y, z * z))
        size = select(less(0.0, size), size, 1.0)
        return x / size, y / size, z / size


class PlainOperations(Composed):
    """Python floats."""

    rank = 0

    def less(self, a: float, b: float) -> bool:
        return a < b

    def at_least(self, a: float, b: float) -> bool:
        return a >= b

    def select(self, condition: bool, a: float, b: float) -> float:
        return a if condition else b

    def sqrt0(self, x: float) -> float:
        return math.sqrt(x) if x > 0.0 else 0.0

    def clamp0(self, x: float) -> float:
        return x if x > 0.0 else 0.0

    def power(self, x: float, n: int) -> float:
        result = 1.0
        while n > 0:
            if n & 1:
                result = result * x
            x = x * x
            n >>= 1
        return result if result > TINY_64 else 0.0

    def sum3(self, a: float, b: float, c: float) -> float:
        return (a + b) + c


# Powers below this are taken as 0: DrJit's workers flush subnormals to zero, Python does not, and
# a factor that has become subnormal leaves only results below it (both factors are <= 1 + few ulp).
TINY_64 = 1e-300
TINY_32 = 1e-36

_REGISTERED: dict[type, Operations] = dict.fromkeys((bool, int, float), PlainOperations())


def register(operations: Operations, *types: type) -> None:
    """Let formulas run on these types."""
    for kind in types:
        _REGISTERED[kind] = operations


_CHOSEN: dict[tuple[type, ...], Operations] = {}


def _of_types(*types: type) -> Operations:
    found = _CHOSEN.get(types)
    if found is None:
        found = max((_REGISTERED[kind] for kind in types), key=lambda operations: operations.rank)
        _CHOSEN[types] = found
    return found


def less(a: Number, b: Number) -> Condition:
    """Is a < b; undecided for balls that overlap."""
    return _of_types(type(a), type(b)).less(a, b)


def at_least(a: Number, b: Number) -> Condition:
    """Is a >= b, the exact opposite of `less`."""
    return _of_types(type(a), type(b)).at_least(a, b)


def select(condition: Condition, a: Number, b: Number) -> Number:
    """A where the condition holds, b elsewhere; an undecided ball condition gives the hull."""
    return _of_types(type(condition), type(a), type(b)).select(condition, a, b)


def sqrt0(x: Number) -> Number:
    """The square root of max(x, 0): total, monotone, right for x >= 0."""
    return _of_types(type(x)).sqrt0(x)


def clamp0(x: Number) -> Number:
    """max(x, 0)."""
    return _of_types(type(x)).clamp0(x)


def power(x: Number, n: Any) -> Number:
    """X to the integer n >= 1, as a chain of multiplications, the same in every type."""
    return _of_types(type(x)).power(x, n)


def sum3(a: Number, b: Number, c: Number) -> Number:
    """(a + b) + c; balls bound every order of summation and a fused product alike."""
    return _of_types(type(a), type(b), type(c)).sum3(a, b, c)


def over_pi(x: Number) -> Number:
    """x/π."""
    return _of_types(type(x)).over_pi(x)


def unit3(x: Number, y: Number, z: Number) -> tuple[Number, Number, Number]:
    """(x, y, z) over its length, zero for zero."""
    return _of_types(type(x), type(y), type(z)).unit3(x, y, z)
