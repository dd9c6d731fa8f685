"""How many cases of laws a second: on our own lanes in this process, and through a pipe to examples/cpp_lecture.

    python benchmarks/laws_speed.py [--cases N]

A case counts from its coordinates to its verdict: made, asked, judged. Best and worst of five runs by the clock; in
process also by processor time, which other work on the machine disturbs less.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from oracles.laws import Law, formula_laws
from oracles.laws.cases import reading
from oracles.laws.dice import seeded
from raycheck.lanes import best_lanes
from raycheck.probes import prober_of
from raycheck.subjects import attach
from reference_tracer.operations import formulas

RUNS = 5
EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "cpp_lecture"


def best(run: Callable[[], None]) -> tuple[float, float, float]:
    """Seconds of the fastest and the slowest of RUNS runs, and the least processor time, after one that warms up."""
    run()
    seconds, busy = [], []
    for _ in range(RUNS):
        begin, cpu = time.perf_counter(), time.process_time()
        run()
        seconds.append(time.perf_counter() - begin)
        busy.append(time.process_time() - cpu)
    return min(seconds), max(seconds), min(busy)


def told(name: str, cases: int, spread: tuple[float, float, float], ours: bool = True) -> None:
    """One line of the table; ours: all the work is done in this process."""
    fast, slow, busy = (cases / seconds for seconds in spread)
    cpu = f"   {busy:12,.0f} a processor second" if ours else ""
    print(f"{name:36} {fast:12,.0f}/s   slowest {slow:12,.0f}/s{cpu}", flush=True)


def in_process(cases: int) -> None:
    """Laws on lanes, tile by tile so that a batch stays in the processor's cache."""
    tile = min(cases, 2**14)
    groups = {"sphere laws": "sphere/", "plane laws": "plane/", "reflect laws": "reflect/", "refract laws": "refract/"}
    kinds = [("numpy", 64), ("numpy", 32)] + ([("drjit", 64), ("drjit", 32)] if best_lanes() == "drjit" else [])
    for kind, bits in kinds:
        ask = formulas(kind, bits)
        for title, start in groups.items():
            laws = [law for law in formula_laws() if law.name.startswith(start)]

            def run(laws: list[Law] = laws, ask: object = ask, bits: int = bits) -> None:
                for law in laws:
                    for seed in range(cases // tile):
                        reading(law, seeded(tile, f"float{bits}", seed), ask).excess()  # type: ignore[arg-type]

            told(f"{title} on {kind} float{bits}", len(laws) * (cases // tile) * tile, best(run))


def through_a_pipe(count: int) -> None:
    """Probes of the C++ example, and whole laws on it."""
    if not (shutil.which("make") and shutil.which("g++")):
        print("no C++ compiler: examples/cpp_lecture is not asked")
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "cpp_lecture"
        shutil.copytree(EXAMPLE, copy, ignore=shutil.ignore_patterns("tracer"))
        subject = attach(str(copy))
        subject.prepare()
        prober = prober_of(subject)
        assert prober is not None
        prober.open()
        for operation, width in (("sphere", 10), ("reflect", 6), ("refract", 7), ("phong", 10)):
            rows = np.random.default_rng(1).normal(size=(count, width)).astype(np.float32).astype(np.float64)
            rows[:, -1] = np.abs(rows[:, -1]) if operation != "phong" else 10.0
            told(f"pipelined probes to C++: {operation}", count, best(partial(prober, operation, rows)), False)

        def laws() -> None:
            for law in formula_laws():
                reading(law, seeded(2000, "float32", 0), prober).excess()

        told("all formula laws on C++", 2000 * len(formula_laws()), best(laws), False)
        prober.close()


def main() -> None:
    """Both tables."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--cases", type=int, default=2**17)
    parser.add_argument("--probes", type=int, default=50_000)
    options = parser.parse_args()
    in_process(options.cases)
    through_a_pipe(options.probes)


if __name__ == "__main__":
    main()
