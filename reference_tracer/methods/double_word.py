"""Double words: a number as the unevaluated sum of two floats, about twice their significant bits.

Error bounds: Joldes, Muller & Popescu, "Tight and rigorous error bounds for basic building blocks of
double-word arithmetic" (ACM Trans. Math. Softw. 44, 2017); root: Lefèvre, Louvet, Muller, Picot &
Rideau, "Accurate calculation of Euclidean norms using double-word arithmetic" (ACM TOMS 49, 2023).
u is the roundoff of one float. Overflow gives NaN, as in `pairs`.
"""

from __future__ import annotations

from typing import Any

from reference_tracer import numbers
from reference_tracer.methods.pairs import fast_two_sum, two_product, two_sum
from reference_tracer.methods.words import significant_bits
from reference_tracer.numbers import Composed, Number


class DoubleWord:
    """high + low with |low| <= u|high|, of any float type."""

    __slots__ = ("high", "low")
    __array_ufunc__ = None  # NumPy leaves the operators to this class

    def __init__(self, high: Number, low: Number) -> None:
        self.high = high
        self.low = low

    def __neg__(self) -> DoubleWord:
        return DoubleWord(-self.high, -self.low)

    def __add__(self, other: Any) -> DoubleWord:
        """AccurateDWPlusDW: relative error 3u² + 13u³."""
        y = _as_double(other)
        high, low = two_sum(self.high, y.high)
        top, rest = two_sum(self.low, y.low)
        high, low = fast_two_sum(high, low + top)
        return DoubleWord(*fast_two_sum(high, rest + low))

    def __sub__(self, other: Any) -> DoubleWord:
        return self + -_as_double(other)

    def __mul__(self, other: Any) -> DoubleWord:
        """DWTimesDW1: relative error 7u²."""
        y = _as_double(other)
        high, low = two_product(self.high, y.high)
        return DoubleWord(*fast_two_sum(high, low + (self.high * y.low + self.low * y.high)))

    def __truediv__(self, other: Any) -> DoubleWord:
        """DWDivDW2: relative error 15u² + 56u³."""
        y = _as_double(other)
        quotient = self.high / y.high
        rest = self - y * DoubleWord(quotient, quotient * 0.0)
        return DoubleWord(*fast_two_sum(quotient, rest.high / y.high))


def _as_double(x: Any) -> DoubleWord:
    return x if isinstance(x, DoubleWord) else DoubleWord(x, 0.0)


class DoubleWordOperations(Composed):
    """Formulas on double words."""

    rank = 5

    def less(self, a: Any, b: Any) -> Any:
        x, y = _as_double(a), _as_double(b)
        return (x.high < y.high) | ((x.high == y.high) & (x.low < y.low))

    def at_least(self, a: Any, b: Any) -> Any:
        x, y = _as_double(a), _as_double(b)
        return (x.high > y.high) | ((x.high == y.high) & (x.low >= y.low))

    def select(self, condition: Any, a: Any, b: Any) -> DoubleWord:
        x, y = _as_double(a), _as_double(b)
        return DoubleWord(numbers.select(condition, x.high, y.high), numbers.select(condition, x.low, y.low))

    def sqrt0(self, x: DoubleWord) -> DoubleWord:
        """SQRTDWtoDW: relative error 25/8 u²."""
        root = numbers.sqrt0(x.high)
        square, low = two_product(root, root)
        rest = ((x.high - square) - low) + x.low
        safe = numbers.select(root > 0.0, root, root + 1.0)
        high, low = fast_two_sum(root, rest / (safe + safe))
        positive = root > 0.0
        nothing = root * 0.0
        return DoubleWord(numbers.select(positive, high, nothing), numbers.select(positive, low, nothing))

    def clamp0(self, x: DoubleWord) -> DoubleWord:
        return self.select(self.less(0.0, x), x, DoubleWord(x.high * 0.0, x.low * 0.0))

    def power(self, x: DoubleWord, n: Any) -> Any:
        raise TypeError("no formula in double words takes a power")

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        return (a + b) + c


def doubled(x: Number) -> Number:
    """A float as a double word; balls and exact numbers as they are."""
    return DoubleWord(x, x * 0.0) if significant_bits(x) else x


def single(x: Number, like: Number) -> Number:
    """A double word rounded to one float of the type of `like`, its higher half."""
    return x.high if isinstance(x, DoubleWord) else x


numbers.register(DoubleWordOperations(), DoubleWord)
