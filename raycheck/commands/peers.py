"""raycheck peers: every renderer at hand on the same scenes, and certified truth to say who is wrong."""

from __future__ import annotations

import time
from argparse import Namespace
from datetime import UTC, datetime
from pathlib import Path

from oracles.peers.arbitration import arbitrate
from oracles.verdict import SceneStandings
from raycheck import VERSION, session
from raycheck.commands.options import command_line, size_of
from raycheck.errors import CONFORMS, DIFFERS
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from raycheck.peers.parties import peers
from raycheck.progress import Progress
from reports import peers as page
from reports.peers import Arbitration


def run(options: Namespace) -> int:
    """Render, judge, write, tell; 1 if a pixel outside its bound is left unexplained."""
    out, size = Path(options.out), size_of(options.size)
    rungs = session.chosen(options.scenes.split(",") if options.scenes else None)
    scenes = [rung.scene().resized(*size) if size else rung.scene() for rung in rungs]
    session.make_folder(out)
    begin, started = time.monotonic(), datetime.now(UTC).isoformat(timespec="seconds")
    everyone, cases = list(peers()), []
    progress = Progress("asking peers", len(scenes))
    try:
        for scene in scenes:
            cases.append(arbitrate(scene, [peer.party(scene) for peer in everyone], best_lanes()))
            progress.step(scene.name)
    finally:
        progress.close()
    found = Arbitration(
        suite=VERSION,
        machine=machine(),
        started=started,
        command=command_line(options),
        seconds=time.monotonic() - begin,
        cases=tuple(cases),
    )
    session.deliver(lambda: page.write(found, out), page.lines(found), out / page.FILE)
    return DIFFERS if any(map(_open, cases)) else CONFORMS


def _open(case: SceneStandings) -> bool:
    return case.unexplained > 0
