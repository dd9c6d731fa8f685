"""Named inputs on which known formulas fail, run through ours and judged by truth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracles.measurement import Answer, Case, Precision
from oracles.stability import truth
from oracles.stability.cases_of_tracers import tracer_cases
from oracles.stability.frontiers import GOOD
from oracles.stability.probe import (
    DTYPES,
    ROUNDOFF,
    RefractProbe,
    SphereProbe,
    refract_methods,
    sphere_methods,
)

Triple = tuple[float, float, float]
Z: Triple = (0.0, 0.0, 1.0)
CENTRE: Triple = (0.0, 0.0, 0.0)
SPHERE_SLIDE = "Ray Tracing with a Sphere"
REFRACT_SLIDE = "Refraction Vector Calculation"


@dataclass(frozen=True)
class SphereInput:
    """A ray and a sphere as a case names them; v need not be unit."""

    number: int
    title: str
    precision: Precision
    o: Triple
    v: Triple = Z
    c: Triple = CENTRE
    r: float = 1.0
    allowed: float = GOOD  # of the smaller of r and λ


SPHERES = (
    SphereInput(1, "Far away, half a radius off the middle", "float32", (0.5, 0, -5000)),
    SphereInput(2, "The same in float64, 10⁸ radii away", "float64", (0.5, 0, -1e8)),
    SphereInput(3, "Just past the silhouette from D = 1000", "float32", (1.0001, 0, -1000)),
    SphereInput(3, "A fifth of a radius past it from D = 5000", "float32", (1.2, 0, -5000)),
    SphereInput(5, "Past the silhouette by 10⁻⁷ from D = 10⁶", "float64", (1.0000001, 0, -1e6)),
    SphereInput(
        6, "A huge sphere as floor, seen from above", "float32", (0.3, 1.7, -6), (0, -0.6, 0.8), (0, -1e6, 0), 1e6
    ),
    SphereInput(7, "The same floor, straight down", "float32", (0, 1, 0), (0, -1, 0), (0, -1e6, 0), 1e6),
    SphereInput(
        8,
        "A million radii from the world's origin, D = 10",
        "float32",
        (599996.9375, 479995.1875, 639992.0),
        (0.36, 0.48, 0.8),
        (6e5, 4.8e5, 6.4e5),
    ),
    SphereInput(
        16, "Exactly tangent, a direction that no float holds", "float64", CENTRE, (3, 4, 0), (5, 8.75, 0), 1.25
    ),
    SphereInput(16, "Exactly tangent along an axis", "float64", (1, 0, -3)),
    SphereInput(17, "A radius whose square underflows", "float32", (0, 0, -1.5e-19), Z, CENTRE, 5e-20),
    SphereInput(17, "A radius whose square overflows", "float32", (0, 0, -3e19), Z, CENTRE, 1e19),
    SphereInput(
        20,
        "Inside, 10⁻⁴ below the far wall, heading out",
        "float32",
        tuple(x * 0.9999 for x in (0.48, 0.6, 0.64)),  # type: ignore[arg-type]
        (0.0, 0.6, 0.8),
        allowed=1e-5,
    ),
)


@dataclass(frozen=True)
class RefractInput:
    """A direction i away from the surface, its normal and the index, as a case names them."""

    number: int
    title: str
    precision: Precision
    i: Triple
    n: Triple
    index: float


_DIAGONAL: Triple = (1 / math.sqrt(14), 2 / math.sqrt(14), 3 / math.sqrt(14))
REFRACTIONS = (
    RefractInput(9, "Along the normal, an axis", "float64", Z, Z, 1.5),
    RefractInput(10, "Along the normal, a diagonal", "float64", _DIAGONAL, _DIAGONAL, 1.5),
    RefractInput(10, "Along the normal, a diagonal", "float32", _DIAGONAL, _DIAGONAL, 1.5),
    RefractInput(11, "A hundred-millionth off the normal", "float64", (1e-8, 0, 1), Z, 1.5),
    RefractInput(11, "A ten-thousandth off the normal", "float32", (1e-4, 0, 1), Z, 1.5),
    RefractInput(12, "At the critical angle", "float32", (0.6, 0, 0.8), Z, 0.6),
)


def cases(sphere: Sequence[SphereProbe] = (), refract: Sequence[RefractProbe] = ()) -> list[Case]:
    """All named cases in order, with the answers of our methods and, at their precision, of the given probes."""
    found = [_sphere_case(given, sphere) for given in SPHERES] + [
        _refract_case(given, refract) for given in REFRACTIONS
    ]
    return sorted([*found, *_silhouettes(), *tracer_cases()], key=lambda case: case.number)


def _sphere_case(given: SphereInput, others: Sequence[SphereProbe]) -> Case:
    dtype = DTYPES[given.precision]
    o, c, exact_v, r = (np.array([part], dtype=dtype) for part in (given.o, given.c, given.v, given.r))
    # truth takes the direction as it is written where that is exact, the formulas the unit one
    v = exact_v / np.sqrt((exact_v * exact_v).sum(axis=1, dtype=dtype))[:, None]
    true = truth.distances(o, exact_v, c, r)
    asked: list[SphereProbe] = [
        *sphere_methods(given.precision),
        *(p for p in others if p.precision == given.precision),
    ]
    answers = []
    for probe in asked:
        got = probe.sphere(o, v, c, r)
        answers.append(Answer(who=probe.name, got=_distance(float(got[0])), right=_near(given, got, true)))
    if given.number == 8:
        answers.append(_world_point_first(o, v, c, r, true))
    return Case(
        number=given.number,
        title=given.title,
        inputs=f"{given.precision}  o = {_vector(given.o)}  v = {_vector(given.v)}  "
        f"c = {_vector(given.c)}  r = {given.r:g}",
        truth=_distance(float(true.value[0])),
        slide=SPHERE_SLIDE,
        answers=tuple(answers),
    )


def _near(given: SphereInput, got: Any, true: truth.Exact) -> bool:
    """The right decision, and a distance within what is allowed of the smaller of r and λ."""
    if math.isnan(true.value[0]) or math.isnan(got[0]):
        return math.isnan(true.value[0]) and math.isnan(got[0])
    return bool(true.error(got)[0] <= given.allowed * min(given.r, true.value[0]))


def _world_point_first(o: Any, v: Any, c: Any, r: Any, true: truth.Exact) -> Answer:
    """The root measured from the ray's point nearest the centre, formed in the world and rounded there."""
    along = ((c - o) * v).sum(axis=1, dtype=o.dtype)
    across = (o + v * along[:, None]) - c
    D = r * r - (across * across).sum(axis=1, dtype=o.dtype)
    point = o + v * (along - np.sqrt(np.maximum(D, 0)))[:, None]
    got = ((point - o) * v).sum(axis=1, dtype=o.dtype)
    right = bool(true.error(got)[0] <= GOOD)
    return Answer(who="distance from the world-space hit point", got=_distance(float(got[0])), right=right)


