"""raycheck needs: the least model, precision and method that draw a scene, and what more would cost."""

from __future__ import annotations

import math
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from oracles.chart.timing import Work, interleaved
from oracles.measurement import Precision
from oracles.needs import METHODS, Change, Needs, Trial, changed, needs, trials
from oracles.truth import truth
from raycheck.commands.options import picture_of
from raycheck.errors import CONFORMS
from raycheck.lanes import best_lanes
from raycheck.progress import Progress
from reference_tracer import certified
from reference_tracer.lanes import render as lanes
from reference_tracer.methods import SPHERE
from reference_tracer.rulebook import Rulebook
from scenes.model import MAX_SIDE, Scene

ROUNDS = 25
PIXELS = 2**18
"""At least so many are timed: starting the lanes costs as much as some ten thousand."""
PATIENCE = 4.0
"""Seconds after which a slow step sits out the remaining rounds."""
BITS: dict[Precision, int] = {"float32": 32, "float64": 64}
DEEPEST = 16


def run(options: Namespace) -> int:
    """Judge, time, tell."""
    scene = picture_of(options.scene, options.size)
    progress = Progress(f"reducing {scene.name}", 1)
    try:
        found, lines = _measured(scene, progress)
    finally:
        progress.close()
    for line in [*told(scene, found), *lines]:
        print(line)
    return CONFORMS


def certify(scene: Scene, progress: Progress) -> certified.Certified:
    """Truth of a model, on the lanes of this machine."""
    progress.say(f"depth {scene.depth}, {len(scene.objects)} objects, {len(scene.lights)} lights")
    return certified.render(scene, lanes.backend(best_lanes(), 64))


def draw(scene: Scene, precision: Precision, rules: Rulebook) -> NDArray[np.floating]:
    """The picture of a tracer of that precision and rulebook."""
    return lanes.render(scene, lanes.backend(best_lanes(), BITS[precision]), rules).pixels


def _measured(scene: Scene, progress: Progress) -> tuple[Needs, list[str]]:
    tolerance = truth(scene, "float32", best_lanes()).tolerance
    found = needs(scene, partial(certify, progress=progress), tolerance)
    least = found.model.of(scene)
    true = certify(least, progress)
    tried = trials(least, true, draw)
    steps = list(_steps(scene, found, tried[-1]))
    times = interleaved({step.name: step.work() for step in steps}, ROUNDS, progress.say, PATIENCE)
    base = times[steps[0].name].least
    deeper = certify(steps[1].scene, progress) if len(steps) > 1 and steps[1].scene.depth > least.depth else None
    more = changed(true, deeper, tolerance) if deeper is not None else None
    size = "x".join(map(str, _timed(least)))
    heading = f"time of {size} pixels ({best_lanes()} lanes, least of {ROUNDS} interleaved rounds)"
    edges = int((true.bits > certified.BALL_BITS).sum())
    lines = [*_trials(tried), f"  ({edges} pixels on an edge are left out)"] if edges else list(_trials(tried))
    lines += ["", heading]
    for step in steps:
        seconds, middle = times[step.name].least, times[step.name].quartiles[1]
        spread = f"(median {middle * 1e3:.2f} ms)"
        lines.append(f"  {step.name:<30}{seconds * 1e3:>9.2f} ms {seconds / base:>7.2f} times {spread:>20}")
    if deeper is not None:
        what = f"is another picture: {_words(more)}" if more else "changes nothing"
        lines.append(f"  (depth {least.depth + 1} {what})")
    return found, lines


@dataclass(frozen=True)
class Step:
    """The sufficient tracer, or one that does a step more."""

    name: str
    scene: Scene
    precision: Precision
    method: str

    def work(self) -> Work:
        """One picture."""
        scene = self.scene.resized(*_timed(self.scene))
        return Work(partial(draw, scene, self.precision, SPHERE[self.method]), 1)


def _timed(scene: Scene) -> tuple[int, int]:
    """The picture's size times the least whole number that makes it large enough to time."""
    width, height = scene.image.width, scene.image.height
    times = math.ceil(math.sqrt(PIXELS / (width * height)))
    times = max(1, min(times, MAX_SIDE // max(width, height)))
    return width * times, height * times


def _steps(scene: Scene, found: Needs, enough: Trial) -> Iterator[Step]:
    """What suffices, then one generation more, each spare part put back, the other precision, the other methods."""
    least = found.model.of(scene)
    base = Step("what suffices", least, enough.precision, enough.method)
    yield base
    if least.depth < DEEPEST:
        yield replace(base, name=f"depth {least.depth + 1}", scene=least.with_depth(least.depth + 1))
    for part in found.spare:
        if part.kind != "depth" or part.name != least.depth + 1:
            yield replace(base, name=f"with {part}", scene=found.model.joined(part).of(scene))
    if found.spare:
        yield replace(base, name="all that the scene asks for", scene=scene)
    if enough.precision == "float32":
        yield replace(base, name="float64", precision="float64")
    for method in METHODS[METHODS.index(enough.method) + 1 :]:
        yield replace(base, name=f"sphere: {method}", method=method)


def told(scene: Scene, found: Needs) -> Iterator[str]:
    """The model that suffices, and why each part of it is necessary."""
    model = found.model
    size = f"{scene.image.width}x{scene.image.height}"
    features = ", ".join(sorted(model.features)) or "none"
    yield f"{scene.name} at {size} needs features: {features}; depth: {model.depth}"
    asked = f"{len(scene.lights)} lights, {len(scene.objects)} objects"
    yield f"of {asked} it needs {len(model.lights)} and {len(model.objects)}"
    yield f"sufficient: no value changes beyond {found.bound:.2g}, the sum of both bounds"
    if found.undecided:
        yield f"  ({found.undecided} pixels that no precision decides show nothing)"
    for part in found.spare:
        yield f"  not needed: {part}"
    yield "necessary: without" if found.necessary else "necessary: nothing"
    for part, change in found.necessary:
        yield f"  {part!s:<14}{_words(change)}"


def _words(change: Change) -> str:
    told = f"{change.tolerances:.3g} tolerances of float32"
    if math.isinf(change.tolerances):
        told = "where float32 may not err at all"
    return f"{change.pixels} pixels differ, ({change.i}, {change.j}) by {change.by:.3g}, {told}"


def _trials(tried: list[Trial]) -> Iterator[str]:
    """Precision and method: what was not enough, and what is."""
    enough = tried[-1]
    verdict = f"{enough.precision}, sphere: {enough.method}" if enough.suffices else "more than float64"
    yield f"precision and method: {verdict} (no pixel more than half an 8-bit code from truth)"
    for trial in tried:
        word = "suffices" if trial.suffices else f"{trial.wrong} pixels are wrong"
        yield (
            f"  {trial.precision} {trial.method:<14}{word}: ({trial.i}, {trial.j}) is {trial.codes:.3g} codes off; "
            f"largest error {trial.error:.2g}"
        )
