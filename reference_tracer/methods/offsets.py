"""Where a secondary ray starts, so that it does not meet the surface that it leaves.

The hit point p = o + λv is rounded: it lies off the sphere by up to 4u(W + D)r (W = |c|/r, the distance of the
world's origin, D that of the ray's), half of the time inside. Each departure gives the origin and the least λ that
counts. Our own tracers need none (a ray that starts on a sphere has closed roots); these are what tracers do.
Measured by `raycheck stability`: how often a ray meets its own surface, and how far it is moved.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from reference_tracer.methods.words import significant_bits
from reference_tracer.numbers import Number, less, select
from reference_tracer.vector import Vec, dot, length, select_vec

Departure = Callable[[Vec, Vec, Vec, Vec, Number], tuple[Vec, Number]]
"""(p, n, v, c, r) to (origin, least λ): hit point, unit normal, new direction, and the sphere."""


def none(p: Vec, n: Vec, v: Vec, c: Vec, r: Number) -> tuple[Vec, Number]:
    """The hit point as it is, everything beyond 0 counts: half of all rays meet their own surface."""
    return p, 0.0


def t_min(least: float) -> Departure:
    """The hit point, and no hit before `least`.

    Right while residual/cos < least < the scene's nearest gap: a window that closes with distance, residual 4u(W + D).
    """

    def departure(p: Vec, n: Vec, v: Vec, c: Vec, r: Number) -> tuple[Vec, Number]:
        return p, least

    return departure


def project(p: Vec, n: Vec, v: Vec, c: Vec, r: Number) -> tuple[Vec, Number]:
    """Put p back on the sphere, then move it along n by the error that this still has, to the side of v.

    Pharr, Jakob & Humphreys, Physically Based Rendering (4th ed.), 6.8: q = (p - c) r/|p - c| is right to γ5|q|;
    adding c rounds once more, by u|c + q| <= γ5(|c| + |q|) in each component. γ5 = 5u/(1 - 5u). The offset is the
    error's extent along n.
    """
    q = (p - c) * (r / length(p - c))
    gamma = _gamma5(p.x)
    reach = Vec(*((_size(a) + _size(b)) * gamma for a, b in zip(c, q, strict=True)))
    far = dot(Vec(*(_size(a) for a in n)), reach)
    away = less(0.0, dot(n, v))
    return (c + q) + select_vec(away, n, -n) * far, 0.0


def waechter_binder(p: Vec, n: Vec, v: Vec, c: Vec, r: Number) -> tuple[Vec, Number]:
    """Move p along n by 256 units in the last place of each component, by 1/65536 within 1/32 of an axis plane.

    Wächter & Binder, "A fast and reliable method for avoiding self-intersection" (Ray Tracing Gems, 2019, ch. 6). The
    constants are float32's; NumPy float32 lanes only, since it works on the bits.
    """
    if not isinstance(p.x, np.ndarray) or p.x.dtype != np.float32:
        raise TypeError(f"{type(p.x).__name__}: the offset is defined on the bits of float32; use NumPy float32 lanes")
    away = less(0.0, dot(n, v))
    side = select_vec(away, n, -n)
    return Vec(*(_stepped(a, b) for a, b in zip(p, side, strict=True))), 0.0


def _stepped(p: Any, n: Any) -> Any:
    """One component moved by int(256 n) units in the last place, away from or toward 0 as n says."""
    steps = (np.float32(256.0) * n).astype(np.int32)
    moved = (p.view(np.int32) + np.where(p < 0.0, -steps, steps)).view(np.float32)
    return np.where(np.abs(p) < np.float32(1.0 / 32.0), p + np.float32(1.0 / 65536.0) * n, moved)


def _gamma5(like: Number) -> float:
    u = 2.0**-24 if significant_bits(like) == 24 else 2.0**-53
    return 5.0 * u / (1.0 - 5.0 * u)


def _size(x: Number) -> Number:
    return select(less(x, 0.0), -x, x)


OFFSETS: Mapping[str, Departure] = MappingProxyType(
    {
        "none": none,
        "t-min 1e-4": t_min(1e-4),
        "t-min 1e-3": t_min(1e-3),
        "Wächter-Binder": waechter_binder,
        "project": project,
    }
)
"""Start offsets, by method."""
