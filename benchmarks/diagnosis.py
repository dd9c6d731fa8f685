"""Diagnosis of known faults: how often the right one is named, alone and in pairs, and what is taken for what.

The tracers are the reference in float32 with the faults' rules, on scenes of another size than their own; the
diagnosis predicts in float64. Nothing of it is told which fault it looks at.
"""

from __future__ import annotations

import argparse
import random
import statistics
import time
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from oracles import kept
from oracles.compare import compare
from oracles.diagnosis import diagnose
from oracles.diagnosis.evidence import composable, composed
from oracles.faults import FAULTS, Fault
from oracles.faults.files import linear
from oracles.images import ImageError
from oracles.images.picture import check
from oracles.inference import Exhibit
from oracles.verdict import Diagnosis
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from reference_tracer.rulebook import LECTURE
from scenes.catalogue import ladder
from scenes.model import Scene


def exhibits(scenes: Iterable[Scene], faults: Sequence[Fault]) -> Iterator[Exhibit]:
    """What a float32 tracer with these faults writes of the scenes; pictures with NaN or Inf are none."""
    rules = composed(LECTURE, faults)
    write = next((fault.picture for fault in faults if fault.picture), lambda pixels, scene: linear(pixels))
    for scene in scenes:
        truth = kept.truth(scene, "float32", best_lanes())
        pixels = render(scene, NumPyBackend(32), rules).pixels
        try:
            picture = check(write(pixels, scene))
        except ImageError:
            continue
        yield Exhibit(picture, truth, compare(picture, truth).outside)


def names(found: Diagnosis | None) -> list[str]:
    """The faults told, those that explain most first."""
    if found is None:
        return []
    return [*(s.name for s in found.faults), *found.alike, *(s.name for s in found.others)]


def main() -> None:
    """Print the figures; --pairs N, --seed N, --size WxH."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--pairs", type=int, default=300)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--size", default="96x72")
    options.add_argument("--only", choices=("alone", "pairs"))
    chosen = options.parse_args()
    width, height = map(int, chosen.size.split("x"))
    scenes = [rung.scene().resized(width, height) for rung in ladder()]
    print(machine())
    with np.errstate(all="ignore"):
        if chosen.only != "pairs":
            alone(scenes)
        if chosen.only != "alone":
            pairs(scenes, chosen.pairs, random.Random(chosen.seed))  # noqa: S311 - faults, not secrets


def alone(scenes: Sequence[Scene]) -> None:
    """Every fault by itself."""
    first = three = named = silent = 0
    seconds = []
    live = [fault for fault in FAULTS if fault.fate == "killed"]
    for fault in live:
        shown = list(exhibits(scenes, (fault,)))
        begin = time.perf_counter()
        found = diagnose(shown)
        seconds.append(time.perf_counter() - begin)
        told = names(found)
        top = told[: 1 + len(found.alike) if found else 0]
        silent += not told
        first += fault.name in top
        three += fault.name in told[: max(3, len(top))]
        named += bool(found and found.kind == "named")
        if top != [fault.name]:
            kind = found.kind if found else "nothing wrong"
            print(f"  {fault.name}: {kind}, {', '.join(told[:4]) or 'none'}", flush=True)
    print(f"{len(live)} faults: first {first} ({first / len(live):.1%}), among three {three} ({three / len(live):.1%})")
    print(f"  named with confidence {named}, nothing told {silent}; {statistics.median(seconds):.2f} s each")


def pairs(scenes: Sequence[Scene], count: int, dice: random.Random) -> None:
    """Pairs of faults in different formulas."""
    both = one = tried = 0
    seconds = []
    live = [fault for fault in FAULTS if fault.fate == "killed"]
    while tried < count:
        first, second = dice.sample(live, 2)
        if not composable(first, second):
            continue
        tried += 1
        shown = list(exhibits(scenes, (first, second)))
        begin = time.perf_counter()
        found = diagnose(shown)
        seconds.append(time.perf_counter() - begin)
        told = {s.name for s in found.faults} | set(found.alike) if found else set()
        right = len(told & {first.name, second.name})
        both, one = both + (right == 2), one + (right >= 1)
        if right < 2:
            kind = found.kind if found else "nothing wrong"
            print(f"  {first.name} + {second.name}: {kind}, {', '.join(sorted(told)) or 'none'}", flush=True)
        if tried % 25 == 0:
            print(f"  after {tried}: both {both}, one at least {one}", flush=True)
    print(f"{tried} pairs: both named {both} ({both / tried:.1%}), one at least {one} ({one / tried:.1%})")
    print(f"  {statistics.median(seconds):.2f} s each, at most {max(seconds):.1f} s")


if __name__ == "__main__":
    main()
