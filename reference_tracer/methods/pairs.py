"""Sums and products without error: a float result and its exact rounding error, from + - * alone.

No fused multiply-add, so the same bits come from Python, NumPy and DrJit. Exact in IEEE 754 round to
nearest unless something overflows (factors beyond 2^996 in float64, 2^115 in float32) or an error term
underflows (products below 2^-969, 2^-102).
"""

from __future__ import annotations

from reference_tracer.lanes.ball import INFLATE, Ball
from reference_tracer.methods.words import SPLITTERS, significant_bits
from reference_tracer.numbers import Number, select
from reference_tracer.vector import Vec, dot


def two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """(s, e) with s = fl(a + b) and s + e = a + b. Knuth, TAOCP 2, 4.2.2 theorem B."""
    s = a + b
    part = s - a
    return s, (a - (s - part)) + (b - part)


def fast_two_sum(a: Number, b: Number) -> tuple[Number, Number]:
    """The same where |a| >= |b| or a = 0. Dekker, Numer. Math. 18 (1971)."""
    s = a + b
    return s, b - (s - a)


def split(a: Number, factor: float) -> tuple[Number, Number]:
    """(high, low) of half the bits each, high + low = a. Veltkamp, in Dekker 1971."""
    big = a * factor
    high = big - (big - a)
    return high, a - high


def two_product(a: Number, b: Number) -> tuple[Number, Number]:
    """(p, e) with p = fl(a·b) and p + e = a·b. Dekker 1971; a and b of one float type."""
    factor = SPLITTERS[significant_bits(a) or 53]
    p = a * b
    a_high, a_low = split(a, factor)
    b_high, b_low = split(b, factor)
    return p, a_low * b_low - (((p - a_high * b_high) - a_low * b_high) - a_high * b_low)


def power_of_point(b: Vec, r: Number) -> Number:
    """The power c = |b|² - r² of the point o with respect to the sphere, right to about one rounding.

    Floats: |error| <= u|c| + 17u²(|b|² + r²), Ogita, Rump & Oishi, "Accurate sum and dot product" (SIAM J. Sci.
    Comput. 26, 2005), proposition 5.5 with n = 4, γ4² < 17u². Balls: the same value with a radius for it. Exact
    numbers: as it stands.
    """
    if isinstance(b.x, Ball):
        return _enclosed(b, r)
    return _compensated(b, r) if significant_bits(b.x) else dot(b, b) - r * r


def _compensated(b: Vec, r: Number) -> Number:
    """Dot product of (bx, by, bz, r) and (bx, by, bz, -r) with all rounding errors added up (Dot2)."""
    total, error = two_product(b.x, b.x)
    for product, rest in (two_product(b.y, b.y), two_product(b.z, b.z), two_product(-r, r)):
        total, lost = two_sum(total, product)
        error = error + (lost + rest)
    return total + error


def _enclosed(b: Vec, r: Number) -> Number:
    """The midpoint of the float lanes, and a radius that holds both the exact c and every float's.

    |x² - m²| <= (2|m| + rad) rad for each argument, and twice the float's own bound: once for the float64
    midpoint (u >= 2^-53), once for the tracer that the ball stands for. Underflow loses at most
    a few times the smallest normal number, which `tiny` exceeds by far.
    """
    parts = [_as_ball(part, b.x) for part in (b.x, b.y, b.z, r)]
    u, tiny = b.x.precision
    mid = _compensated(Vec(*(part.mid for part in parts[:3])), parts[3].mid)
    spread, size = parts[0].mid * 0.0, parts[0].mid * 0.0
    for part in parts:
        width = select(part.mid < 0.0, -part.mid, part.mid)
        spread = spread + (2.0 * width + part.rad) * part.rad
        size = size + (width + part.rad) * (width + part.rad)
    bound = select(mid < 0.0, -mid, mid) + spread
    rad = spread + 2.0 * (u * bound + (17.0 * u) * u * size) + tiny
    return Ball(mid, rad * INFLATE, b.x.precision)


def _as_ball(x: Number, like: Ball) -> Ball:
    return x if isinstance(x, Ball) else Ball(x, 0.0, like.precision)
