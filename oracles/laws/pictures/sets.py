"""Small scenes for the laws of pictures, with no more in them than the tracer offers, and their relatives.

Coordinates are multiples of 1/64 below 8, so that the moves of the laws are exact in float32.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from oracles.laws.dice import Dice
from scenes.json_form import from_data
from scenes.model import Light, Material, Object, PointLight, Scene, Sphere

Vector = tuple[float, float, float]
Move = Callable[[Vector], Vector]

WIDTH, HEIGHT = 32, 24
MATTE = {"ambient": [0.05, 0.1, 0.02], "diffuse": [0.6, 0.2, 0.4], "specular": [0.3, 0.4, 0.2], "shininess": 12}
PALE = {"ambient": [0.1, 0.02, 0.06], "diffuse": [0.2, 0.5, 0.3], "specular": [0.2, 0.1, 0.3], "shininess": 5}
NOTHING = {"reflect": [0.0] * 3, "transmit": [0.0] * 3, "index": 1.0}
MIRROR = {"reflect": [0.5, 0.25, 0.375], "transmit": [0.0] * 3, "index": 1.0}
GLASS = {"reflect": [0.125] * 3, "transmit": [0.5, 0.625, 0.75], "index": 1.5}


def grid(dice: Dice, reach: float = 0.25) -> list[float]:
    """A small displacement on the grid, none at coordinates 0."""
    return [float(np.round(x * 64.0) / 64.0) for x in dice.point(reach)[0]]


def ball(center: Vector, shift: list[float], radius: float, material: str) -> dict[str, Any]:
    """A sphere somewhere near its place."""
    moved = [a + b for a, b in zip(center, shift, strict=True)]
    return {"shape": "sphere", "center": moved, "radius": radius, "material": material}


def stage(dice: Dice, features: frozenset[str]) -> Scene:
    """Three balls, on a floor if the tracer knows planes, under two lamps.

    A mirror and glass as far as it offers them.
    """
    mirror = MIRROR if "reflect" in features else NOTHING
    glass = GLASS if {"reflect", "refract"} <= features else NOTHING
    things: list[dict[str, Any]] = [
        ball((-1.0, 0.0, 1.0), grid(dice), 0.875, "matte"),
        ball((1.25, 0.125, 2.0), grid(dice), 0.75, "mirror"),
        ball((0.25, -0.375, -0.75), grid(dice), 0.5, "glass"),
    ]
    if "plane" in features:
        things.append({"shape": "plane", "normal": [0.0, 1.0, 0.125], "offset": -1.25, "material": "floor"})
    lamp = [a + b for a, b in zip((2.0, 3.0, -3.0), grid(dice), strict=True)]
    data = {
        "raycheck": 1,
        "name": "law",
        "source": "L11: Example of Ray Tracing",
        "image": {"width": WIDTH, "height": HEIGHT, "sample": [0.5, 0.5]},
        "camera": {
            "eye": [0.25, 0.5, -4.0],
            "forward": [0.0625, -0.125, 1.5],
            "right": [1.0, 0, 0.125],
            "up": [0, 0.75, 0],
        },
        "background": [0.25, 0.125, 0.375],
        "depth": 2 if mirror is MIRROR or glass is GLASS else 0,
        "shadows": "shadow" in features,
        "display": "lecture",
        "materials": {
            "matte": MATTE | NOTHING,
            "floor": PALE | NOTHING,
            "mirror": PALE | mirror,
            "glass": MATTE | glass,
        },
        "objects": things,
        "lights": [
            {"kind": "point", "position": lamp, "color": [0.5, 0.75, 0.25], "attenuation": "none"},
            {"kind": "directional", "toward": [-1.0, 2.0, -1.5], "color": [0.25, 0.125, 0.5]},
        ],
    }
    return from_data(data, "law")


def lit(dice: Dice) -> Scene:
    """The stage for a tracer that offers balls and lamps only: nothing but local light."""
    return stage(dice, frozenset())


def changed(scene: Scene, **parts: Any) -> Scene:
    """The same scene with other parts."""
    return scene.model_copy(update=parts)


def recoloured(scene: Scene, **parts: Callable[[Material], Any]) -> Scene:
    """The same scene with parts of every material changed."""
    return changed(
        scene,
        materials={
            name: material.model_copy(update={part: change(material) for part, change in parts.items()})
            for name, material in scene.materials.items()
        },
    )


def dimmed(scene: Scene, factors: tuple[float, ...]) -> Scene:
    """The same scene, the colour of each lamp times its factor."""
    lights = [
        lamp.model_copy(update={"color": tuple(factor * c for c in lamp.color)})
        for lamp, factor in zip(scene.lights, factors, strict=True)
    ]
    return changed(scene, lights=tuple(lights))


def moved(scene: Scene, place: Move, direction: Move, size: float = 1.0) -> Scene:
    """The whole world moved: `place` for positions, `direction` its linear part for directions, `size` its scale.

    `direction` must be orthogonal, so that it maps normals too.
    """
    camera = scene.camera.model_copy(
        update={"eye": place(scene.camera.eye)}
        | {name: direction(getattr(scene.camera, name)) for name in ("forward", "right", "up")}
    )
    objects = tuple(_moved_object(thing, place, direction, size) for thing in scene.objects)
    lights = tuple(_moved_light(lamp, place, direction) for lamp in scene.lights)
    return changed(scene, camera=camera, objects=objects, lights=lights)


def _moved_object(thing: Object, place: Move, direction: Move, size: float) -> Object:
    if isinstance(thing, Sphere):
        return thing.model_copy(update={"center": place(thing.center), "radius": thing.radius * size})
    normal = direction(thing.normal)
    shift = sum(n * d for n, d in zip(normal, place((0.0, 0.0, 0.0)), strict=True))
    return thing.model_copy(update={"normal": normal, "offset": thing.offset * size + shift})


def _moved_light(lamp: Light, place: Move, direction: Move) -> Light:
    if isinstance(lamp, PointLight):
        return lamp.model_copy(update={"position": place(lamp.position)})
    return lamp.model_copy(update={"toward": direction(lamp.toward)})
