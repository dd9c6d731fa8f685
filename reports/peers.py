"""peers.html and peers.json: N versions of each scene, and who is wrong."""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

from jinja2 import Environment

from oracles.verdict import Frozen, SceneStandings, Standing
from reports import format, plain, templating
from reports.results import Machine
from scenes.disk import write_whole

FILE, DATA = "peers.html", "peers.json"


class Arbitration(Frozen):
    """One run of `raycheck peers`."""

    schema_version: Literal[1] = 1
    suite: str
    machine: Machine
    started: str
    command: str
    seconds: float
    cases: tuple[SceneStandings, ...]


@dataclass(frozen=True)
class Total:
    """A party over all scenes that it rendered: seconds in all, median of the scenes' p99, worst, pixels outside."""

    party: str
    scenes: int
    seconds: float
    p99: float
    worst: float
    outside: int
    explained: int


def totals(found: Arbitration) -> list[Total]:
    """Every party, in the order of its first appearance."""
    by_party: dict[str, list[Standing]] = {}
    for case in found.cases:
        for standing in case.standings:
            by_party.setdefault(standing.party, []).append(standing)
    return [_total(name, [s for s in standings if not s.message]) for name, standings in by_party.items()]


def _total(name: str, standings: list[Standing]) -> Total:
    return Total(
        party=name,
        scenes=len(standings),
        seconds=sum(s.seconds for s in standings),
        p99=statistics.median(s.p99 for s in standings) if standings else 0.0,
        worst=max((s.worst for s in standings), default=0.0),
        outside=sum(s.outside for s in standings),
        explained=sum(s.explained for s in standings),
    )


def lines(found: Arbitration) -> Iterator[str]:
    """The table of parties, then every standing outside its bound."""
    yield f"{'party':<34} {'scenes':>6} {'time':>8} {'p99':>8} {'worst':>8} {'outside':>8} {'explained':>9}"
    for t in totals(found):
        yield (
            f"{t.party:<34} {t.scenes:>6} {format.seconds(t.seconds):>8} {format.measure(t.p99):>8} "
            f"{format.measure(t.worst):>8} {t.outside:>8} {t.explained:>9}"
        )
    for case in found.cases:
        for s in case.standings:
            if s.outside:
                why = f"{s.explained} explained: {s.reason}" if s.explained else "unexplained"
                yield f"{case.scene}: {s.party} is outside at {s.outside} pixels, {why}"


def write(found: Arbitration, folder: Path) -> Path:
    """Write both files whole or not at all; return the page's path."""
    write_whole(folder / DATA, (found.model_dump_json(indent=1) + "\n").encode())
    template = _environment().get_template(FILE)
    text = template.render(found=found, totals=totals(found), points=points(totals(found)), policy=_policy())
    write_whole(folder / FILE, text.encode())
    return folder / FILE


@dataclass(frozen=True)
class Point:
    """A party on the chart of accuracy against speed: places in a square of 100."""

    party: str
    x: float
    y: float


def points(parties: list[Total]) -> list[Point]:
    """Seconds a scene to the right, median p99 error upward, both logarithmic; only what has both."""
    from math import log10

    shown = [t for t in parties if t.scenes and t.seconds > 0.0 and t.p99 > 0.0]
    xs, ys = [log10(t.seconds / t.scenes) for t in shown], [log10(t.p99) for t in shown]
    return [Point(t.party, _place(x, xs), 100.0 - _place(y, ys)) for t, x, y in zip(shown, xs, ys, strict=True)]


def _place(value: float, values: list[float]) -> float:
    low, high = min(values), max(values)
    return round(100.0 * (value - low) / (high - low), 1) if high > low else 50.0


@cache
def _environment() -> Environment:
    return templating.templates({"measure": format.measure, "seconds": format.seconds, "plain": plain.text})


@cache
def _policy() -> str:
    """The page's Content-Security-Policy: its own style and nothing else."""
    return templating.policy(_environment(), ("page.css",))
