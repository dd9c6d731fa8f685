"""A stock Mitsuba's path tracer as people use it: independent samples over each pixel's area."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.peers.mitsuba_xml import to_mitsuba
from scenes.model import Scene

KEPT: dict[str, Any] = {}
"""The scene loaded last: a statistical run asks for the same one many times."""


def render(mi: Any, scene: Scene, seed: int, samples: int) -> NDArray[np.float32]:
    """One render (height, width, 3) of that seed."""
    text = to_mitsuba(scene, by_chance=True)
    if text not in KEPT:
        KEPT.clear()
        KEPT[text] = mi.load_string(text, optimize=False)
    values: NDArray[np.float32] = np.array(mi.render(KEPT[text], spp=samples, seed=seed), dtype=np.float32)
    return values
