"""raycheck golden: make goldens, or find out whether they still stand."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from oracles.golden import GoldenError, make, verify
from oracles.golden.record import Manifest
from raycheck import VERSION, session
from raycheck.commands.options import command_line, dialect_words, size_of
from raycheck.errors import CONFORMS, DIFFERS, UsageError
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from raycheck.progress import Progress
from raycheck.subjects import dialect_of
from scenes.catalogue import ladder
from scenes.model import Scene


def run(options: Namespace) -> int:
    """Make or verify."""
    folder = Path(options.folder)
    try:
        return _make(options, folder) if options.action == "make" else _verify(options, folder)
    except GoldenError as error:
        raise UsageError(str(error)) from None


def _make(options: Namespace, folder: Path) -> int:
    if not 1 <= options.jobs <= 64:
        raise UsageError(f"--jobs {options.jobs}: out of range", "1 to 64")
    size = size_of(options.size, options.jobs)
    rungs = session.chosen(options.scenes.split(",") if options.scenes else None)
    scenes = [rung.scene().resized(*size) if size else rung.scene() for rung in rungs]
    session.make_folder(folder)
    here = machine()
    made_by = Manifest(
        suite=VERSION,
        machine=f"{here.processor}, {here.cores} cores, {here.system}, Python {here.python}",
        packages=here.packages,
        command=command_line(options),
        dialect=dialect_of(dialect_words(options.dialect)).choices().other(),
        goldens={},
    )
    progress = Progress("making goldens", len(scenes))
    try:
        manifest = make(folder, scenes, made_by, best_lanes(), options.jobs, lambda name, *_: progress.step(name))
    finally:
        progress.close()
    wanted = [manifest.goldens[scene.name] for scene in scenes]
    worst = max((entry.largest_bound for entry in wanted), default=0.0)
    undecided = sum(entry.undecided_pixels for entry in wanted)
    print(f"{len(wanted)} goldens in {folder}, every value proved to {worst:.2g}, {undecided} pixels are hulls")
    return CONFORMS


def _verify(options: Namespace, folder: Path) -> int:
    today: dict[str, Scene] = {rung.name: rung.scene() for rung in ladder()}
    progress = Progress("verifying goldens", 1)
    try:
        problems = verify(folder, today.get, best_lanes(), lambda name, k, n: progress.share(k / n, f"{k}/{n} {name}"))
    finally:
        progress.close()
    for name, problem in problems.items():
        print(f"{name}: {problem}")
    fallen = "1 golden does not stand" if len(problems) == 1 else f"{len(problems)} goldens do not stand"
    print(fallen if problems else "all goldens stand")
    return DIFFERS if problems else CONFORMS
