"""Inputs by how hard they are: rays at a distance, grazing, above a floor, far from the origin; angles of refraction.

All are random from a generator and rounded to the probe's type first; what is asked of them (an impact of just 1 - 1e-9
radii) is then met by choosing the radius for the rounded ray, so truth is never blurred by the input's rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.random import Generator
from numpy.typing import NDArray

from oracles.stability.truth import BITS

Reals = NDArray[Any]


@dataclass(frozen=True)
class Rays:
    """Rays and a sphere for each: o, v, c (n, 3), r (n,)."""

    o: Reals
    v: Reals
    c: Reals
    r: Reals


@dataclass(frozen=True)
class Bends:
    """Travelling directions v and outward normals n (n, 3), indices (n,)."""

    v: Reals
    n: Reals
    index: Reals


def aimed(rng: Generator, distance: float, impact: Reals, dtype: Any) -> Rays:
    """Rays from `distance` radii off that pass the centre at `impact` radii, one a ray; 0 aims at the centre."""
    count = len(impact)
    a, across = _frames(rng, count)
    sine = (impact / distance)[:, None]
    v = (across * sine - a * np.sqrt(1.0 - sine * sine)).astype(dtype)
    o, c = (a * distance).astype(dtype), np.zeros((count, 3), dtype)
    r = np.ones(count)
    past = impact > 0
    if past.any():
        r[past] = _passing(o[past], v[past]) / impact[past]
    return Rays(o, v, c, r.astype(dtype))


def grazing(rng: Generator, count: int, distance: float, gap: float, dtype: Any) -> Rays:
    """Half at 1 - gap radii from the centre, half at 1 + gap; gap 1: all through the centre."""
    signs = np.where(np.arange(count) % 2, -gap, gap)
    return aimed(rng, distance, 1.0 + signs if gap < 1 else np.zeros(count), dtype)


def inside_the_disc(rng: Generator, count: int, distance: float, dtype: Any) -> Rays:
    """Impacts up to 0.9 radii, evenly."""
    return aimed(rng, distance, rng.uniform(0.01, 0.9, count), dtype)


def above(rng: Generator, count: int, height: float, cosine: float, dtype: Any) -> Rays:
    """From `height` radii above the surface, down at this cosine to the vertical."""
    a, across = _frames(rng, count)
    v = across * np.sqrt(1.0 - cosine * cosine) - a * cosine
    ones = np.ones(count, dtype)
    return Rays((a * (1.0 + height)).astype(dtype), v.astype(dtype), np.zeros((count, 3), dtype), ones)


def offset_world(rng: Generator, count: int, world: float, distance: float, dtype: Any) -> Rays:
    """Impacts up to 0.9, the sphere `world` radii from the origin."""
    near = inside_the_disc(rng, count, distance, dtype)
    c = np.broadcast_to(np.array([0.6, 0.48, 0.64]) * world, (count, 3)).astype(dtype)
    o = (near.o.astype(np.float64) + c).astype(dtype)
    # o is rounded: aim again from where it came to lie
    b = o.astype(np.float64) - c
    size = np.linalg.norm(b, axis=1, keepdims=True)
    across = np.cross(b, rng.standard_normal((count, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    sine = rng.uniform(0.01, 0.9, (count, 1)) / size
    v = (across * sine - b / size * np.sqrt(1.0 - sine * sine)).astype(dtype)
    return Rays(o, v, c, np.ones(count, dtype))


def bends(rng: Generator, angle: Reals, index: float, leaving: bool, dtype: Any) -> Bends:
    """Incidence at these angles to the normal; at 0 v is -n to the last bit (or n, on leaving)."""
    n, across = _frames(rng, len(angle))
    n = n.astype(dtype)
    side = 1.0 if leaving else -1.0
    v = side * n.astype(np.float64) * np.cos(angle)[:, None] + across * np.sin(angle)[:, None]
    v = np.where(angle[:, None] == 0.0, side * n, v)
    return Bends(v.astype(dtype), n, np.full(len(angle), index, dtype))


def _frames(rng: Generator, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Random unit vectors and, for each, one across it."""
    a, b = rng.standard_normal((2, count, 3))
    across = np.cross(a, b)
    return a / np.linalg.norm(a, axis=1, keepdims=True), across / np.linalg.norm(across, axis=1, keepdims=True)


def _passing(o: Reals, v: Reals) -> NDArray[np.float64]:
    """How far each line passes the origin: |o - (o∘v)v/(v∘v)|, right to the last bit."""
    before = ctx.prec
    ctx.prec = BITS
    try:
        rows = np.column_stack([o, v]).astype(np.float64).tolist()
        return np.array([_distance_of_line(*(arb(x) for x in row)) for row in rows])
    finally:
        ctx.prec = before


def _distance_of_line(ox: Any, oy: Any, oz: Any, vx: Any, vy: Any, vz: Any) -> float:
    ov, vv = ox * vx + oy * vy + oz * vz, vx * vx + vy * vy + vz * vz
    square = (ox * ox + oy * oy + oz * oz) - ov * ov / vv
    return float(square.nonnegative_part().sqrt().mid())
