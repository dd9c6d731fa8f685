"""The panels of formulas: what is asked, how wrong it is, how long it takes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.chart.arithmetics import Answers, Arithmetic, BallLanes, Lanes, Scalars, one_core
from oracles.chart.timing import Times, Work, interleaved
from oracles.measurement import Panel, Point
from oracles.stability import strata, truth
from oracles.stability.frontiers import GOOD
from oracles.stability.strata import Rays
from reference_tracer.lanes.render import backend
from reference_tracer.methods import REFRACT, SPHERE

Reals = NDArray[Any]
RAYS = 300
ROUNDS = 30
NUMPY_RAYS = 8192
DRJIT_RAYS = 2**17
SCALAR_RAYS = 12
TEST = "one ray against one sphere, on one core"


@dataclass(frozen=True)
class Stratum:
    """Rays of one difficulty, rounded to a type; relative: errors are told in λ, else in r."""

    panel: Panel
    make: Callable[[np.random.Generator, Any], Rays]
    relative: bool = False


def _panel(name: str, title: str, about: str, measure: str = "largest |Δλ|/r") -> Panel:
    return Panel(name=name, title=title, about=about, per=TEST, measure=measure, tolerance=GOOD)


def _seen(distance: float) -> Callable[[np.random.Generator, Any], Rays]:
    return lambda rng, dtype: strata.inside_the_disc(rng, RAYS, distance, dtype)


STRATA = (
    Stratum(_panel("near", "Ordinary: 10 radii away", "Impacts up to 0.9 radii."), _seen(10.0)),
    Stratum(_panel("far", "1,000 radii away", "Impacts up to 0.9 radii."), _seen(1e3)),
    Stratum(_panel("farther", "100,000 radii away", "Impacts up to 0.9 radii."), _seen(1e5)),
    Stratum(
        _panel("grazing", "Grazing", "10 radii away, half a thousandth inside the silhouette, half outside."),
        lambda rng, dtype: strata.grazing(rng, RAYS, 10.0, GOOD, dtype),
    ),
    Stratum(
        _panel("floor", "Just above a huge sphere", "10⁻⁴ radii above it, cosine 0.5 to 1.", "largest |Δλ|/λ"),
        lambda rng, dtype: strata.above(rng, RAYS, 1e-4, float(rng.uniform(0.5, 1.0)), dtype),
        relative=True,
    ),
    Stratum(
        _panel("world", "A million radii from the world's origin", "10 radii away, impacts up to 0.9 radii."),
        lambda rng, dtype: strata.offset_world(rng, RAYS, 1e6, 10.0, dtype),
    ),
)
NUMBERS = _panel(
    "numbers", "Number types", "The lecture's formula, ordinary rays; balls and arb at the bound they prove."
)
METHODS = _panel("methods", "Methods, float64", "The largest error over all strata above.")
REFRACTION = Panel(
    name="refraction",
    title="Refraction near the normal",
    about="A tenth along the normal, the others 10⁻⁸ to 10⁻¹ off it; index 1.5, entering.",
    per="one ray",
    measure="largest |Δt|",
    tolerance=GOOD,
)
PANELS = (*(stratum.panel for stratum in STRATA), REFRACTION, NUMBERS, METHODS)


@dataclass(frozen=True)
class Contender:
    """A method in an arithmetic."""

    method: str
    arithmetic: Arithmetic

    @property
    def key(self) -> str:
        return f"{self.method} · {self.arithmetic.name}"


def float_arithmetics(lanes: str) -> list[Arithmetic]:
    """Python, NumPy in both precisions, and DrJit's where it works."""
    found: list[Arithmetic] = [Scalars("Python", "float64", SCALAR_RAYS)]
    for bits in (32, 64):
        found.append(Lanes(backend("numpy", bits), f"NumPy float{bits}", NUMPY_RAYS))
        if lanes == "drjit":
            found.append(Lanes(backend("drjit", bits), f"DrJit float{bits}", DRJIT_RAYS))
    return found


def proving_arithmetics(lanes: str) -> list[Arithmetic]:
    """Balls and arb: numbers that prove how far they are off."""
    found: list[Arithmetic] = [BallLanes(backend("numpy", 64), "NumPy balls", NUMPY_RAYS)]
    if lanes == "drjit":
        found.append(BallLanes(backend("drjit", 64), "DrJit balls", DRJIT_RAYS))
    return found + [Scalars(f"arb, {bits} bits", "exact", SCALAR_RAYS, bits) for bits in (53, 128, 256)]


def points(lanes: str, rng: np.random.Generator, tell: Callable[[str], None]) -> list[Point]:
    """All dots of these panels; their frontiers are not marked yet."""
    plain, proving = float_arithmetics(lanes), proving_arithmetics(lanes)
    spheres = [Contender(m, a) for a in plain for m in SPHERE if m != "wide" or a.precision == "float32"]
    proofs = [Contender("lecture", a) for a in proving]
    baseline = Contender("lecture", plain[-1])
    works = {c.key: c.arithmetic.sphere_work(SPHERE[c.method]) for c in (*spheres, *proofs)}
    with one_core(lanes):
        times = interleaved(works, ROUNDS, lambda what: tell(f"spheres, {what}"))
    found = []
    for stratum in STRATA:
        found += _stratum_points(stratum, spheres, times, baseline.key, rng)
        tell(stratum.panel.title)
    found += _number_points([c for c in spheres if c.method == "lecture"] + proofs, times, baseline.key, rng)
    found += _method_points(found, baseline)
    bends = [Contender(m, a) for a in plain for m in REFRACT]
    with one_core(lanes):
        return found + _refraction_points(bends, Contender("division-free", plain[-1]).key, rng, tell)


