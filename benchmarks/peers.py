"""Peers against ours: formulas, first hits, and every scene's arbitration with the time each party took.

`python -P benchmarks/peers.py [DIR]`: prints what docs/peers.md states, and writes the page of `raycheck peers` to DIR.
"""

from __future__ import annotations

import sys

import numpy as np

from oracles.peers import aov
from oracles.peers.formulas import errors, exactly, ours
from oracles.peers.strata import strata
from raycheck.cli import main as raycheck
from raycheck.lanes import best_lanes
from raycheck.subjects.mitsuba_process import VARIANTS, MitsubaProcess
from scenes.catalogue import ladder

CASES = 400


def main(folder: str) -> int:
    """All three tables."""
    processes = [MitsubaProcess(variant) for variant in VARIANTS]
    for process in processes:
        process.prepare()
    formulas(processes)
    first_hits(processes)
    return raycheck(["peers", "--out", folder])


def formulas(processes: list[MitsubaProcess]) -> None:
    """Worst share of the float32 budget, and worst error, of each column over each stratum."""
    names = [*(p.variant for p in processes), "ours float32", "ours float64"]
    print(f"{'formula and stratum':<24}" + "".join(f"{name:>24}" for name in names))
    for stratum in strata(0, CASES):
        truth = exactly(stratum)
        columns = [p.evaluate(stratum.formula, stratum.rows).astype(np.float64) for p in processes]
        for kind in (np.float32, np.float64):
            with np.errstate(invalid="ignore"):  # where float32 misses, the error is not a number, and counts
                found = ours(stratum.formula, tuple(stratum.rows.T.astype(kind)))
            size = len(stratum.rows)
            columns.append(np.array([np.broadcast_to(np.asarray(x, dtype=np.float64), size) for x in found]).T)
        told = [errors(stratum, truth, column) for column in columns]
        cells = "".join(f"{f'{e.share:.2g} of it, {e.worst:.1g}':>24}" for e in told)
        print(f"{stratum.formula + ', ' + stratum.name:<24}{cells}")


def first_hits(processes: list[MitsubaProcess]) -> None:
    """Position, normal and partition of the eye rays' hits over the catalogue."""
    for process in processes:
        found = []
        for rung in ladder():
            answer = process.ask("aov", rung.scene())
            if answer.values is not None:
                found.append(aov.agree(aov.met(rung.scene(), best_lanes()), answer.values))
        position, normal = max(a.position for a in found), max(a.normal for a in found)
        print(f"{process.variant}: first hits of {len(found)} scenes, position at most {position:.2g} of the budget,")
        print(f"  normal {normal:.2g}; {sum(a.outside for a in found)} pixels outside,", end=" ")
        print(f"{sum(a.misplaced for a in found)} in another part, {sum(a.doubtful for a in found)} in doubt")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else "raycheck-peers"))
