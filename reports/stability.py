"""stability.json and its page: where methods fail, as measured. Judges nothing, runs nothing."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from oracles.measurement import Case, Depth, Experiment, Frontier, Question, Start
from oracles.verdict import Frozen
from reports import drawings, measured, plain
from reports.results import Machine
from reports.stored import stored
from scenes.disk import write_whole

FILE = "stability.json"
PAGE = "index.html"


SHORT = {"distance": "hit points good to r/1000", "decision": "hits and misses right"}
"""Questions in the page's first sentences."""


class Stability(Frozen):
    """One measurement of our methods and, where given, of a tracer's."""

    schema_version: Literal[1] = 1
    kind: Literal["stability"] = "stability"
    suite: str
    subject: str | None
    machine: Machine
    started: str
    command: str
    seed: int
    seconds: float
    questions: tuple[Question, ...]
    frontiers: tuple[Frontier, ...]
    experiments: tuple[Experiment, ...]
    starts: tuple[Start, ...]
    gaps: tuple[float, ...]
    depths: tuple[Depth, ...]
    depth_scene: str
    cases: tuple[Case, ...]


def write(found: Stability, folder: Path) -> Path:
    """Write stability.json and index.html; return the page's path."""
    write_whole(folder / FILE, (found.model_dump_json(indent=1) + "\n").encode())
    write_whole(folder / PAGE, render(found).encode())
    return folder / PAGE


def read(folder: Path) -> Stability:
    """Read and validate stability.json; raise ResultsError."""
    return stored(Stability, folder / FILE, "raycheck stability", "measurements")


def schema() -> str:
    """The published JSON Schema."""
    return json.dumps(Stability.model_json_schema(), indent=2) + "\n"


def render(found: Stability) -> str:
    """The page's text."""
    clean = Stability.model_validate(plain.walk(found.model_dump()))
    ramp, alarm = drawings.legend()
    return measured.page(
        "stability.html",
        found=clean,
        sentences=sentences(clean),
        questions=[_asked(question, clean) for question in clean.questions],
        experiments=[_shown(experiment) for experiment in clean.experiments],
        starts=_places(clean),
        depth=drawings.depths(clean.depths),
        ramp=ramp,
        alarm=alarm,
    )


@dataclass(frozen=True)
class Row:
    """One method's frontiers in one question, by precision."""

    method: str
    law: str
    single: Frontier | None
    double: Frontier | None


def _asked(question: Question, found: Stability) -> tuple[Question, list[Row], str]:
    """A question with its table and its picture."""
    own = [f for f in found.frontiers if f.question == question.name]
    rows = []
    for method in dict.fromkeys(f.method for f in own):
        by = {f.precision: f for f in own if f.method == method}
        law = next((f.law for f in by.values() if f.law), "")
        rows.append(Row(method, law, by.get("float32"), by.get("float64")))
    return question, rows, drawings.frontiers(question, own)


def _shown(experiment: Experiment) -> tuple[Experiment, list[tuple[str, str]]]:
    """An experiment with the picture of each method's map."""
    return experiment, [(m.method, drawings.heat(experiment, m)) for m in experiment.maps]


Place = tuple[str, str, float, float]


def _places(found: Stability) -> list[tuple[Place, list[Start]]]:
    """Start offsets by precision, method and place."""
    places: dict[Place, list[Start]] = {}
    for start in found.starts:
        places.setdefault((start.precision, start.method, start.distance, start.world), []).append(start)
    return list(places.items())


def sentences(found: Stability) -> list[str]:
    """What the frontiers say, one sentence a precision: of the subject, or the lecture's formula, and of the best."""
    told = []
    for precision in ("float32", "float64"):
        parts = []
        for question in found.questions[:2]:
            own = [f for f in found.frontiers if f.question == question.name and f.precision == precision]
            # one that computes in more bits than it stores is no rival at its own precision
            rivals = [f for f in own if f.method not in (found.subject, "wide", "double-word") and f.reach]
            first = next((f for f in own if f.method == (found.subject or "lecture")), None)
            if first and rivals:
                best = max(rivals, key=lambda f: f.reach or 0.0)
                what = SHORT.get(question.name, question.title)
                parts.append(f"{what} {_holds(first)} ({best.method}: {measured.number(best.reach)})")
        if parts:
            told.append(f"{found.subject or 'The lecture'} in {precision}: {'; '.join(parts)}")
    return told


def _holds(frontier: Frontier) -> str:
    if frontier.reach is None:
        return "at no distance"
    distance = f"D = {measured.number(frontier.reach)}"
    return f"to the scan's end, {distance}" if frontier.open else f"up to {distance}"
