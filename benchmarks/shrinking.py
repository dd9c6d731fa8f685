"""How small failing scenes become: every fault of the dictionary on the first scene that notices it.

Prints, for all faults together, things, pixels and digits before and after, tries and seconds; and each search that
did not come to its end within the limits that `raycheck check` sets. No correct tracer may fail what is left.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence

from oracles.conventions import Convention
from oracles.faults import FAULTS, TWINS, Fault, Twin
from oracles.faults.power import Bench
from oracles.shrinking import Limits, Step, shrink, size, words
from raycheck.shrink import Failing, ShrinkPlan
from raycheck.subjects import attach
from scenes.catalogue import Rung, ladder

PLAN = ShrinkPlan("")


def main() -> None:
    """Shrink, and print the table."""
    benches = [(entry, Bench(entry.scene().resized(64, 48))) for entry in ladder()]
    found = []
    for fault in FAULTS:
        entry = _first(benches, fault)
        if entry is not None:
            found.append(_shrunk(entry, fault))
    steps = [steps for steps, _ in found if steps]
    before, after = ([size(s[k].scene) for s in steps] for k in (0, -1))
    print(
        f"{len(steps)} of {len(found)} faults fail at full size too; {sum(s[-1].least for s in steps)} searches ended"
    )
    for name, k in (("things", 0), ("depth", 1), ("terms", 2), ("pixels", 3), ("digits", 4)):
        print(f"{name:<8} {_spread([s[k] for s in before]):>24} -> {_spread([s[k] for s in after])}")
    print(f"{'tries':<8} {_spread([s[-1].tries for s in steps]):>24}")
    print(f"{'seconds':<8} {_spread([seconds for s, seconds in found if s]):>24}")
    wronged = [f"{twin.name} by {s[-1].scene.name}" for s in steps for twin in TWINS if _wronged(s[-1], twin)]
    print(f"correct tracers that a shrunk scene fails: {', '.join(wronged) or 'none'} ({len(steps)} x {len(TWINS)})")
    print(f"a single pixel: {sum(s[3] == 1 for s in after)}, at most two things: {sum(s[0] <= 2 for s in after)}")


def _first(benches: Sequence[tuple[Rung, Bench]], fault: Fault) -> Rung | None:
    """The first rung that notices the fault."""
    return next((entry for entry, bench in benches if bench.kill(fault)), None)


def _shrunk(entry: Rung, fault: Fault) -> tuple[list[Step], float]:
    """The steps, and how long they took."""
    begin = time.monotonic()
    failing = Failing(attach(f"builtin:fault/{fault.name}"), 0, Convention(), begin + PLAN.seconds)
    steps = list(shrink(entry.scene(), failing, Limits(PLAN.tries, PLAN.seconds)))
    if steps and not steps[-1].least:
        print(f"{fault.name} on {entry.name}: left at {words(steps[-1].scene)} after {steps[-1].tries} tries")
    return steps, time.monotonic() - begin


def _wronged(step: Step, twin: Twin) -> bool:
    """Whether the shrunk scene fails a correct tracer."""
    return Bench(step.scene).wrongly_killed(twin) is not None


def _spread(values: Sequence[float]) -> str:
    """Median and largest."""
    return f"median {statistics.median(values):.3g}, most {max(values):.3g}"


if __name__ == "__main__":
    main()
