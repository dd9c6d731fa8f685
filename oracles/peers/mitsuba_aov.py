"""What a stock Mitsuba meets at each pixel: position, normal and shape, by its `aov` integrator."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.peers.aov import clay
from oracles.peers.mitsuba_xml import to_mitsuba
from scenes.model import Scene

AOVS = "p:position,n:sh_normal,s:shape_index"


def render(mi: Any, scene: Scene, seed: int, samples: int) -> NDArray[np.float32]:
    """Position, normal, shape: (height, width, 7); a pixel that meets nothing is all 0."""
    loaded = mi.load_string(to_mitsuba(clay(scene)), optimize=False)
    integrator = mi.load_dict({"type": "aov", "aovs": AOVS, "image": {"type": "path"}})
    values = np.array(mi.render(loaded, integrator=integrator, spp=1, seed=seed))
    return values[..., -7:]  # before them the picture
