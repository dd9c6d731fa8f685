"""The dictionary's faults before the gates of other suites: which of them each gate misses, and whom it wrongly fails.

`python -P benchmarks/gates.py [SIZE]`: every fault and every correct tracer on the whole catalogue at SIZE (160x120),
as 8-bit pictures, displayed as the scene asks. The golden is the right tracer's, in float32 as theirs.
A gate notices a fault if it fails one scene. Beside that, each gate on lecture-final alone, which is how most render
tests are: of the faults that raycheck notices there, how many the gate misses. Printed as docs/faults.md has it.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from functools import cache

import numpy as np

from oracles.faults import FAULTS, TWINS, Fault, Twin
from oracles.faults.power import Bench, picture, touches
from oracles.gates import GATES, Codes
from oracles.images import Picture
from raycheck.machine import machine
from reference_tracer.formulas.display import encode
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from scenes.catalogue import ladder, rung
from scenes.model import Scene


def codes(found: Picture, scene: Scene) -> Codes:
    """The 8-bit codes of a picture."""
    if found.maximum is None:
        return encode(found.values, scene.display)
    return np.asarray(found.values, dtype=np.int64)


@cache
def catalogue(size: tuple[int, int]) -> tuple[tuple[Scene, Codes], ...]:
    """Every scene, and what its picture should be."""
    scenes = [entry.scene().resized(*size) for entry in ladder()]
    return tuple((scene, golden(scene)) for scene in scenes)


def golden(scene: Scene) -> Codes:
    """What the right tracer draws."""
    return encode(render(scene, NumPyBackend(32)).pixels, scene.display)


def drawn(entry: Fault | Twin, size: tuple[int, int]) -> Iterator[tuple[Codes, Codes]]:
    """What is expected and what is got, of every scene that the entry can touch and whose codes differ."""
    for scene, expected in catalogue(size):
        if isinstance(entry, Twin):
            got = codes(picture(entry.scene(scene), entry, entry.precision), scene)
        elif touches(scene, entry.entries):
            got = codes(picture(scene, entry), scene)
        else:
            continue
        if not np.array_equal(got, expected):
            yield expected, got


def failed_by(entry: Fault | Twin, size: tuple[int, int]) -> set[str]:
    """The gates that fail the entry on some scene; those that differ most are asked first."""
    found: set[str] = set()
    pairs = sorted(drawn(entry, size), key=lambda pair: -float(np.mean(np.abs(pair[0] - pair[1]))))
    for expected, got in pairs:
        found |= {name for name, gate in GATES.items() if name not in found and gate(expected, got)}
        if len(found) == len(GATES):
            break
    return found


def on_one_scene(faults: list[Fault], size: tuple[int, int]) -> tuple[int, dict[str, int]]:
    """How many faults raycheck notices on lecture-final, and how many of these each gate misses there."""
    scene = rung("lecture-final").scene().resized(*size)
    bench, expected = Bench(scene), golden(scene)
    pictures = [codes(picture(scene, fault), scene) for fault in faults if bench.kill(fault)]
    return len(pictures), {name: sum(not gate(expected, got) for got in pictures) for name, gate in GATES.items()}


def _without(gate: str, found: dict[str, set[str]]) -> list[str]:
    return [name for name, gates in found.items() if gate not in gates]


def _counted(names: list[str]) -> str:
    return f"{len(names)}: {', '.join(names)}" if names else "0"


def main(size: tuple[int, int]) -> None:
    """Both tables."""
    begin, here = time.perf_counter(), machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}")
    faults = [fault for fault in FAULTS if fault.fate != "equivalent"]
    noticed = {fault.name: failed_by(fault, size) for fault in faults}
    wronged = {twin.name: failed_by(twin, size) for twin in TWINS}
    seen, unseen = on_one_scene(faults, size)
    print(f"\n| gate | faults missed, of {len(faults)} | correct tracers failed, of {len(TWINS)} |", end="")
    print(f" missed on lecture-final alone, of {seen} |\n|---|---|---|---|")
    for gate in GATES:
        missed, wrong = _without(gate, noticed), [name for name, gates in wronged.items() if gate in gates]
        print(f"| {gate} | {_counted(missed)} | {_counted(wrong)} | {unseen[gate]} |")
    none = [name for name, gates in noticed.items() if not gates]
    print(f"\nmissed by all of them: {len(none)}: {', '.join(none)}")
    print(f"{time.perf_counter() - begin:.0f} s, {time.process_time():.0f} s of a core")


if __name__ == "__main__":
    width, height = (sys.argv[1] if len(sys.argv) > 1 else "160x120").split("x")
    main((int(width), int(height)))
