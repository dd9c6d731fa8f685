"""Bit for bit: plain, NumPy and DrJit float64 on every scene of the catalogue."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from raycheck.machine import machine
from reference_tracer import llvm, plain
from reference_tracer.lanes import render as lanes
from scenes.catalogue import ladder


def differing(a: NDArray[np.floating], b: NDArray[np.floating]) -> int:
    """Values whose bits differ, of two float64 images."""
    return int(np.count_nonzero(a.view(np.uint64) != b.view(np.uint64)))


def main() -> None:
    """One line a scene, and the sum."""
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}, lanes: {here.lanes}")
    names = ["numpy"] + (["drjit"] if llvm.find() else [])
    print(f"{'scene':<28}{'values':>8}" + "".join(f"{'plain-' + name:>14}" for name in names))
    sums = dict.fromkeys(names, 0)
    for rung in ladder():
        scene = rung.scene()
        truth = plain.render(scene).pixels
        found = {name: differing(truth, lanes.render(scene, lanes.backend(name, 64)).pixels) for name in names}
        sums = {name: sums[name] + found[name] for name in names}
        print(f"{rung.name:<28}{truth.size:>8}" + "".join(f"{found[name]:>14}" for name in names))
    print(f"{'differing values in all':<36}" + "".join(f"{sums[name]:>14}" for name in names))


if __name__ == "__main__":
    main()