def _stratum_points(
    stratum: Stratum, contenders: Sequence[Contender], times: dict[str, Times], baseline: str, rng: np.random.Generator
) -> list[Point]:
    """One panel: the same rays, rounded to float32 once and for float64 once."""
    given = {bits: stratum.make(rng, dtype) for bits, dtype in (("float32", np.float32), ("float64", np.float64))}
    true = {bits: truth.distances(rays.o, rays.v, rays.c, rays.r) for bits, rays in given.items()}
    found = []
    for c in contenders:
        rays, exact = given[c.arithmetic.precision], true[c.arithmetic.precision]
        scale = exact.value if stratum.relative else rays.r.astype(np.float64)
        answers = c.arithmetic.spheres(SPHERE[c.method], rays)
        error, wrong = _judged(answers, exact, scale)
        found.append(_point(stratum.panel, c, times[c.key], error, wrong, times[baseline].least, c.key == baseline))
    return found


def _number_points(
    contenders: Sequence[Contender], times: dict[str, Times], baseline: str, rng: np.random.Generator
) -> list[Point]:
    """The lecture's formula in every number type, on ordinary rays."""
    found = []
    wide, narrow = (STRATA[0].make(rng, dtype) for dtype in (np.float64, np.float32))
    for c in contenders:
        rays = narrow if c.arithmetic.precision == "float32" else wide
        exact = truth.distances(rays.o, rays.v, rays.c, rays.r)
        answers = c.arithmetic.spheres(SPHERE[c.method], rays)
        error, wrong = _judged(answers, exact, rays.r.astype(np.float64))
        found.append(_point(NUMBERS, c, times[c.key], error, wrong, times[baseline].least, c.key == baseline))
    return found


def _method_points(points: Sequence[Point], baseline: Contender) -> list[Point]:
    """Each method's worst error over the strata, in the baseline's arithmetic."""
    own = [p for p in points if p.panel != NUMBERS.name and p.kind == baseline.arithmetic.name]
    found = []
    for method in dict.fromkeys(p.name for p in own):
        group = [p for p in own if p.name == method]
        errors = [p.error for p in group if p.error is not None]
        error, wrong = max(errors, default=None), max(p.wrong for p in group)
        update = {"panel": METHODS.name, "error": error, "bits": _bits(error), "wrong": wrong}
        found.append(group[0].model_copy(update=update))
    return found


def _refraction_points(
    contenders: Sequence[Contender], baseline: str, rng: np.random.Generator, tell: Callable[[str], None]
) -> list[Point]:
    works: dict[str, Work] = {c.key: c.arithmetic.refract_work(REFRACT[c.method]) for c in contenders}
    times = interleaved(works, ROUNDS, lambda what: tell(f"refraction, {what}"))
    angle = 10.0 ** rng.uniform(-8, -1, RAYS)
    angle[::10] = 0.0
    found = []
    for bits, dtype in (("float32", np.float32), ("float64", np.float64)):
        bends = strata.bends(rng, angle, 1.5, False, dtype)
        exact = truth.directions(bends.v, bends.n, bends.index)
        for c in (c for c in contenders if c.arithmetic.precision == bits):
            answers = c.arithmetic.refractions(REFRACT[c.method], bends)
            error, wrong = _judged(answers, exact, np.ones(RAYS))
            found.append(_point(REFRACTION, c, times[c.key], error, wrong, times[baseline].least, c.key == baseline))
    return found


def _judged(answers: Answers, exact: truth.Exact, scale: Reals) -> tuple[float | None, float]:
    """The largest error (or proved bound) in units of scale, and the share of wrong decisions."""
    got = answers.values
    there, should = (np.isfinite(a).reshape(len(a), -1).all(axis=1) for a in (got, exact.value))
    both = there & should
    if answers.bound is not None:
        sure = both & np.isfinite(answers.bound)
        return (float((answers.bound / scale)[sure].max()) if sure.any() else None), 0.0
    error = exact.error(got).reshape(len(got), -1).max(axis=1) / scale
    worst = float(error[both].max()) if both.any() else None
    return worst, float(np.mean((there != should) | (both & (error > GOOD))))


def _bits(error: float | None) -> float | None:
    return float(-np.log2(error)) if error else None


def _point(
    panel: Panel, c: Contender, times: Times, error: float | None, wrong: float, base: float, baseline: bool
) -> Point:
    return Point(
        panel=panel.name,
        name=c.method,
        kind=c.arithmetic.name,
        precision=c.arithmetic.precision,
        seconds=times.least,
        spread=times.quartiles,
        ratio=times.least / base,
        error=error,
        bits=_bits(error),
        wrong=wrong,
        baseline=baseline,
        frontier=False,
    )
