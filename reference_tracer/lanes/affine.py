"""Balls that remember where their errors come from: affine forms, for pixels on which plain balls are too wide.

A quantity is mid + Σ dev_k ε_k + rest, |ε_k| <= 1: the ε are the errors of a ray's origin and direction, shared by
all that is computed from it, so that an error which cancels in the formula cancels in the bound (Comba & Stolfi,
Affine Arithmetic and its Applications to Computer Graphics, SIBGRAPI 1993). `rest` holds what is not linear and each
operation's rounding, as a ball's radius does; every rule below is derived in docs/tolerance.md. On NumPy only,
and only for u far above 2^-53: the rounding of the dev is taken as 2^-50 of them.

The midpoint is computed by the same operations as everywhere.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer import numbers
from reference_tracer.lanes.ball import (
    ANYWHERE,
    DEFLATE,
    EDGE,
    INFINITY,
    INFLATE,
    ONE_OVER_PI,
    Ball,
    Doubtful,
    Precision,
    representable,
    twice,
)
from reference_tracer.vector import Vec

Reals = NDArray[np.float64]
NONE: Reals = np.zeros((0, 1))
DEV = 2.0**-50
"""At most six float64 roundings go into a dev, each of 2^-53."""


class Affine:
    """mid + Σ dev_k ε_k + rest; dev has shape (symbols, lanes)."""

    __slots__ = ("dev", "mid", "precision", "rest")
    __array_ufunc__ = None

    def __init__(self, mid: Any, rest: Any, precision: Precision, dev: Reals = NONE) -> None:
        self.mid = mid
        self.rest = rest
        self.precision = precision
        self.dev = dev

    @property
    def parts(self) -> tuple[Any, ...]:
        return (self.mid, self.rest, self.dev) if len(self.dev) else (self.mid, self.rest)

    def with_parts(self, parts: tuple[Any, ...]) -> Affine:
        return Affine(parts[0], parts[1], self.precision, *parts[2:])

    @staticmethod
    def begin(o: Vec, v: Vec) -> tuple[Vec, Vec]:
        """Origin and direction of a generation's rays, each rest turned into a symbol that all of them know."""
        forms = [*o, *v]
        old = max(len(x.dev) for x in forms)
        lanes = max(np.size(x.mid) for x in forms)
        begun = []
        for k, x in enumerate(forms):
            dev = np.zeros((old + len(forms), lanes))
            dev[: len(x.dev)] = x.dev
            known = np.isfinite(x.rest)
            dev[old + k] = np.where(known, x.rest, 0.0)
            rest = np.broadcast_to(np.where(known, 0.0, INFINITY), lanes)
            begun.append(Affine(np.broadcast_to(x.mid, lanes), rest, x.precision, dev))
        return Vec(*begun[:3]), Vec(*begun[3:])

    @property
    def linear(self) -> Any:
        """How far the symbols reach."""
        return reach(self.dev)

    @property
    def rad(self) -> Any:
        """How far the value may lie from mid."""
        return (self.linear + self.rest) * INFLATE

    @property
    def lower(self) -> Any:
        """At most every value."""
        return self.mid - (self.rad * INFLATE + np.abs(self.mid) * EDGE)

    @property
    def upper(self) -> Any:
        """At least every value."""
        return self.mid + (self.rad * INFLATE + np.abs(self.mid) * EDGE)

    @property
    def nothing(self) -> Any:
        """Where the value is exactly 0."""
        return (self.mid == 0.0) & (self.rest == 0.0) & (self.linear == 0.0)

    def other(self, value: Any) -> Affine:
        """A number beside this one as an affine form."""
        if isinstance(value, Affine):
            return value
        if isinstance(value, Ball):
            return Affine(value.mid, value.rad, self.precision)
        return Affine(value, 0.0, self.precision)

    def __neg__(self) -> Affine:
        return Affine(-self.mid, self.rest, self.precision, -self.dev)

    def __add__(self, other: Any) -> Affine:
        b = self.other(other)
        return self._rounded(self.mid + b.mid, self.rest + b.rest, _sum(self.dev, b.dev), 1.0)

    def __sub__(self, other: Any) -> Affine:
        b = self.other(other)
        return self._rounded(self.mid - b.mid, self.rest + b.rest, _sum(self.dev, -b.dev), 1.0)

    def __mul__(self, other: Any) -> Affine:
        b = self.other(other)
        mid = self.mid * b.mid
        dev = _sum(b.mid * self.dev, self.mid * b.dev)
        A, B = self.linear, b.linear
        rest = np.abs(self.mid) * b.rest + np.abs(b.mid) * self.rest + (A + self.rest) * (B + b.rest)
        rest = rest + DEV * (np.abs(self.mid) * B + np.abs(b.mid) * A)
        found = self._rounded(mid, rest, dev, 1.0)
        exact = (self.nothing | b.nothing) & (mid == 0.0)
        return Affine(mid, np.where(exact, 0.0, found.rest + self.precision.tiny), self.precision, found.dev)

    def __truediv__(self, other: Any) -> Affine:
        # a/b - q = (a - q b)/b: linear in the symbols with 1/b ~ 1/b_mid, which is off by ρ/(1 - ρ), ρ = R_b/|b_mid|
        b = self.other(other)
        q = self.mid / b.mid
        size = np.abs(b.mid) * DEFLATE
        room = size - b.rad
        safe = room > 0.0
        dev = _sum(self.dev, -q * b.dev) / np.where(safe, b.mid, 1.0)
        own = (self.rest + np.abs(q) * b.rest + np.abs(self.mid) * 2.0**-51) / np.where(safe, size, 1.0)
        own = own + DEV * (self.linear + np.abs(q) * b.linear) / np.where(safe, size, 1.0)
        rest = own + (reach(dev) + own) * (b.rad / np.where(safe, room, 1.0))
        found = self._rounded(q, rest, dev, 1.0)
        rest = np.where(safe, np.where(self.nothing, 0.0, found.rest + self.precision.tiny), INFINITY)
        return Affine(q, rest, self.precision, _where(safe, found.dev, NONE))

    def __rsub__(self, other: Any) -> Affine:
        return self.other(other) - self

    def __rtruediv__(self, other: Any) -> Affine:
        return self.other(other) / self

    __radd__ = __add__
    __rmul__ = __mul__

    def _rounded(self, mid: Any, rest: Any, dev: Reals, roundings: float) -> Affine:
        """With the tracer's rounding of the result, and ours of the dev; exact zeros stay exact."""
        far = reach(dev)
        rest = rest + far * DEV + (np.abs(mid) + rest + far) * (roundings * self.precision.u)
        rest = np.where(rest == 0.0, 0.0, (rest + self.precision.tiny) * INFLATE)
        known = np.isfinite(rest)
        return Affine(mid, np.where(known, rest, INFINITY), self.precision, _where(known, dev, NONE))


