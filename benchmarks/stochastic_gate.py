"""How often the statistical gate fails a right path tracer, and how many samples a bias needs to be found.

`python -P benchmarks/stochastic_gate.py [RUNS]`: Mitsuba's stock path tracer on glass-fresnel, RUNS (200) seeded checks
each against other seeds of itself (its mean is right by construction) and against our reference; then index
1.50 -> 1.51 and all light x 1.01, with more and more samples. Needs Mitsuba and a libLLVM.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from oracles.statistics import Samples, area_average, judge
from oracles.statistics.gate import ALPHA
from oracles.truth import truth
from raycheck.sampling import RUNS, UNITS
from raycheck.subjects.mitsuba_process import MitsubaProcess
from scenes.catalogue import rung
from scenes.model import Colour, Scene

SIZE = (64, 48)
SPP = 16
SEEDED = 1_000_000
"""Seeds of the pools are spaced by this."""
Pool = NDArray[np.float64]


def main(checks: int) -> None:
    """Print every rate with its count."""
    scene = rung("glass-fresnel").scene().resized(*SIZE)
    expected = truth(scene, "float32")
    mitsuba = MitsubaProcess("llvm_ad_rgb")
    mitsuba.prepare()
    begin = time.monotonic()
    right = renders(mitsuba, scene, SPP, checks * RUNS, 0)
    again = renders(mitsuba, scene, SPP, checks * UNITS // 4, SEEDED)
    units = area_average(scene, 12 * UNITS, 7, "drjit")
    print(f"{len(right) + len(again)} renders of {SPP} spp and {len(units)} units: {time.monotonic() - begin:.0f} s")
    rng = np.random.default_rng(1)
    for name, pool in (("itself, other seeds", again), ("our reference", units)):
        alarms, bias = 0, []
        for k in range(checks):
            reference = pool[rng.choice(len(pool), UNITS, replace=False)]
            found = judge(Samples(right[k * RUNS : (k + 1) * RUNS], SPP), reference, expected)
            alarms += found.word == "fail"
            bias.append(found.sampled.smallest_bias)
        print(f"against {name}: {alarms} alarms in {checks} checks, stated {ALPHA:.0%}; sees {np.median(bias):.2%}")
    for name, change in NEGATIVES.items():
        for spp in (4, 16, 64, 256):
            seen = [
                judge(
                    Samples(renders(mitsuba, change(scene), spp, RUNS, k * RUNS), spp),
                    units[rng.choice(len(units), UNITS, replace=False)],
                    expected,
                ).word
                for k in range(10)
            ]
            print(f"{name}: {RUNS} renders of {spp} spp: found in {seen.count('fail')} of {len(seen)} checks")


def renders(mitsuba: MitsubaProcess, scene: Scene, spp: int, count: int, seed: int) -> Pool:
    """Renders of consecutive seeds."""
    found = []
    for k in range(count):
        answer = mitsuba.ask("path", scene, seed + k, spp)
        assert answer.values is not None, answer.message
        found.append(answer.values.astype(np.float64))
    return np.array(found)


def denser(scene: Scene) -> Scene:
    """Glass of index 1.51 in place of 1.50."""
    glass = scene.materials["glass"].model_copy(update={"index": 1.51})
    return scene.model_copy(update={"materials": {**scene.materials, "glass": glass}})


def brighter(scene: Scene) -> Scene:
    """All that shines, 1 % brighter."""

    def more(colour: Colour) -> Colour:
        return (1.01 * colour[0], 1.01 * colour[1], 1.01 * colour[2])

    materials = {name: m.model_copy(update={"ambient": more(m.ambient)}) for name, m in scene.materials.items()}
    return scene.model_copy(update={"materials": materials, "background": more(scene.background)})


NEGATIVES: dict[str, Callable[[Scene], Scene]] = {"index 1.50 -> 1.51": denser, "light x 1.01": brighter}

if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
