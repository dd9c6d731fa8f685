"""Error maps: every method on the same inputs, cell by cell, judged by truth."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from oracles.measurement import Axis, Experiment, Grid, Map, Precision
from oracles.stability import strata, truth
from oracles.stability.probe import DTYPES, RefractProbe, SphereProbe

Reals = NDArray[Any]
Cell = tuple[float | None, float | None]
"""Share of wrong decisions, and the largest error of the right ones; None where there is no such case."""

RAYS = 400
GAPS: dict[Precision, tuple[float, ...]] = {
    "float32": (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
    "float64": (1.0, 1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12),
}
DISTANCES: dict[Precision, tuple[float, ...]] = {
    # beyond 1/u radii the rounding of v alone moves a ray by a radius
    "float32": (1.5, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7),
    "float64": (1.5, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9),
}
HEIGHTS: dict[Precision, tuple[float, ...]] = {
    "float32": (1e1, 1e0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6),
    "float64": (1e1, 1e0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14),
}
COSINES = (1.0, 0.9, 0.7, 0.5, 0.3, 0.1)
WORLDS = (0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7)
FROM = (10.0, 100.0)
ANGLES: dict[Precision, tuple[float, ...]] = {
    "float32": (0.0, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.7, 1.5),
    "float64": (0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1e-1, 0.7, 1.5),
}
INDICES = (1.0003, 1.1, 1.33, 1.5, 2.4)
SHORT_OF_CRITICAL: dict[Precision, tuple[float, ...]] = {
    "float32": (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8),
    "float64": (1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16),
}


def distance_map(probes: Sequence[SphereProbe], precision: Precision, rng: Generator) -> Experiment:
    """Distance in radii against how close to the silhouette."""
    return _sphere_experiment(
        probes,
        precision,
        lambda D, gap: strata.grazing(rng, RAYS, D, gap, DTYPES[precision]),
        Axis(name="distance D = |b|/r", values=DISTANCES[precision]),
        Axis(name="gap to the silhouette |s - 1|", values=GAPS[precision]),
        name="distance",
        title="Far and grazing",
        about="Half of each cell's rays pass just inside the silhouette, half just outside; the radius is chosen "
        "for the rounded ray, so that the gap is what the axis says.",
    )


def height_map(probes: Sequence[SphereProbe], precision: Precision, rng: Generator) -> Experiment:
    """Height above a huge sphere against steepness."""

    def make(height: float, cosine: float) -> strata.Rays | None:
        """No rays where they could pass the sphere: s = (1 + h) sin >= 0.999."""
        passes = (1.0 + height) * np.sqrt(1.0 - cosine * cosine) >= 0.999
        return None if passes else strata.above(rng, RAYS, height, cosine, DTYPES[precision])

    return _sphere_experiment(
        probes,
        precision,
        make,
        Axis(name="height h above the surface, in radii", values=HEIGHTS[precision]),
        Axis(name="steepness, cosine to the vertical", values=COSINES),
        name="height",
        title="Just above a huge sphere",
        about="A sphere as floor: the eye or a hit point close to it. Empty cells: rays that may pass by.",
        relative=True,
    )


def world_map(probes: Sequence[SphereProbe], precision: Precision, rng: Generator) -> Experiment:
    """Where the world's origin is against distance."""
    return _sphere_experiment(
        probes,
        precision,
        lambda W, D: strata.offset_world(rng, RAYS, W, D, DTYPES[precision]),
        Axis(name="world offset W = |c|/r", values=WORLDS),
        Axis(name="distance D", values=FROM),
        name="world",
        title="Far from the world's origin",
        about="Sphere and eye far from the origin, near each other; impacts up to 0.9 radii.",
    )


