"""What a stochastic tracer's picture converges to: each pixel's mean over its area, estimated without bias."""

from __future__ import annotations

import numpy as np
from numpy.random import default_rng
from numpy.typing import NDArray

from reference_tracer.lanes import render as lanes
from scenes.model import Scene

GRID = 4
"""A unit is the mean over GRID x GRID samples of each pixel, a lattice moved at random: unbiased, and much quieter."""


def area_average(scene: Scene, units: int, seed: int, backend: str) -> NDArray[np.float64]:
    """Independent estimates (units, height, width, 3) of the picture averaged over each pixel's area."""
    rng, engine = default_rng(seed), lanes.backend(backend, 64)
    found = np.zeros((units, scene.image.height, scene.image.width, 3))
    for unit in found:
        moved = rng.random(2)
        for k in range(GRID * GRID):
            x, y = ((moved + np.divmod(k, GRID)) / GRID).tolist()
            image = scene.image.model_copy(update={"sample": (x, y)})
            unit += lanes.render(scene.model_copy(update={"image": image}), engine).pixels
    return found / GRID**2
