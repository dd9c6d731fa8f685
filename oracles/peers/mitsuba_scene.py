"""A scene as Mitsuba's shapes, with the lecture's materials in tables beside them.

Runs inside the peer's process, after a variant was chosen. Mitsuba has no infinite plane. A `rectangle` gets its
hit from barycentric coordinates of its corners, so its error grows with its size (1e-5 at 100). A `disk` is met in
its own frame, t = -z_o/z_d, and its size enters nothing but the test x² + y² <= 1: a disk whose frame is not
scaled along the normal is the plane's own formula at any radius. With RADIUS 1e7 what it misses lies within
1e-7 of the horizon's angle for each unit that the eye is above it.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from scenes.model import Object, Plane, Scene, Sphere

RADIUS = 1e7
"""Radius of the disk that stands for a plane, in the scene's unit."""


@dataclass(frozen=True)
class Loaded:
    """The scene in Mitsuba: its ray queries, and which of our objects a shape is."""

    scene: Any
    order: Any
    """Function of (shape, active): place of our object."""


def load(mi: Any, scene: Scene) -> Loaded:
    """Give Mitsuba the shapes; no emitter, no sensor, no BSDF of its own takes part."""
    shapes = {f"object-{k}": _shape(mi, thing) for k, thing in enumerate(scene.objects)}
    # optimize=False: merged meshes have an invalid bounding box in Mitsuba 3.9
    loaded = mi.load_dict({"type": "scene", **shapes}, optimize=False)
    return Loaded(loaded, _order(mi, loaded))


def _shape(mi: Any, thing: Object) -> dict[str, Any]:
    if isinstance(thing, Sphere):
        return {"type": "sphere", "center": list(thing.center), "radius": thing.radius}
    return {"type": "disk", "to_world": mi.ScalarTransform4f(frame(thing))}


def frame(plane: Plane) -> NDArray[np.float64]:
    """Matrix (4, 4) that takes the unit disk to the plane, its normal to the plane's, unscaled along it."""
    normal = np.asarray(plane.normal)
    squared = float(normal @ normal)
    n = normal / np.sqrt(squared)
    # The axis farthest from n gives two tangents without cancellation; axis-aligned planes stay exact
    axis = np.eye(3)[int(np.argmin(np.abs(n)))]
    s = np.cross(axis, n)
    s /= np.sqrt(float(s @ s))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = RADIUS * s, RADIUS * np.cross(n, s), n
    matrix[:3, 3] = normal * (plane.offset / squared)
    return matrix


def _order(mi: Any, loaded: Any) -> Any:
    """Our object's place from Mitsuba's pointer: by id in scalar variants, by registry number in the others."""
    if mi.variant().startswith("scalar"):
        return lambda shape, active: int(shape.id().removeprefix("object-"))
    dr: Any = importlib.import_module("drjit")
    numbers = [int(dr.reinterpret_array(mi.UInt32, mi.ShapePtr(shape))[0]) for shape in loaded.shapes()]
    table = np.zeros(max(numbers, default=0) + 1, dtype=np.uint32)
    for number, shape in zip(numbers, loaded.shapes(), strict=True):
        table[number] = int(shape.id().removeprefix("object-"))
    places = mi.UInt32(table)
    return lambda shape, active: dr.gather(mi.UInt32, places, dr.reinterpret_array(mi.UInt32, shape), active)


class Tables:
    """Materials by object: a colour or number of each, looked up for one ray or for many."""

    def __init__(self, mi: Any, scene: Scene) -> None:
        self.dr: Any = importlib.import_module("drjit")
        self.mi, self.scalar = mi, mi.variant().startswith("scalar")
        self.materials = [scene.materials[thing.material] for thing in scene.objects]
        names = ("ambient", "diffuse", "specular", "reflect", "transmit")
        self.colours = {name: self._colours(name) for name in names}
        self.index = self._numbers([material.index for material in self.materials])
        self.shininess = self._numbers([float(material.shininess) for material in self.materials])
        self.exponents = sorted({material.shininess for material in self.materials if any(material.specular)})

    def any(self, name: str) -> bool:
        """Whether any material has that colour."""
        return any(any(getattr(material, name)) for material in self.materials)

    def _colours(self, name: str) -> Any:
        rows = [getattr(material, name) for material in self.materials]
        if self.scalar:
            return [self.mi.Color3f(*row) for row in rows]
        return self.mi.Float(np.asarray(rows, dtype=np.float32).ravel())

    def _numbers(self, values: list[float]) -> Any:
        return values if self.scalar else self.mi.Float(np.asarray(values, dtype=np.float32))

    def colour(self, name: str, order: Any, active: Any) -> Any:
        """The colour of that name, of the object at `order`."""
        if self.scalar:
            return self.colours[name][order]
        return self.dr.gather(self.mi.Color3f, self.colours[name], order, active)

    def number(self, values: Any, order: Any, active: Any) -> Any:
        """An entry of `index` or `shininess`."""
        if self.scalar:
            return values[order]
        return self.dr.gather(self.mi.Float, values, order, active)
