"""Balls: a value with a radius that a tracer of unit roundoff u cannot leave.

Every operation propagates the radii of its arguments and adds u·|result| for its
own rounding (|mid| + rad bounds the result), so a ball holds each result that any evaluation with relative
error u an operation may give. The midpoint is computed by the same operations
as the plain lanes, so it is their result, bit for bit.

The radius itself is computed in float64. INFLATE covers the rounding of that
computation, TINY what underflows in it or is flushed to zero; a radius of 0 means
that the value is exact, and only exact zeros and exact scene numbers have it. One
that is not a number says as little as an infinite one. The proofs are in
docs/tolerance.md.

An undecided comparison is a `Doubtful`: its value is the branch the midpoint
takes, `sure` says where the other branch is impossible. `select` on it returns
the hull of both branches; a bool context raises.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from reference_tracer import numbers
from reference_tracer.vector import Vec


class Doubtful:
    """A condition per lane: what the midpoints say, and where that is certain."""

    __slots__ = ("sure", "value")
    __array_ufunc__ = None  # NumPy leaves the operators to this class

    def __init__(self, value: Any, sure: Any) -> None:
        self.value = value
        self.sure = sure

    @property
    def parts(self) -> tuple[Any, Any]:
        return (self.value, self.sure)

    def with_parts(self, parts: tuple[Any, Any]) -> Doubtful:
        return Doubtful(*parts)

    def __bool__(self) -> bool:
        raise TypeError("an undecided comparison has no truth value; use select")

    def __and__(self, other: Any) -> Doubtful:
        if not isinstance(other, Doubtful):
            return Doubtful(self.value & other, self.sure | ~other)
        surely_false = (self.sure & ~self.value) | (other.sure & ~other.value)
        return Doubtful(self.value & other.value, (self.sure & other.sure) | surely_false)

    def __or__(self, other: Any) -> Doubtful:
        if not isinstance(other, Doubtful):
            return Doubtful(self.value | other, self.sure | other)
        surely_true = (self.sure & self.value) | (other.sure & other.value)
        return Doubtful(self.value | other.value, (self.sure & other.sure) | surely_true)

    __rand__ = __and__
    __ror__ = __or__

    @property
    def possible(self) -> Any:
        """Where the condition may hold."""
        return self.value | ~self.sure


class Precision(NamedTuple):
    """Of the tracer that is enclosed: unit roundoff u, and what one operation may lose by underflow."""

    u: Any
    tiny: Any


class Ball:
    """mid ± rad for a tracer of that precision."""

    __slots__ = ("mid", "precision", "rad")
    __array_ufunc__ = None

    def __init__(self, mid: Any, rad: Any, precision: Precision) -> None:
        self.mid = mid
        self.rad = rad
        self.precision = precision

    @property
    def parts(self) -> tuple[Any, Any]:
        return (self.mid, self.rad)

    def with_parts(self, parts: tuple[Any, Any]) -> Ball:
        return Ball(*parts, self.precision)

    @staticmethod
    def begin(o: Vec, v: Vec) -> tuple[Vec, Vec]:
        """Origin and direction of a generation's rays: as they are."""
        return o, v

    def _other(self, other: Any) -> Ball:
        return other if isinstance(other, Ball) else Ball(other, 0.0, self.precision)

    def _rounded(self, mid: Any, rad: Any) -> Ball:
        """The result of a sum, a difference or a root, which never underflow."""
        rad = rad + (_abs(mid) + rad) * self.precision.u
        return Ball(mid, numbers.select(rad == 0.0, 0.0, (rad + self.precision.tiny) * INFLATE), self.precision)

    def _scaled(self, mid: Any, rad: Any, exact: Any) -> Ball:
        """The result of a product or a quotient, which may underflow unless it is exactly 0."""
        rad = (rad + ((_abs(mid) + rad) * self.precision.u + self.precision.tiny)) * INFLATE
        rad = numbers.select(rad == rad, rad, INFINITY)  # 0 times unbounded
        return Ball(mid, numbers.select(exact, 0.0, rad), self.precision)

    @property
    def _nothing(self) -> Any:
        """Where the value is exactly 0."""
        return (self.mid == 0.0) & (self.rad == 0.0)

    def __neg__(self) -> Ball:
        return Ball(-self.mid, self.rad, self.precision)

    def __add__(self, other: Any) -> Ball:
        b = self._other(other)
        return self._rounded(self.mid + b.mid, self.rad + b.rad)

    def __sub__(self, other: Any) -> Ball:
        b = self._other(other)
        return self._rounded(self.mid - b.mid, self.rad + b.rad)

    def __rsub__(self, other: Any) -> Ball:
        return self._other(other) - self

    def __mul__(self, other: Any) -> Ball:
        if isinstance(other, float):  # an exact factor of the formulas: 2, 0.5
            return self._scaled(self.mid * other, self.rad * abs(other), self._nothing)
        b = self._other(other)
        rad = _abs(self.mid) * b.rad + self.rad * (_abs(b.mid) + b.rad)
        return self._scaled(self.mid * b.mid, rad, self._nothing | b._nothing)

    def __truediv__(self, other: Any) -> Ball:
        # |x/y - X/Y| <= (rx + |x/y| ry) / (|y| - ry), unbounded where Y may be 0
        b = self._other(other)
        mid = self.mid / b.mid
        room = _abs(b.mid) * DEFLATE - b.rad
        reach = (self.rad + _abs(mid) * b.rad) / numbers.select(room > 0.0, room, 1.0)
        return self._scaled(mid, numbers.select(room > 0.0, reach, INFINITY), self._nothing & (room > 0.0))

    def __rtruediv__(self, other: Any) -> Ball:
        return self._other(other) / self

    __radd__ = __add__
    __rmul__ = __mul__

    @property
    def lower(self) -> Any:
        """At most every value of the ball."""
        return self.mid - (self.rad * INFLATE + _abs(self.mid) * EDGE)

    @property
    def upper(self) -> Any:
        """At least every value of the ball."""
        return self.mid + (self.rad * INFLATE + _abs(self.mid) * EDGE)


