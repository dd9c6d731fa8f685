"""raycheck chart: speed against accuracy of methods, number types, depth and whole tracers."""

from __future__ import annotations

import time
from argparse import Namespace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from oracles.chart import depth, panels, pareto
from raycheck import VERSION, race
from raycheck.commands.options import command_line
from raycheck.errors import CONFORMS, UsageError
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from raycheck.progress import Progress
from raycheck.session import make_folder
from raycheck.subjects import Subject, attach
from raycheck.subjects.images import ImagesSubject
from reports import chart
from reports.measured import duration, number

STEPS = 2 * panels.ROUNDS + depth.ROUNDS + race.ROUNDS + len(panels.STRATA) + 6


def run(options: Namespace) -> int:
    """Measure, write, tell the frontiers."""
    subjects = [_timed(attach(spec, options.precision or "float32")) for spec in options.subjects]
    folder = Path(options.out)
    make_folder(folder)
    for subject in subjects:
        subject.prepare()
    found = measure(subjects, options.seed, command_line(options))
    path = chart.write(found, folder)
    for panel in found.panels:
        print(f"{panel.title} ({panel.measure})")
        for p in found.points:
            if p.panel == panel.name and p.frontier:
                what = f"{p.name} · {p.kind}"
                print(f"  {what:<44}{duration(p.seconds):>9}  {number(p.error)}")
    for remark in found.remarks:
        print(f"no dot: {remark}")
    print(f"report: {path}")
    return CONFORMS


def _timed(subject: Subject) -> Subject:
    """The subject; pictures that somebody rendered before have no time and are refused."""
    if isinstance(subject, ImagesSubject):
        raise UsageError(f"{subject.spec} takes no time", "a tracer that renders: a folder with raycheck.toml")
    return subject


def measure(subjects: list[Subject], seed: int, command: str) -> chart.Chart:
    """Every panel."""
    begin = time.monotonic()
    started = datetime.now(UTC).isoformat(timespec="seconds")
    progress = Progress("measuring", STEPS)
    lanes = best_lanes()
    points = panels.points(lanes, np.random.default_rng(seed), progress.step)
    points += depth.points(lanes, progress.step)
    tracers, remarks = race.points([*race.ours(), *subjects], seed, progress.step)
    progress.close()
    return chart.Chart(
        suite=VERSION,
        subject=", ".join(subject.name for subject in subjects) or None,
        machine=machine(),
        started=started,
        command=command,
        seed=seed,
        seconds=time.monotonic() - begin,
        panels=(*panels.PANELS, depth.PANEL, race.PANEL),
        points=tuple(pareto.with_frontier([*points, *tracers])),
        remarks=tuple(remarks),
    )
