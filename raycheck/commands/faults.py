"""raycheck faults: the known mistakes, one of them explained, or pages to learn them from."""

from __future__ import annotations

import re
from argparse import Namespace
from collections.abc import Sequence
from math import isfinite
from pathlib import Path

from oracles.faults import Fault, fault
from oracles.faults.exhibits import Exhibit, clearest, exhibit
from oracles.faults.power import Bench, kills
from oracles.faults.words import explained, in_groups, listed
from oracles.images.writing import png_bytes
from raycheck import VERSION, session
from raycheck.errors import CONFORMS, UsageError
from raycheck.formulas import formula_of
from raycheck.lanes import best_lanes
from raycheck.progress import Progress
from reports import lessons
from reports.lessons import Course, Lesson, Pair
from reports.power import SceneKill
from scenes.catalogue import ladder, rung

SIZE = (64, 48)
"""Of the pictures by which it is found out which scenes notice a fault."""


def run(options: Namespace) -> int:
    """Print the list, or one entry; or write the pages."""
    name = options.explain or options.name
    if options.explain and options.name not in (None, options.explain):
        raise UsageError(f"both {options.name!r} and --explain {options.explain} are given", "one fault")
    try:
        chosen = fault(name) if name is not None else None
    except KeyError as error:
        raise UsageError(f"no fault is called {name!r}", f"for example {error.args[0]}") from None
    if options.out is not None:
        return _pages(chosen, Path(options.out))
    for line in listed() if chosen is None else explained(chosen):
        print(line)
    return CONFORMS


def _pages(chosen: Fault | None, out: Path) -> int:
    """A page for each fault and the index, or the page of one."""
    session.make_folder(out)
    faults = in_groups() if chosen is None else [chosen]
    progress = Progress("drawing mistakes", len(ladder()) + len(faults))
    try:
        benches = []
        for scene_rung in ladder():
            benches.append(Bench(scene_rung.scene().resized(*SIZE), best_lanes()))
            progress.step(scene_rung.name)
        found = []
        for entry in faults:
            found.append(_lesson(benches, entry))
            progress.step(entry.name)
    finally:
        progress.close()
    course = Course(VERSION, len(benches), f"{SIZE[0]}x{SIZE[1]}")
    try:
        page = lessons.write(found, course, out) if chosen is None else lessons.write_one(found[0], course, out)
    except OSError as error:
        raise UsageError(f"the pages cannot be written: {error}", session.WRITABLE) from None
    print(page)
    return CONFORMS


def _lesson(benches: Sequence[Bench], entry: Fault) -> Lesson:
    noticed = list(kills(benches, entry))
    name = clearest(benches, entry, noticed)
    where = f" --scenes {name} --no-block" if name else ""
    slide = re.fullmatch(r'L11 "(.*)"', entry.source)
    return Lesson(
        name=entry.name,
        group=entry.group,
        source=entry.source,
        formula=formula_of(slide[1]) if slide else "",
        wrong=entry.wrong,
        right=entry.right,
        seen=entry.seen,
        mend=entry.mend,
        fate=entry.fate,
        reason=entry.reason,
        entries=tuple(sorted(entry.entries)),
        kills=tuple(
            SceneKill(scene=kill.scene, pixels=kill.pixels, excess=kill.excess if isfinite(kill.excess) else None)
            for kill in noticed
        ),
        pair=_pair(exhibit(rung(name).scene(), entry, best_lanes())) if name else None,
        again=f"raycheck check builtin:fault/{entry.name}{where}",
    )


def _pair(shown: Exhibit) -> Pair:
    return Pair(
        scene=shown.scene.name,
        teaches=rung(shown.scene.name).teaches,
        width=shown.scene.image.width,
        height=shown.scene.image.height,
        right=png_bytes(shown.right),
        wrong=png_bytes(shown.wrong),
        difference=png_bytes(shown.difference),
        thumbnail=png_bytes(shown.wrong[::2, ::2]),
        outside=shown.outside,
        finite=shown.finite,
    )
