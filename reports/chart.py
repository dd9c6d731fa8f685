"""chart.json and its page: speed against accuracy, as measured. Judges nothing, runs nothing."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

from oracles.measurement import Panel, Point
from oracles.verdict import Frozen
from reports import measured, plain, scatter
from reports.results import Machine
from reports.stored import stored
from scenes.disk import write_whole

FILE = "chart.json"
PAGE = "index.html"


class Chart(Frozen):
    """One measurement; remarks: what to know about tracers that have no dot."""

    schema_version: Literal[1] = 1
    kind: Literal["chart"] = "chart"
    suite: str
    subject: str | None
    machine: Machine
    started: str
    command: str
    seed: int
    seconds: float
    panels: tuple[Panel, ...]
    points: tuple[Point, ...]
    remarks: tuple[str, ...] = ()


def write(found: Chart, folder: Path) -> Path:
    """Write chart.json, one line a point, and index.html; return the page's path."""
    write_whole(folder / FILE, text(found).encode())
    write_whole(folder / PAGE, render(found).encode())
    return folder / PAGE


def text(found: Chart) -> str:
    """The JSON with every point on a line of its own."""
    points = ",\n  ".join(point.model_dump_json() for point in found.points)
    rest = found.model_dump_json(indent=1, exclude={"points"})
    return f'{rest.rstrip().removesuffix("}").rstrip()},\n "points": [\n  {points}\n ]\n}}\n'


def read(folder: Path) -> Chart:
    """Read and validate chart.json; raise ResultsError."""
    return stored(Chart, folder / FILE, "raycheck chart", "measurements")


def schema() -> str:
    """The published JSON Schema."""
    return json.dumps(Chart.model_json_schema(), indent=2) + "\n"


def render(found: Chart) -> str:
    """The page's text."""
    clean = Chart.model_validate(plain.walk(found.model_dump()))
    shown = []
    for panel in clean.panels:
        own = [point for point in clean.points if point.panel == panel.name]
        shown.append((panel, own, scatter.scatter(panel, own), scatter.tones(own)))
    return measured.page("chart.html", found=clean, panels=shown)
