"""Random scenes from a seed: what a canned picture cannot know.

The scenes stay where a tracer of fixed epsilon is right: things do not touch each other or the eye, so
that no ray meets a second surface within an epsilon of its start, except inside a sphere near its rim.
Equal seeds give equal scenes: Python's Mersenne Twister and `random()` are stable across versions
(docs of `random`, "Notes on Reproducibility"), so all draws are made from that alone.

`scenes.random_scenes` draws what this one must not: see there why they are two.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

from scenes.catalogue import Rung
from scenes.model import (
    Camera,
    Colour,
    DirectionalLight,
    ImagePlane,
    Light,
    Material,
    Object,
    Plane,
    PointLight,
    Scene,
    Sphere,
    Vector,
)

SLIDE = "Example of Ray Tracing"
GAP = 0.25
"""Least distance between things: some hundred times the epsilon that a float32 tracer needs here."""
FLOOR = -1.5
EYE = -4.0
"""Place of the eye on the z axis, before it is moved: an extent of 3.5 or more, which sets the lawful epsilon."""
KINDS = ("matte", "glossy", "mirror", "glass")

T = TypeVar("T")


class _Draws:
    """Draws from one seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(f"raycheck scene {seed}").random  # noqa: S311, no secret

    def number(self, low: float, high: float) -> float:
        """Rounded to 1/64, so that float32 holds it exactly and the text is short."""
        return round((low + (high - low) * self._random()) * 64.0) / 64.0

    def chance(self, share: float) -> bool:
        return self._random() < share

    def choice(self, things: Sequence[T]) -> T:
        return things[int(self._random() * len(things))]

    def colour(self, low: float, high: float) -> Colour:
        return (self.number(low, high), self.number(low, high), self.number(low, high))


BLACK: Colour = (0.0, 0.0, 0.0)


def generate(seed: int, name: str = "", width: int = 96, height: int = 72) -> Scene:
    """The scene of a seed. Unless it is given a name it has its seed for one."""
    draw = _Draws(seed)
    kinds = [draw.choice(KINDS) for _ in range(1 + int(draw.number(0.0, 3.98)))]
    spheres = _spheres(draw, kinds)
    materials = {f"{kind}-{k}": _material(draw, kind) for k, kind in enumerate(kinds)}
    objects: list[Object] = [
        Sphere(shape="sphere", center=center, radius=radius, material=name)
        for (center, radius), name in zip(spheres, materials, strict=False)
    ]
    if draw.chance(0.6):
        materials["floor"] = _material(draw, draw.choice(("matte", "mirror")))
        objects.insert(0, Plane(shape="plane", normal=(0.0, 1.0, 0.0), offset=FLOOR, material="floor"))
    used = {thing.material for thing in objects}
    return Scene(
        raycheck=1,
        name=name or f"drawn-{seed}",
        source=f"L11: {SLIDE}",
        image=ImagePlane(width=width, height=height, sample=draw.choice(((0.0, 0.0), (0.5, 0.5)))),
        camera=_camera(draw, width / height),
        background=draw.colour(0.0, 0.3),
        depth=1 + int(draw.number(0.0, 2.98)),
        shadows=draw.chance(0.7),
        display="lecture",
        materials={name: material for name, material in materials.items() if name in used},
        objects=tuple(objects),
        lights=tuple(_lights(draw)),
    )


def _spheres(draw: _Draws, kinds: Sequence[str]) -> list[tuple[Vector, float]]:
    """One sphere a kind where there is room; those that find none in a hundred draws stay away."""
    found: list[tuple[Vector, float]] = []
    for _ in kinds:
        for _ in range(100):
            radius = draw.number(0.25, 0.9)
            center = (draw.number(-1.8, 1.8), draw.number(FLOOR + radius + GAP, 1.2), draw.number(0.0, 3.0))
            if all(math.dist(center, other) >= radius + size + GAP for other, size in found):
                found.append((center, radius))
                break
    return found


