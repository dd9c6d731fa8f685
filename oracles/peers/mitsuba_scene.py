"""A scene as Mitsuba's shapes, with the lecture's materials in tables beside them.

Runs inside the peer's process, after a variant was chosen. A plane is a disk: see `frames`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import drjit
import numpy as np

from oracles.peers.frames import plane_frame
from scenes.model import Object, Scene, Sphere


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
    return {"type": "disk", "to_world": mi.ScalarTransform4f(plane_frame(thing))}


def _order(mi: Any, loaded: Any) -> Any:
    """Our object's place from Mitsuba's pointer: by id in scalar variants, by registry number in the others."""
    if mi.variant().startswith("scalar"):
        return lambda shape, active: int(shape.id().removeprefix("object-"))
    dr: Any = drjit
    numbers = [int(dr.reinterpret_array(mi.UInt32, mi.ShapePtr(shape))[0]) for shape in loaded.shapes()]
    table = np.zeros(max(numbers, default=0) + 1, dtype=np.uint32)
    for number, shape in zip(numbers, loaded.shapes(), strict=True):
        table[number] = int(shape.id().removeprefix("object-"))
    places = mi.UInt32(table)
    return lambda shape, active: dr.gather(mi.UInt32, places, dr.reinterpret_array(mi.UInt32, shape), active)


class Tables:
    """Materials by object: a colour or number of each, looked up for one ray or for many."""

    def __init__(self, mi: Any, scene: Scene) -> None:
        self.dr: Any = drjit
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
