"""Start offsets: how often a leaving ray meets the surface it leaves, and how often it misses one close by.

One bounce: a rounded hit point, a random direction outward, the offset. *Acne*: the tracer's own formula meets the same
sphere again. *Leak*: a second sphere stands `gap` radii above the point, and the ray, in exact geometry, starts beyond
its near wall or meets it before the least distance that counts.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.random import Generator

from oracles.measurement import Precision, Start
from oracles.stability import strata
from oracles.stability.probe import DTYPES, MethodProbe
from reference_tracer.methods import SPHERE
from reference_tracer.methods.offsets import OFFSETS, Departure, waechter_binder
from reference_tracer.vector import Vec, unit

RAYS = 4000
LEAST_COSINE = 0.01
"""Leaving rays are spread evenly over the cosine, from here to 1."""
PLACES = ((10.0, 0.0), (10.0, 1e3), (10.0, 1e4), (1e3, 0.0), (1e3, 1e4))
"""Distance of the eye and of the world's origin, in radii."""
GAPS = (1e-2, 1e-3, 1e-4)
METHODS = ("lecture", "haines")


def starts(rng: Generator) -> Iterator[Start]:
    """Every offset in every place, in both precisions where it has one."""
    for precision in ("float32", "float64"):
        for method in METHODS:
            for distance, world in PLACES:
                bounces = Bounces(rng, method, precision, distance, world)
                for name, departure in OFFSETS.items():
                    if precision == "float32" or departure is not waechter_binder:
                        yield bounces.measured(name, departure)


class Bounces:
    """Hit points as the method finds them, and where their rays go next."""

    def __init__(self, rng: Generator, method: str, precision: Precision, distance: float, world: float) -> None:
        self.method, self.precision, self.distance, self.world = method, precision, distance, world
        self.probe = MethodProbe(method, precision, SPHERE[method])
        dtype = DTYPES[precision]
        rays = strata.offset_world(rng, RAYS, world, distance, dtype)
        with np.errstate(all="ignore"):
            found = self.probe.sphere(rays.o, rays.v, rays.c, rays.r)
        met = np.isfinite(found)
        self.c, self.r = rays.c[met], rays.r[met]
        self.p = (rays.o + rays.v * found[:, None].astype(dtype))[met]
        self.n = np.stack(unit(Vec(*self.p.T) - Vec(*self.c.T)), axis=-1)
        self.v = _leaving(rng, self.n)

    def measured(self, name: str, departure: Departure) -> Start:
        """One offset on these bounces."""
        p, n, v, c = (Vec(*a.T) for a in (self.p, self.n, self.v, self.c))
        origin, least = departure(p, n, v, c, self.r)
        start = np.stack(origin, axis=-1)
        again = self.probe.sphere(start, self.v, self.c, self.r)
        true = start.astype(np.float64)
        moved = np.linalg.norm(true - self.p, axis=1)
        return Start(
            offset=name,
            method=self.method,
            precision=self.precision,
            distance=self.distance,
            world=self.world,
            acne=float(np.mean(again > least)),
            leaks=tuple(self._leak(true, least, gap) for gap in GAPS),
            height=float(np.median(moved)) if name[:5] != "t-min" else least,
        )

    def _leak(self, start: strata.Reals, least: float, gap: float) -> float:
        """Share of rays that pass the near wall of a unit sphere `gap` above the surface point under the start."""
        n, v, c = (a.astype(np.float64) for a in (self.n, self.v, self.c))
        b = start - (c + n * (2.0 + gap))
        bv = np.einsum("ij,ij->i", b, v)
        power = np.einsum("ij,ij->i", b, b) - 1.0
        D = bv * bv - power
        meets = (D > 0) & (bv < 0)
        # a ray that leaves at a slant passes the second sphere by: only those that should meet it count
        should = _meets_from_surface(n, v, gap)
        distance = power / (-bv + np.sqrt(np.maximum(D, 0.0)))
        seen = meets & (power > 0) & (distance > least)
        return float(np.mean(~seen[should])) if should.any() else 0.0


def _meets_from_surface(n: strata.Reals, v: strata.Reals, gap: float) -> strata.Reals:
    """Whether the ray from the true surface point meets the sphere above it, well inside its silhouette."""
    bv = -(1.0 + gap) * np.einsum("ij,ij->i", n, v)
    inside: strata.Reals = bv * bv - ((1.0 + gap) ** 2 - 1.0) > 0.01
    return inside


def _leaving(rng: Generator, n: strata.Reals) -> strata.Reals:
    """Unit directions whose cosine to n is spread evenly over [LEAST_COSINE, 1]."""
    wide = n.astype(np.float64)
    across = np.cross(wide, rng.standard_normal(n.shape))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    cosine = rng.uniform(LEAST_COSINE, 1.0, (len(n), 1))
    found: strata.Reals = (wide * cosine + across * np.sqrt(1.0 - cosine * cosine)).astype(n.dtype)
    return found
