"""raycheck power: which scenes and laws notice which known mistake, and whether any fails a correct tracer."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Sequence
from datetime import UTC, datetime
from math import isfinite
from pathlib import Path

from oracles.faults import FAULTS, TWINS, Fault, Twin, law_power
from oracles.faults.law_power import LawBench
from oracles.faults.power import Bench, Kill, kills
from raycheck import VERSION, session
from raycheck.commands.options import command_line, size_of
from raycheck.errors import CONFORMS, DIFFERS
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from raycheck.progress import Progress
from reports import power as page
from reports.power import FaultPower, LawKill, Power, SceneKill, TwinPower
from scenes.catalogue import ladder


def run(options: Namespace) -> int:
    """Render every fault and twin, judge, write, tell; 1 unless the dictionary's claims hold."""
    out, size = Path(options.out), size_of(options.size)
    session.make_folder(out)
    begin, started = time.monotonic(), datetime.now(UTC).isoformat(timespec="seconds")
    rungs = ladder()
    progress = Progress("measuring power", len(rungs) + len(FAULTS) + len(TWINS))
    try:
        benches = []
        for rung in rungs:
            benches.append(Bench(rung.scene().resized(*size) if size else rung.scene(), best_lanes()))
            progress.step(rung.name)
        laws = LawBench(best_lanes())
        faults = tuple(_fault(benches, laws, fault, progress) for fault in FAULTS)
        twins = tuple(_twin(benches, laws, twin, progress) for twin in TWINS)
    finally:
        progress.close()
    found = Power(
        suite=VERSION,
        machine=machine(),
        started=started,
        command=command_line(options),
        seconds=time.monotonic() - begin,
        size=options.size or "each at its own size",
        scenes=tuple(rung.name for rung in rungs),
        laws=laws.names,
        faults=faults,
        twins=twins,
    )
    session.deliver(lambda: page.write(found, out), page.lines(found), out / page.FILE)
    return CONFORMS if found.holds else DIFFERS


def _told(kill: Kill) -> SceneKill:
    excess = kill.excess if isfinite(kill.excess) else None
    return SceneKill(scene=kill.scene, pixels=kill.pixels, excess=excess)


def _broken(kill: law_power.LawKill) -> LawKill:
    return LawKill(law=kill.law, excess=kill.excess if isfinite(kill.excess) else None)


def _fault(benches: Sequence[Bench], laws: LawBench, fault: Fault, progress: Progress) -> FaultPower:
    found = tuple(_told(kill) for kill in kills(benches, fault))
    broken = tuple(map(_broken, laws.kills(fault)))
    progress.step(fault.name)
    return FaultPower(
        name=fault.name, group=fault.group, fate=fault.fate, reason=fault.reason, kills=found, laws=broken
    )


def _twin(benches: Sequence[Bench], laws: LawBench, twin: Twin, progress: Progress) -> TwinPower:
    found = (bench.wrongly_killed(twin) for bench in benches)
    wrong = tuple(_told(kill) for kill in found if kill)
    broken = tuple(map(_broken, laws.kills(twin)))
    progress.step(twin.name)
    return TwinPower(name=twin.name, how=twin.how, kills=wrong, laws=broken)
