"""A stock Mitsuba: its own sensor, emitters, BSDFs and path tracer, and nothing of ours in the picture."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.peers.mitsuba_xml import is_stochastic, one_light_each, to_mitsuba
from scenes.model import Scene


def render(mi: Any, scene: Scene, seed: int, samples: int) -> NDArray[np.float32]:
    """The file's picture (height, width, 3), lights added one by one; `samples` counts where chance plays a part."""
    parts = one_light_each(scene)
    spp = samples if is_stochastic(scene) else 1
    loaded = [mi.load_string(to_mitsuba(part), optimize=False) for part in parts]
    pictures = np.array([np.array(mi.render(part, spp=spp, seed=seed)) for part in loaded], dtype=np.float32)
    added: NDArray[np.float32] = pictures.sum(axis=0, dtype=np.float32)
    return added