INFINITY = float("inf")
INFLATE = 1.0 + 2.0**-48
"""At most 16 float64 roundings, each of 2^-53, go into a radius: (1 + 2^-53)^16 < 1 + 2^-48."""
DEFLATE = 1.0 - 2.0**-48
EDGE = 2.0**-51
"""mid ± rad is rounded once: by less than 2^-51 of |mid| and 2^-48 of rad."""
ONE_OVER_PI = 1.0 / math.pi
NORMAL, HUGE = 1e-140, 1e150
"""Vectors whose length lies between have a float64 square that neither underflows nor overflows."""
ANYWHERE = 2.125
"""No component of a unit vector, rounded as it may be, is farther from another's."""
UNDERFLOW_64 = 1e-300
"""10^7 times the smallest normal number: what underflows or is flushed to zero in one operation."""
UNDERFLOW_32 = 1e-36
"""The same for float32: its smallest normal number is 1.2e-38."""


def _abs(x: Any) -> Any:
    return abs(x) if isinstance(x, float) else numbers.select(x < 0.0, -x, x)


def _max(a: Any, b: Any) -> Any:
    return numbers.select(a > b, a, b)


def _known(bound: Any) -> Any:
    """The bound, infinite where it is not a number: inf - inf, or 0 times inf."""
    return numbers.select(bound == bound, bound, INFINITY)


def twice(u: Any) -> Any:
    """What two roundings of one value make: (1 + u)² - 1."""
    return (2.0 + u) * u


def representable(room: Any, size: Any, precision: Precision) -> Any:
    """Where a vector no shorter than `room` and about `size` long has a direction that its squares tell.

    Ours must neither underflow nor overflow; the tracer's may lose 4·tiny, which must be below u of the squared length.
    """
    return (room > NORMAL) & (size < HUGE) & (room * room * precision.u >= 4.0 * precision.tiny)


