"""The depth panel: what each generation costs, and how far the picture still is from the full one."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from oracles.chart.timing import Work, interleaved
from oracles.measurement import Panel, Point
from reference_tracer import certified
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.backend import Backend
from scenes.catalogue import rung
from scenes.model import Scene

SCENE = "lecture-final"
FULL = 16
"""The deepest a scene may ask for."""
DEEPEST = 6
JUDGED = (48, 36)
TIMED = (320, 240)
ROUNDS = 7
PANEL = Panel(
    name="depth",
    title="Depth",
    about=f"{SCENE} at {TIMED[0]}x{TIMED[1]}; the error is against the exact picture of depth {FULL}.",
    per="one picture",
    measure="mean |error| of a pixel's value",
    tolerance=1.0,
)


def points(kind: str, tell: Callable[[str], None]) -> list[Point]:
    """Depth 0 to 6 in float32 and float64 on these lanes."""
    full = certified.render_exact(rung(SCENE).scene().resized(*JUDGED).with_depth(FULL)).value
    tell("the full picture")
    runs = {
        (bits, depth): (lanes.backend(kind, bits), rung(SCENE).scene().with_depth(depth))
        for bits in (32, 64)
        for depth in range(DEEPEST + 1)
    }
    works = {f"{bits}/{depth}": _work(*run) for (bits, depth), run in runs.items()}
    times = interleaved(works, ROUNDS, lambda what: tell(f"depth, {what}"))
    found = []
    for (bits, depth), (backend, scene) in runs.items():
        got = lanes.render(scene.resized(*JUDGED), backend).pixels.astype(np.float64)
        error = float(np.abs(got - full).mean())
        taken = times[f"{bits}/{depth}"]
        found.append(
            Point(
                panel=PANEL.name,
                name=f"depth {depth}",
                kind=f"{'DrJit' if kind == 'drjit' else 'NumPy'} float{bits}",
                precision=f"float{bits}",
                seconds=taken.least,
                spread=taken.quartiles,
                ratio=taken.least / times["64/3"].least,
                error=error,
                bits=float(-np.log2(error)) if error else None,
                wrong=0.0,
                baseline=(bits, depth) == (64, 3),
                frontier=False,
            )
        )
    return found


def _work(backend: Backend, scene: Scene) -> Work:
    timed = scene.resized(*TIMED)
    return Work(lambda: lanes.render(timed, backend), 1)
