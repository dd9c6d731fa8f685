"""Failure frontiers: how far each method holds, one number a question, with what its error law predicts beside it.

A scan goes from easy to hard in steps of an eighth of a decade; the frontier is the last step before the first that
fails. A law is an upper bound of the error, so it predicts the first failure that is *possible*: a measured
frontier lies at it or beyond.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from oracles.measurement import Frontier, Precision, Question
from oracles.stability import laws, strata, truth
from oracles.stability.probe import DTYPES, ROUNDOFF, RefractProbe, SphereProbe

Reals = NDArray[Any]
RAYS = 200
STEPS = 8
"""A decade."""
GOOD = 1e-3
"""What a frontier asks of an error, and how near the silhouette it asks for right decisions: a thousandth of the radius
is a pixel of a sphere that is drawn a thousand pixels high. Named cases and charts ask the same."""

DISTANCE = Question(
    name="distance", title="Hit point within r/1000, impacts up to 0.9 r", unit="D = |b|/r", farther="up"
)
DECISION = Question(
    name="decision", title="Right hit or miss, a thousandth off the silhouette", unit="D = |b|/r", farther="up"
)
HEIGHT = Question(name="height", title="Distance right to 1/1000 just above the surface", unit="h/r", farther="down")
BENDING = Question(
    name="bending", title="Bend of a ray right to 1/1000, index 1.5, entering", unit="θ1", farther="down"
)
QUESTIONS = (DISTANCE, DECISION, HEIGHT, BENDING)


@dataclass(frozen=True)
class _Scan:
    """Values from easy to hard, and for each the probes that fail there."""

    question: Question
    values: NDArray[np.float64]
    failing: Callable[[float], list[bool]]


def span(question: str, precision: Precision) -> tuple[float, float]:
    """The first and the last value that a scan asks about, from easy to hard."""
    u = ROUNDOFF[precision]
    far = (1.5, 0.5 / u)  # beyond 1/u the rounding of v moves the ray by radii
    spans = {DISTANCE.name: far, DECISION.name: far, HEIGHT.name: (1.0, 2.0 * u), BENDING.name: (1.0, u)}
    return spans[question]


def sphere_frontiers(probes: Sequence[SphereProbe], precision: Precision, rng: Generator) -> list[Frontier]:
    """The three frontiers of ways to meet a sphere; all of one precision."""
    names = [p.name for p in probes]
    return [found for scan in _sphere_scans(probes, precision, rng) for found in _walk(scan, names, precision)]


def refract_frontiers(probes: Sequence[RefractProbe], precision: Precision, rng: Generator) -> list[Frontier]:
    """How near the normal the bend of a ray is still right: |Δt| against sinθ2."""
    return _walk(_refract_scan(probes, precision, rng), [p.name for p in probes], precision)


def until(question: str, limit: float, probe: SphereProbe | RefractProbe, rng: Generator) -> Frontier:
    """The frontier of one probe, looked for as far as the limit, itself among the values; open: it holds that far."""
    if question == BENDING.name:
        scan = _refract_scan((cast(RefractProbe, probe),), probe.precision, rng)
    else:
        scans = _sphere_scans((cast(SphereProbe, probe),), probe.precision, rng)
        scan = next(scan for scan in scans if scan.question.name == question)
    easier = scan.values < limit if scan.question.farther == "up" else scan.values > limit
    (found,) = _walk(replace(scan, values=np.append(scan.values[easier], limit)), [probe.name], probe.precision)
    return found


def _sphere_scans(probes: Sequence[SphereProbe], precision: Precision, rng: Generator) -> tuple[_Scan, ...]:
    dtype = DTYPES[precision]

    def too_wrong(rays: strata.Rays, relative: bool) -> list[bool]:
        true = truth.distances(rays.o, rays.v, rays.c, rays.r)
        scale = true.value if relative else rays.r.astype(np.float64)
        answers = [probe.sphere(rays.o, rays.v, rays.c, rays.r) for probe in probes]
        return [not bool(np.all(true.error(got) / scale <= GOOD)) for got in answers]

    def undecided(D: float) -> list[bool]:
        rays = strata.grazing(rng, RAYS, D, GOOD, dtype)
        meets = np.isfinite(truth.distances(rays.o, rays.v, rays.c, rays.r).value)
        answers = [probe.sphere(rays.o, rays.v, rays.c, rays.r) for probe in probes]
        return [bool(np.any(np.isfinite(got) != meets)) for got in answers]

    far, near = _steps(*span(DISTANCE.name, precision)), _steps(*span(HEIGHT.name, precision))
    return (
        _Scan(DISTANCE, far, lambda D: too_wrong(strata.inside_the_disc(rng, RAYS, D, dtype), False)),
        _Scan(DECISION, far, undecided),
        _Scan(HEIGHT, near, lambda h: too_wrong(strata.above(rng, RAYS, h, 1.0, dtype), True)),
    )


def _refract_scan(probes: Sequence[RefractProbe], precision: Precision, rng: Generator) -> _Scan:
    dtype = DTYPES[precision]

    def too_wrong(angle: float) -> list[bool]:
        inputs = strata.bends(rng, np.full(RAYS, angle), 1.5, False, dtype)
        true = truth.directions(inputs.v, inputs.n, inputs.index)
        bend = np.sin(angle) / 1.5
        answers = [probe.refract(inputs.v, inputs.n, inputs.index) for probe in probes]
        return [not bool(np.all(true.error(got) <= GOOD * bend)) for got in answers]

    return _Scan(BENDING, _steps(*span(BENDING.name, precision)), too_wrong)


def _steps(first: float, last: float) -> NDArray[np.float64]:
    """From first to last, STEPS a decade."""
    decades = np.log10(last / first)
    count = int(abs(decades) * STEPS) + 1
    found: NDArray[np.float64] = first * 10.0 ** (np.arange(count) * np.sign(decades) / STEPS)
    return found


def _walk(scan: _Scan, names: Sequence[str], precision: Precision) -> list[Frontier]:
    """The last value before each probe's first failure."""
    reach: list[float | None] = [None] * len(names)
    standing = [True] * len(names)
    for value in scan.values.tolist():
        for k, failed in enumerate(scan.failing(value)):
            standing[k] = standing[k] and not failed
            reach[k] = value if standing[k] else reach[k]
        if not any(standing):
            break
    return [
        Frontier(
            question=scan.question.name,
            method=name,
            precision=precision,
            reach=reach[k],
            open=standing[k],
            predicted=laws.predicted(scan.question.name, name, precision, GOOD),
            law=laws.text(scan.question.name, name),
        )
        for k, name in enumerate(names)
    ]