def _material(draw: _Draws, kind: str) -> Material:
    glass, mirror = kind == "glass", kind == "mirror"
    shade = 0.3 if glass or mirror else 0.8
    return Material(
        ambient=draw.colour(0.0, 0.15),
        diffuse=draw.colour(0.05, shade),
        specular=BLACK if kind == "matte" else draw.colour(0.1, 0.6),
        shininess=draw.choice((1, 3, 8, 20, 50, 90)),
        reflect=draw.colour(0.2, 0.6) if mirror else draw.colour(0.0, 0.2) if glass else BLACK,
        transmit=draw.colour(0.4, 0.8) if glass else BLACK,
        index=draw.number(1.1, 1.8) if glass else 1.0,
    )


def _lights(draw: _Draws) -> Iterator[Light]:
    """One to three lamps above the things; those of point lights farther than any sphere reaches."""
    for _ in range(1 + int(draw.number(0.0, 2.98))):
        color = draw.colour(0.3, 0.9)
        if draw.chance(0.3):
            toward = (draw.number(-1.0, 1.0), draw.number(0.5, 1.0), draw.number(-1.0, 0.5))
            yield DirectionalLight(kind="directional", toward=toward, color=color)
        else:
            position = (draw.number(-3.0, 3.0), draw.number(2.5, 4.0), draw.number(-3.0, 2.0))
            attenuation = draw.choice(("none", "inverse", "inverse_square"))
            strong = {"none": 1.0, "inverse": 4.0, "inverse_square": 16.0}[attenuation]
            bright = (color[0] * strong, color[1] * strong, color[2] * strong)
            yield PointLight.model_validate(
                {"kind": "point", "position": position, "color": bright, "attenuation": attenuation}
            )


def _camera(draw: _Draws, aspect: float) -> Camera:
    eye = (draw.number(-0.5, 0.5), draw.number(-0.5, 0.5), EYE + draw.number(0.0, 0.5))
    forward = (draw.number(-0.1, 0.1), draw.number(-0.1, 0.1), 1.0)
    half = 0.5
    return Camera(eye=eye, forward=forward, right=(half * aspect, 0.0, 0.0), up=(0.0, half, 0.0))


@dataclass(frozen=True)
class Drawn(Rung):
    """A rung whose scene comes from a seed; it builds on the rungs that teach what it needs."""

    drawn: Scene = field(kw_only=True)

    def scene(self) -> Scene:
        """The scene that was drawn."""
        return self.drawn


def drawn(seed: int, name: str = "") -> Drawn:
    """The rung of a seed."""
    scene = generate(seed, name)
    return Drawn(scene.name, SLIDE, "a scene that nobody has seen before", _requires(scene), drawn=scene)


def _requires(scene: Scene) -> tuple[str, ...]:
    """Rungs that teach what this scene needs, in the ladder's order."""
    used = [scene.materials[thing.material] for thing in scene.objects]
    lamps = [light.attenuation if isinstance(light, PointLight) else light.kind for light in scene.lights]
    wanted = {
        "headlight-sphere": True,
        "depth-order": len(scene.objects) > 1,
        "ambient-diffuse": True,
        "point-light": lamps != ["directional"] * len(lamps),
        "directional-light": "directional" in lamps,
        "light-behind": True,
        "two-lights": len(lamps) > 1,
        "phong-10": any(any(material.specular) for material in used),
        "phong-terminator": any(any(material.specular) for material in used),
        "attenuation-inverse": "inverse" in lamps,
        "attenuation-inverse-square": "inverse_square" in lamps,
        "plane-both-sides": "plane" in scene.features,
        "shadow-hard": "shadow" in scene.features,
        "mirror-imperfect": "reflect" in scene.features,
        "facing-mirrors-2": "reflect" in scene.features,
        "glass-sphere": "refract" in scene.features,
        "off-centre-camera": True,
        "pixel-centre": scene.image.sample == (0.5, 0.5),
    }
    return tuple(name for name, needed in wanted.items() if needed)