def normal_map(probes: Sequence[RefractProbe], precision: Precision, rng: Generator) -> Experiment:
    """Angle of incidence against index, entering."""

    def make(angle: float, index: float) -> strata.Bends:
        return strata.bends(rng, np.full(RAYS, angle), index, False, DTYPES[precision])

    return _refract_experiment(
        probes,
        precision,
        make,
        Axis(name="angle of incidence θ1", values=ANGLES[precision]),
        name="normal",
        title="Refraction near normal incidence",
        about="Entering a denser medium. At 0 the ray is the normal, to the last bit.",
    )


def critical_map(probes: Sequence[RefractProbe], precision: Precision, rng: Generator) -> Experiment:
    """Distance to the critical angle against index, leaving."""

    def make(short: float, index: float) -> strata.Bends:
        signs = np.where(np.arange(RAYS) % 2, -short, short)
        return strata.bends(rng, np.arcsin(1.0 / index) * (1.0 + signs), index, True, DTYPES[precision])

    return _refract_experiment(
        probes,
        precision,
        make,
        Axis(name="distance to the critical angle |θ1/θc - 1|", values=SHORT_OF_CRITICAL[precision]),
        name="critical",
        title="Refraction near the critical angle",
        about="Leaving a denser medium, half of the rays just below the angle of total reflection, half just above.",
    )


def _sphere_experiment(
    probes: Sequence[SphereProbe],
    precision: Precision,
    make: Callable[[float, float], strata.Rays | None],
    x: Axis,
    y: Axis,
    name: str,
    title: str,
    about: str,
    relative: bool = False,
) -> Experiment:
    def cell(a: float, b: float) -> list[Cell]:
        rays = make(a, b)
        if rays is None:
            return [(None, None)] * len(probes)
        true = truth.distances(rays.o, rays.v, rays.c, rays.r)
        scale = true.value if relative else rays.r.astype(np.float64)
        return [_judged(probe.sphere(rays.o, rays.v, rays.c, rays.r), true, scale) for probe in probes]

    measure = "|Δλ|/λ, largest" if relative else "|Δλ|/r, largest"
    maps = _maps([(probe.name, precision) for probe in probes], x, y, cell)
    return Experiment(
        name=name, title=title, about=about, measure=measure, precision=precision, x=x, y=y, cases=RAYS, maps=maps
    )


def _refract_experiment(
    probes: Sequence[RefractProbe],
    precision: Precision,
    make: Callable[[float, float], strata.Bends],
    x: Axis,
    name: str,
    title: str,
    about: str,
) -> Experiment:
    y = Axis(name="index", values=INDICES)

    def cell(a: float, b: float) -> list[Cell]:
        inputs = make(a, b)
        true = truth.directions(inputs.v, inputs.n, inputs.index)
        return [_judged(probe.refract(inputs.v, inputs.n, inputs.index), true, np.ones(1)) for probe in probes]

    return Experiment(
        name=name,
        title=title,
        about=about,
        measure="|Δt|, largest component",
        precision=precision,
        x=x,
        y=y,
        cases=RAYS,
        maps=_maps([(probe.name, precision) for probe in probes], x, y, cell),
    )


def _judged(got: Reals, true: truth.Exact, scale: Reals) -> Cell:
    """Wrong decisions and the largest error of answers (n,) or (n, 3), in units of scale."""
    there, should = (np.isfinite(a).reshape(len(a), -1).all(axis=1) for a in (got, true.value))
    wrong = float(np.mean(there != should))
    both = there & should
    if not both.any():
        return wrong, None
    error = true.error(got).reshape(len(got), -1).max(axis=1) / np.abs(scale)
    return wrong, float(error[both].max())


def _maps(
    names: Sequence[tuple[str, Precision]], x: Axis, y: Axis, cell: Callable[[float, float], list[Cell]]
) -> tuple[Map, ...]:
    rows = [[cell(a, b) for a in x.values] for b in y.values]

    def grid(k: int, part: int) -> Grid:
        return tuple(tuple(found[k][part] for found in row) for row in rows)

    return tuple(
        Map(method=name, precision=precision, wrong=grid(k, 0), error=grid(k, 1))
        for k, (name, precision) in enumerate(names)
    )
