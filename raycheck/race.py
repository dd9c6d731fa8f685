"""Whole tracers side by side: time of a picture without what an empty one costs, against its error."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from oracles.chart.timing import summed
from oracles.compare import compare
from oracles.images import Picture
from oracles.measurement import Panel, Point
from oracles.truth import Truth, truth
from raycheck.lanes import best_lanes
from raycheck.subjects import Subject, attach
from reference_tracer import certified
from scenes.catalogue import rung
from scenes.model import Scene

SCENE = "lecture-final"
SIZE = (160, 120)
ROUNDS = 9
PATIENCE = 5.0
"""Seconds after which a slow tracer sits out the remaining rounds."""
LEAST = 1e-5
"""A difference of two clock readings below this says nothing."""
OURS = ("plain", "numpy/32", "numpy/64", "drjit/32", "drjit/64")
PANEL = Panel(
    name="tracers",
    title="Whole tracers",
    about=f"{SCENE} at {SIZE[0]}x{SIZE[1]}, the time of the same picture without objects and lights subtracted. "
    "Pixels that the precision decides; hollow: a value outside its tolerance.",
    per="one picture",
    measure="99 % quantile of the pixels' |error|",
    tolerance=1.0,
)


@dataclass
class _Runner:
    """A tracer, its times with and without objects, and its last picture."""

    subject: Subject
    full: list[float] = field(default_factory=list)
    empty: list[float] = field(default_factory=list)
    picture: Picture | None = None
    message: str = ""


def ours() -> list[Subject]:
    """The reference tracer in every arithmetic of this machine."""
    names = [name for name in OURS if not name.startswith("drjit") or best_lanes() == "drjit"]
    return [attach(f"builtin:reference/{name}") for name in names]


def points(subjects: Sequence[Subject], seed: int, tell: Callable[[str], None]) -> tuple[list[Point], list[str]]:
    """A dot for each tracer that gives a picture, and what to say about those that give none."""
    scene = rung(SCENE).scene().resized(*SIZE)
    exact = certified.render_exact(scene).value
    tell("the exact picture")
    runners = [_Runner(subject, message=_unable(subject, scene)) for subject in subjects]
    _race(runners, scene, seed, tell)
    truths = {p: truth(scene, p, best_lanes()) for p in {runner.subject.precision for runner in runners}}
    found = [
        _point(runner, exact, truths[runner.subject.precision]) for runner in runners if runner.picture is not None
    ]
    base = next((p.seconds for p in found if p.baseline), found[0].seconds if found else 1.0)
    told = [f"{runner.subject.name}: {runner.message}" for runner in runners if runner.picture is None]
    return [p.model_copy(update={"ratio": p.seconds / base}) for p in found], told


def _unable(subject: Subject, scene: Scene) -> str:
    """Why the scene is not asked of this tracer; empty if it is."""
    missing = sorted(scene.features - set(subject.features)) if subject.features is not None else []
    return f"unsupported: {scene.name} needs {', '.join(missing)}" if missing else ""


def _race(runners: Sequence[_Runner], scene: Scene, seed: int, tell: Callable[[str], None]) -> None:
    """Round after round, the full picture and the empty one; the first round warms up."""
    empty = scene.model_copy(update={"objects": (), "lights": ()})
    for k in range(ROUNDS + 1):
        for runner in runners:
            if sum(runner.full) > PATIENCE or runner.message:
                continue
            attempt = runner.subject.render(scene, seed)
            if attempt.picture is None:
                runner.message = f"{attempt.word}: {attempt.message}"
                continue
            runner.picture = attempt.picture
            nothing = runner.subject.render(empty, seed)
            if k:
                runner.full.append(attempt.seconds)
                # one that cannot do without objects is charged with its start
                runner.empty.append(nothing.seconds if nothing.picture else 0.0)
        tell(f"tracers, round {k} of {ROUNDS}")


def _point(runner: _Runner, exact: NDArray[np.float64], lawful: Truth) -> Point:
    picture = runner.picture
    assert picture is not None  # noqa: S101 - only those with a picture come here
    start = min(runner.empty)
    times = summed([max(LEAST, seconds - start) for seconds in runner.full])
    comparison = compare(picture, lawful)
    error = _error(picture, exact, lawful.doubts == 0)
    judged = comparison.judged
    return Point(
        panel=PANEL.name,
        name=runner.subject.name,
        kind="in process" if runner.subject.in_process else "program",
        precision=runner.subject.precision,
        seconds=times.least,
        spread=times.quartiles,
        ratio=1.0,
        error=error,
        bits=float(-np.log2(error)) if error else None,
        wrong=judged.outside / judged.pixels if comparison.word == "fail" else 0.0,
        baseline=runner.subject.spec == "builtin:reference/plain",
        frontier=False,
    )


def _error(picture: Picture, exact: NDArray[np.float64], decided: NDArray[np.bool_]) -> float | None:
    """The 99 % quantile of the decided pixels' largest error; displayed pictures against the clamped truth."""
    coded = picture.maximum is not None
    got = picture.values / picture.maximum if picture.maximum is not None else picture.values
    error = np.abs(got - (np.clip(exact, 0.0, 1.0) if coded else exact)).max(axis=-1)
    return float(np.quantile(error[decided], 0.99)) if decided.any() else None