def reach(dev: Reals) -> Any:
    """At least Σ |dev_k|, whatever the roundings of the sum."""
    return np.abs(dev).sum(axis=0) * (1.0 + len(dev) * 2.0**-52) if len(dev) else 0.0


def _known(bound: Any) -> Any:
    """The bound, infinite where it is not a number."""
    return np.where(np.isnan(bound), INFINITY, bound)


def _sum(a: Reals, b: Reals) -> Reals:
    """The sum of two devs, the shorter one lengthened by symbols that it does not know."""
    if len(a) == len(b):
        return a + b
    long, short = (a, b) if len(a) > len(b) else (b, a)
    if len(short) == 0:
        return long
    head = long[: len(short)] + short
    tail = np.broadcast_to(long[len(short) :], (len(long) - len(short), *head.shape[1:]))
    return np.concatenate([head, tail])


def _where(condition: Any, a: Reals, b: Reals) -> Reals:
    """A's dev where the condition holds, b's elsewhere."""
    if len(a) == len(b) == 0:
        return NONE
    zero = np.zeros((max(len(a), len(b)), 1))
    return np.where(condition, _sum(zero, a), _sum(zero, b))


class AffineOperations:
    """Formulas on affine forms."""

    rank = 5

    def _pair(self, a: Any, b: Any) -> tuple[Affine, Affine]:
        first = a if isinstance(a, Affine) else b
        return first.other(a), first.other(b)

    def _compared(self, a: Affine, b: Affine, value: Any) -> Doubtful:
        gap = np.abs(a.mid - b.mid)
        far = reach(_sum(a.dev, -b.dev)) + (a.linear + b.linear) * DEV + a.rest + b.rest
        return Doubtful(value, (gap > far * INFLATE) | ((a.rad == 0.0) & (b.rad == 0.0)))

    def less(self, a: Any, b: Any) -> Doubtful:
        a, b = self._pair(a, b)
        return self._compared(a, b, a.mid < b.mid)

    def at_least(self, a: Any, b: Any) -> Doubtful:
        a, b = self._pair(a, b)
        return self._compared(a, b, a.mid >= b.mid)

    def select(self, condition: Any, a: Any, b: Any) -> Affine:
        a, b = self._pair(a, b)
        value = condition.value if isinstance(condition, Doubtful) else condition
        mid, rest = np.where(value, a.mid, b.mid), np.where(value, a.rest, b.rest)
        dev = _where(value, a.dev, b.dev)
        if not isinstance(condition, Doubtful):
            return Affine(mid, rest, a.precision, dev)
        other = np.where(value, b.mid, a.mid)
        hull = _known(np.maximum(np.where(value, a.rad, b.rad), np.abs(other - mid) + np.where(value, b.rad, a.rad)))
        sure = condition.sure
        return Affine(mid, np.where(sure, rest, hull * INFLATE), a.precision, _where(sure, dev, NONE))

    def sqrt0(self, x: Affine) -> Affine:
        # √x - s = δ/(2s) - δ²/(2s(s + √x)²) for δ = x - s²; where x may be 0, a ball
        s = numbers.sqrt0(x.mid)
        low, high = numbers.sqrt0(x.lower), numbers.sqrt0(x.upper)
        smooth = low > 0.0
        slope = np.where(smooth, 2.0 * s, 1.0)
        dev = x.dev / slope
        total = np.where(smooth, s + low, 1.0)
        bend = x.rad * x.rad / (slope * total * total * DEFLATE)
        off = np.abs(x.mid) * 2.0**-50 / slope  # s² is not quite x.mid, which bends a little too
        rest = np.where(smooth, x.rest / slope + bend + off, np.maximum(s - low, high - s) * INFLATE)
        rest = np.where(x.upper < INFINITY, rest, INFINITY)  # the root of nothing known is not 0
        return x._rounded(s, rest, _where(smooth, dev, NONE), 1.0)

    def clamp0(self, x: Affine) -> Affine:
        positive = x.lower > 0.0
        return Affine(
            numbers.clamp0(x.mid),
            np.where(positive, x.rest, np.where(x.upper <= 0.0, 0.0, _known(x.upper - x.mid))),
            x.precision,
            _where(positive, x.dev, NONE),
        )

    def power(self, x: Affine, n: Any) -> Affine:
        found: Ball = numbers.power(Ball(x.mid, x.rad, x.precision), n)
        return Affine(found.mid, found.rad, x.precision)

    def sum3(self, a: Any, b: Any, c: Any) -> Affine:
        first = next(x for x in (a, b, c) if isinstance(x, Affine))
        a, b, c = (first.other(x) for x in (a, b, c))
        size = np.abs(a.mid) + np.abs(b.mid) + np.abs(c.mid) + (a.rad + b.rad + c.rad)
        rest = a.rest + b.rest + c.rest + size * (twice(first.precision.u) + DEV)
        dev = _sum(_sum(a.dev, b.dev), c.dev)
        return first._rounded((a.mid + b.mid) + c.mid, rest, dev, 0.0)

    def over_pi(self, x: Affine) -> Affine:
        found: Ball = numbers.over_pi(Ball(x.mid, x.rest, x.precision))
        more = x.linear * ONE_OVER_PI * (twice(x.precision.u) + DEV)
        return Affine(found.mid, _known((found.rad + more) * INFLATE), x.precision, x.dev * ONE_OVER_PI)

    def unit3(self, x: Any, y: Any, z: Any) -> tuple[Affine, Affine, Affine]:
        """a/|a| moves by (δ - n(n∘δ))/|a|, and by a second-order term.

        Over the ball the derivative (1 - nn')/|a| changes by at most (2e + e²)/(|a| - R) + e/|a|, with R the
        length of the radii and e = R/(|a| - R). Rounding: 5u, as for balls.
        """
        first = next(a for a in (x, y, z) if isinstance(a, Affine))
        a = [first.other(part) for part in (x, y, z)]
        n = numbers.unit3(*(part.mid for part in a))
        size = numbers.sqrt0(numbers.sum3(*(part.mid * part.mid for part in a)))
        R = a[0].rad + a[1].rad + a[2].rad
        room = size * DEFLATE - R * INFLATE
        safe = representable(room, size, first.precision)
        room = np.where(safe, room, 1.0)
        length = np.where(safe, size, 1.0)
        e = R / room
        bend = R * ((2.0 * e + e * e) / room + e / length)
        along = _sum(_sum(n[0] * a[0].dev, n[1] * a[1].dev), n[2] * a[2].dev)
        result = []
        for k in range(3):
            dev = _sum(a[k].dev, -n[k] * along) / length
            flat = sum(np.abs((1.0 if j == k else 0.0) - n[k] * n[j]) * a[j].rest for j in range(3))
            rest = flat / length + bend + R / length * (4.0 * DEV)
            found = first._rounded(n[k], rest, dev, 5.0)
            rest = np.where(a[k].nothing & safe, 0.0, np.where(safe, found.rest, ANYWHERE))
            result.append(Affine(n[k], rest, first.precision, _where(safe & ~a[k].nothing, dev, NONE)))
        return result[0], result[1], result[2]


numbers.register(AffineOperations(), Affine)
