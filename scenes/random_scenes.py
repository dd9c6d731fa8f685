"""Scenes drawn by chance, for what no designed scene would think of.

There are two generators since they want opposite things. This one serves our own tests: things overlap, surfaces cross
the eye, mirrors face each other a hair apart, numbers have all their digits, and whatever comes of it must be enclosed.
`scenes.generator` serves grading, where a scene may not fail a right tracer of a fixed epsilon: things keep apart,
light is bright enough to tell, numbers are exact in float32. A restriction of one is the point of the other, so they
share no draw, and either one's scenes are pinned by their seeds.
"""

from __future__ import annotations

import math
import random

from scenes.json_form import from_data
from scenes.model import Scene


def random_scene(seed: int) -> Scene:
    """Up to six objects and three lights in view of the lecture's camera; the same for the same seed."""
    chance = random.Random(seed)  # noqa: S311 - scenes, not secrets

    def triple(low: float, high: float) -> list[float]:
        return [chance.uniform(low, high) for _ in range(3)]

    def sometimes(odds: float) -> list[float]:
        return triple(0.1, 0.9) if chance.random() < odds else [0.0, 0.0, 0.0]

    def direction() -> list[float]:
        vector = triple(-1.0, 1.0)
        return vector if math.hypot(*vector) > 0.1 else [0.0, 1.0, 0.0]

    materials = {
        f"m{k}": {
            "ambient": triple(0.0, 0.2),
            "diffuse": sometimes(0.8),
            "specular": sometimes(0.5),
            "shininess": chance.choice((1, 2, 10, 37, 100)),
            "reflect": sometimes(0.4),
            "transmit": sometimes(0.4),
            "index": chance.choice((1.0, 1.33, 1.5, 1 / 1.5, 2.4)),
        }
        for k in range(3)
    }
    spheres = [
        {
            "shape": "sphere",
            "center": [chance.uniform(-2, 2), chance.uniform(-1.5, 1.5), chance.uniform(-1, 5)],
            "radius": chance.uniform(0.2, 1.2),
            "material": f"m{chance.randrange(3)}",
        }
        for _ in range(chance.randrange(1, 5))
    ]
    planes = [
        {
            "shape": "plane",
            "normal": direction(),
            "offset": chance.uniform(-2, 2),
            "material": f"m{chance.randrange(3)}",
        }
        for _ in range(chance.randrange(0, 3))
    ]
    lights = [
        {
            "kind": "point",
            "position": [chance.uniform(-3, 3), chance.uniform(0, 4), chance.uniform(-3, 3)],
            "color": triple(0.2, 1.0),
            "attenuation": chance.choice(("none", "inverse", "inverse_square")),
        }
        if chance.random() < 0.6
        else {"kind": "directional", "toward": direction(), "color": triple(0.2, 1.0)}
        for _ in range(chance.randrange(1, 4))
    ]
    things = [*spheres, *planes]
    chance.shuffle(things)
    return from_data(
        {
            "raycheck": 1,
            "name": f"random-{seed}",
            "source": "",
            "image": {"width": 40, "height": 30, "sample": [chance.random(), chance.random()]},
            "camera": {
                "eye": [0.0, 0.0, -2.0],
                "forward": [0.0, 0.0, 1.5],
                "right": [4 / 3, 0.0, 0.0],
                "up": [0.0, 1.0, 0.0],
            },
            "background": triple(0.0, 0.5),
            "depth": chance.randrange(0, 5),
            "shadows": chance.random() < 0.6,
            "fresnel": chance.random() < 0.3,
            "display": "lecture",
            "materials": materials,
            "objects": things,
            "lights": lights,
        }
    )
