"""How errors grow from generation to generation: pictures at depth 0, 1, ... against exact ones, without a float."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from oracles.measurement import Depth, Precision
from reference_tracer import certified
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.methods import SPHERE
from scenes.catalogue import rung

SCENE = "lecture-final"
SIZE = (64, 48)
DEEPEST = 6
METHODS = ("lecture", "perpendicular", "compensated")
CODE = 1.0 / 255.0
BITS: dict[Precision, int] = {"float32": 32, "float64": 64}


def depths(progress: Callable[[str], None] = lambda what: None) -> Iterator[Depth]:
    """Quantiles of |error| of the decided pixels, depth by depth; visible: share of them over one display code."""
    for depth in range(DEEPEST + 1):
        scene = rung(SCENE).scene().resized(*SIZE).with_depth(depth)
        true = certified.render_exact(scene)
        progress(f"depth {depth}")
        for precision, bits in BITS.items():
            for method in METHODS:
                got = lanes.render(scene, NumPyBackend(bits), SPHERE[method]).pixels.astype(np.float64)
                error = np.abs(got - true.value).max(axis=2)[true.decided]
                yield Depth(
                    method=method,
                    precision=precision,
                    depth=depth,
                    median=float(np.median(error)),
                    most=float(np.quantile(error, 0.99)),
                    largest=float(error.max()),
                    visible=float(np.mean(error > CODE)),
                )
