"""What a ray really meets and how it really bends: exact for the binary inputs, whatever made them.

A float v is not unit; truth takes the direction v/|v| in real numbers (arb), so it judges the geometry that was
asked for and not the one that the rounding of v makes of it. Decisions are signs of polynomials in the inputs, which
finite precision always settles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

Reals = NDArray[Any]
BITS = 400
"""Start here: products of six float64 numbers of like size are exact in it."""
MOST_BITS = 2**15
"""Any polynomial of degree six in float64 numbers is exact in this."""


@dataclass(frozen=True)
class Exact:
    """Real numbers to twice float64's precision: value + rest, NaN where there is none."""

    value: NDArray[np.float64]
    rest: NDArray[np.float64]

    def error(self, got: Reals) -> NDArray[np.float64]:
        """|got - truth|; NaN where either is NaN."""
        with np.errstate(invalid="ignore"):
            gap: NDArray[np.float64] = np.abs((got.astype(np.float64) - self.value) - self.rest)
        return gap


def distances(o: Reals, v: Reals, c: Reals, r: Reals) -> Exact:
    """Distance along v/|v| to the nearest point beyond the origin; NaN for a miss. A tangent is a hit.

    o, v, c: (n, 3), r: (n,), of any float type.
    """
    rows = np.column_stack([o, v, c, r]).astype(np.float64)
    return _exact([_certain(partial(_distance, *(arb(x) for x in row))) for row in rows.tolist()])


def directions(v: Reals, n: Reals, index: Reals) -> Exact:
    """The refracted unit direction (n, 3) of v/|v| at the outward normal n/|n|; NaN beyond the critical angle.

    n∘v > 0 leaves, and bends by index; n∘v <= 0 enters, and bends by 1/index.
    """
    rows = np.column_stack([v, n, index]).astype(np.float64)
    found = [_certain(partial(_direction, *(arb(x) for x in row))) for row in rows.tolist()]
    flat = _exact([part for direction in found for part in (direction or (None,) * 3)])
    return Exact(flat.value.reshape(-1, 3), flat.rest.reshape(-1, 3))


def _certain(question: Callable[[], Any]) -> Any:
    """The answer at a precision that decides all its signs."""
    before = ctx.prec
    try:
        ctx.prec = BITS
        while ctx.prec <= MOST_BITS:
            try:
                return question()
            except UndecidedSignError:
                ctx.prec *= 2
        raise ArithmeticError(f"undecided at {MOST_BITS} bits")
    finally:
        ctx.prec = before


class UndecidedSignError(Exception):
    """The ball holds 0 and other numbers."""


def _sign(x: Any) -> int:
    if x > 0:
        return 1
    if x < 0:
        return -1
    if x == 0:
        return 0
    raise UndecidedSignError


def _distance(ox: Any, oy: Any, oz: Any, vx: Any, vy: Any, vz: Any, cx: Any, cy: Any, cz: Any, r: Any) -> Any:
    bx, by, bz = ox - cx, oy - cy, oz - cz
    bv = bx * vx + by * vy + bz * vz
    vv = vx * vx + vy * vy + vz * vz
    power = bx * bx + by * by + bz * bz - r * r
    D = bv * bv - vv * power
    if _sign(D) < 0:
        return None
    outside, toward = _sign(power), _sign(bv) < 0
    if outside >= 0 and not toward:
        return None  # the sphere is behind, or touched from where the ray starts
    root = D.nonnegative_part().sqrt()
    return (-bv - root if outside > 0 else -bv + root) / vv.sqrt()


def _direction(vx: Any, vy: Any, vz: Any, nx: Any, ny: Any, nz: Any, index: Any) -> Any:
    vv, nn = vx * vx + vy * vy + vz * vz, nx * nx + ny * ny + nz * nz
    vn = vx * nx + vy * ny + vz * nz
    leaving = _sign(vn) > 0
    px, py, pz = (a - b * vn / nn for a, b in ((vx, nx), (vy, ny), (vz, nz)))
    # sin² θ2 = η² (vv nn - vn²)/(vv nn), decided as a polynomial
    square = vv * nn - vn * vn
    past = index * index * square - vv * nn if leaving else square - index * index * vv * nn
    if _sign(past) >= 0:
        return None
    eta = index if leaving else 1 / index
    cosine = (1 - eta * eta * square / (vv * nn)).nonnegative_part().sqrt()
    side = -1 if leaving else 1
    size, normal = vv.sqrt(), nn.sqrt()
    return tuple(eta * p / size - side * cosine * b / normal for p, b in ((px, nx), (py, ny), (pz, nz)))


def _exact(values: list[Any]) -> Exact:
    value = np.full(len(values), np.nan)
    rest = np.zeros(len(values))
    before = ctx.prec
    ctx.prec = BITS
    try:
        for k, x in enumerate(values):
            if x is not None:
                value[k] = float(x.mid())
                rest[k] = float((x - arb(value[k])).mid())
    finally:
        ctx.prec = before
    return Exact(value, rest)