def _refract_case(given: RefractInput, others: Sequence[RefractProbe]) -> Case:
    dtype, u = DTYPES[given.precision], ROUNDOFF[given.precision]
    v, n = -np.array([given.i], dtype=dtype), np.array([given.n], dtype=dtype)
    index = np.array([given.index], dtype=dtype)
    true = truth.directions(v, n, index)
    cosine = -float((true.value * n).sum())
    allowed = 16.0 * u * (1.0 + 1.0 / cosine)  # the law of every stable form, with the inputs' own rounding
    answers = []
    asked: list[RefractProbe] = [
        *refract_methods(given.precision),
        *(p for p in others if p.precision == given.precision),
    ]
    for probe in asked:
        got = probe.refract(v, n, index)
        right = bool(np.all(true.error(got) <= allowed))
        answers.append(Answer(who=probe.name, got=_direction(got[0].tolist()), right=right))
    return Case(
        number=given.number,
        title=given.title,
        inputs=f"{given.precision}  i = {_vector(given.i)}  n = {_vector(given.n)}  index = {given.index:g}",
        truth=_direction(true.value[0].tolist()),
        slide=REFRACT_SLIDE,
        answers=tuple(answers),
    )


def _silhouettes() -> Iterator[Case]:
    """Case 4: the radius that a sphere seems to have from afar."""
    for D in (1e2, 1e3, 1e4, 1e5):
        answers = []
        for probe in sphere_methods("float32"):
            seen = _seen_radius(probe, D)
            answers.append(Answer(who=probe.name, got=f"{seen:.5g} r", right=abs(seen - 1.0) <= GOOD))
        yield Case(
            number=4,
            title=f"The silhouette from D = {D:g}",
            inputs=f"float32  o = (x, 0, -{D:g})  v = (0, 0, 1)  c = 0  r = 1; the largest x that is hit",
            truth="1 r",
            slide="If Ray passes the Sphere or Not",
            answers=tuple(answers),
        )


def _seen_radius(probe: SphereProbe, D: float) -> float:
    """The largest x of a fine scan at which a ray along the axis still hits."""
    x = np.linspace(0.5, 4.0, 70001).astype(np.float32)
    o = np.stack([x, np.zeros_like(x), np.full_like(x, -D)], axis=1)
    v = np.broadcast_to(np.array(Z, np.float32), o.shape)
    got = probe.sphere(o, v, np.zeros_like(o), np.ones_like(x))
    return float(x[np.isfinite(got)].max())


def _distance(x: float) -> str:
    return "miss" if math.isnan(x) else f"{x:.9g}"


def _direction(t: Sequence[float]) -> str:
    return "none" if any(math.isnan(x) for x in t) else _vector(t)


def _vector(x: Sequence[float]) -> str:
    return f"({', '.join(f'{part:.9g}' for part in x)})"