class BallOperations:
    """Formulas on balls."""

    rank = 3

    def _pair(self, a: Any, b: Any) -> tuple[Ball, Ball]:
        precision = a.precision if isinstance(a, Ball) else b.precision
        one, other = (x if isinstance(x, Ball) else Ball(x, 0.0, precision) for x in (a, b))
        return one, other

    def _compared(self, a: Any, b: Any, value: Any) -> Doubtful:
        # Certain when the balls are apart; also when both are points, so that a tie of exact
        # values (a ray exactly parallel to a plane) is decided.
        gap, reach = a.mid - b.mid, a.rad + b.rad
        return Doubtful(value, (_abs(gap) > reach * INFLATE) | (reach == 0.0))

    def less(self, a: Any, b: Any) -> Doubtful:
        a, b = self._pair(a, b)
        return self._compared(a, b, a.mid < b.mid)

    def at_least(self, a: Any, b: Any) -> Doubtful:
        a, b = self._pair(a, b)
        return self._compared(a, b, a.mid >= b.mid)

    def select(self, condition: Any, a: Any, b: Any) -> Any:
        if not isinstance(condition, Doubtful):
            a, b = self._pair(a, b)
            return Ball(numbers.select(condition, a.mid, b.mid), numbers.select(condition, a.rad, b.rad), a.precision)
        if not (isinstance(a, Ball) or isinstance(b, Ball)):
            raise TypeError("an undecided selection needs a ball on one side")
        a, b = self._pair(a, b)
        value = condition.value
        mid = numbers.select(value, a.mid, b.mid)
        rad = numbers.select(value, a.rad, b.rad)
        other = numbers.select(value, b.mid, a.mid)
        hull = _max(_known(rad), _known(_abs(other - mid) + numbers.select(value, b.rad, a.rad)))
        return Ball(mid, numbers.select(condition.sure, rad, hull * INFLATE), a.precision)

    def sqrt0(self, x: Ball) -> Ball:
        # The root of [lo, hi] clipped at 0; s - sqrt(lo) = (x - lo)/(s + sqrt(lo)) without cancellation.
        s = numbers.sqrt0(x.mid)
        low = numbers.sqrt0(x.lower)
        upper = _known(x.upper)  # the root of nothing known is not 0
        high = numbers.sqrt0(upper)
        total = s + low
        below = numbers.select(low > 0.0, x.rad / numbers.select(total > 0.0, total, 1.0), s)
        rise = s + high
        above = numbers.select(s > 0.0, x.rad / numbers.select(rise > 0.0, rise, 1.0), high)
        return x._rounded(s, numbers.select(upper < INFINITY, _max(below, above), INFINITY))

    def clamp0(self, x: Ball) -> Ball:
        return Ball(numbers.clamp0(x.mid), x.rad, x.precision)  # 1-Lipschitz

    def power(self, x: Ball, n: Any) -> Ball:
        # t -> t^n is increasing, so the bounds of the ball go through the same chain; each of its
        # at most 2 log2 n + 1 roundings is repeated by later squarings, in all at most 2n of them.
        mid = numbers.power(x.mid, n)
        upper = _known(x.upper)
        high = numbers.power(upper, n)
        low = numbers.power(numbers.clamp0(x.lower), n)
        times = n if isinstance(n, float | int) else _like(x.mid, n)
        # 2nu for the tracer's chain; 2n·2^-53 for each of the three computed here
        rad = _max(high - mid, mid - low) + high * ((2.0 * x.precision.u + 8.0 * 2.0**-53) * times)
        rad = numbers.select(upper < INFINITY, _known((rad + x.precision.tiny) * INFLATE), INFINITY)
        return Ball(mid, numbers.select(upper > 0.0, rad, 0.0), x.precision)

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        # Partial sums of any order stay below |a|+|b|+|c|: two roundings of that size, one of the other.
        first = next(x for x in (a, b, c) if isinstance(x, Ball))
        a, b, c = (x if isinstance(x, Ball) else Ball(x, 0.0, first.precision) for x in (a, b, c))
        size = (_abs(a.mid) + _abs(b.mid)) + _abs(c.mid)
        rad = (a.rad + b.rad) + c.rad
        rad = rad + (size + rad) * twice(first.precision.u)
        rad = numbers.select(rad == 0.0, 0.0, (rad + first.precision.tiny) * INFLATE)
        return Ball((a.mid + b.mid) + c.mid, rad, first.precision)

    def over_pi(self, x: Ball) -> Ball:
        # A tracer divides by a rounded π or multiplies by a rounded 1/π: 2u; here 2^-53 more each
        mid = x.mid * ONE_OVER_PI
        rad = x.rad * ONE_OVER_PI
        rad = rad + (_abs(mid) + rad) * (twice(x.precision.u) + 2.0**-51)
        rad = (rad + x.precision.tiny) * INFLATE
        return Ball(mid, numbers.select(x._nothing, 0.0, rad), x.precision)

    def unit3(self, x: Any, y: Any, z: Any) -> tuple[Ball, Ball, Ball]:
        """Mean value form: the derivative of a/|a| is (1 - n n')/|a|, so errors along n fall away.

        Over the ball |a| >= |a_mid| - R with R the length of the radii, and n moves by at most
        e = R/(|a_mid| - R), so each entry of 1 - n n' by at most 2e + e². Rounding: the length is
        right to 2.5u and the quotient adds u; 5u covers both, as long as no square underflows.
        """
        first = next(a for a in (x, y, z) if isinstance(a, Ball))
        a = [part if isinstance(part, Ball) else Ball(part, 0.0, first.precision) for part in (x, y, z)]
        n = numbers.unit3(*(part.mid for part in a))
        size = numbers.sqrt0(numbers.sum3(*(part.mid * part.mid for part in a)))
        spread = (a[0].rad + a[1].rad) + a[2].rad
        room = size * DEFLATE - spread * INFLATE
        safe = representable(room, size, first.precision)
        room = numbers.select(safe, room, 1.0)
        e = spread / room
        result = []
        for k in range(3):
            slopes = [_abs((1.0 if j == k else 0.0) - n[k] * n[j]) * a[j].rad for j in range(3)]
            moved = ((slopes[0] + slopes[1]) + slopes[2] + (2.0 * e + e * e) * spread) / room
            rad = moved + (_abs(n[k]) + moved) * (5.0 * first.precision.u)
            rad = numbers.select(a[k]._nothing, 0.0, (rad + first.precision.tiny) * INFLATE)
            result.append(Ball(n[k], numbers.select(safe, rad, ANYWHERE), first.precision))
        return result[0], result[1], result[2]


def _like(real: Any, integers: Any) -> Any:
    """Integers as reals of the type of `real`."""
    return integers.astype(real.dtype) if hasattr(integers, "astype") else type(real)(integers)


numbers.register(BallOperations(), Ball, Doubtful)
