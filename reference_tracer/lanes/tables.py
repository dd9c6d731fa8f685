"""A scene as arrays: one row an object (spheres first), one row a light."""

from __future__ import annotations

from reference_tracer.lanes.backend import Array, Backend
from scenes.model import Light, Material, Object, PointLight, Scene, Sphere

_COLOURS = ("ambient", "diffuse", "specular", "reflect", "transmit")


Packet = tuple[float, float, float, float]


class Tables:
    """Packets of four reals by name; `spheres` and `planes` count the rows of each, `lights` the lamps.

    Four at a time, because a lane's four neighbours in memory cost little more than one.
    """

    def __init__(self, scene: Scene, backend: Backend) -> None:
        things = [scene.objects[k] for k in scene.tie_order]
        self.spheres = sum(isinstance(thing, Sphere) for thing in things)
        self.planes = len(things) - self.spheres
        self.lights = len(scene.lights)
        materials = [scene.materials[thing.material] for thing in things]
        packets = _objects(things, materials) | _lights(scene.lights) | _view(scene)
        self.packets: dict[str, Array] = {name: backend.packets(column) for name, column in packets.items()}
        self.integers: dict[str, Array] = {
            name: backend.integers(column)
            for name, column in {
                "shininess": [m.shininess for m in materials],
                "transmits": [int(any(m.transmit)) for m in materials],
                "is_point": [int(isinstance(light, PointLight)) for light in scene.lights],
                "attenuation": [_attenuation(light) for light in scene.lights],
            }.items()
        }


def _objects(things: list[Object], materials: list[Material]) -> dict[str, list[Packet]]:
    columns: dict[str, list[Packet]] = {
        "geometry": [(*t.center, t.radius) if isinstance(t, Sphere) else (*t.normal, t.offset) for t in things]
    }
    for name in _COLOURS:
        columns[name] = [(*getattr(m, name), m.index) for m in materials]
    return columns


def _lights(lights: tuple[Light, ...]) -> dict[str, list[Packet]]:
    return {
        "light": [(*(lamp.position if isinstance(lamp, PointLight) else lamp.toward), 0.0) for lamp in lights],
        "color": [(*lamp.color, 0.0) for lamp in lights],
    }


def _attenuation(light: Light) -> int:
    kind = light.attenuation if isinstance(light, PointLight) else "none"
    return ("none", "inverse", "inverse_square").index(kind)


def _view(scene: Scene) -> dict[str, list[Packet]]:
    camera, image = scene.camera, scene.image
    vectors = {"eye": camera.eye, "forward": camera.forward, "right": camera.right, "up": camera.up}
    columns: dict[str, list[Packet]] = {name: [(*vector, 0.0)] for name, vector in vectors.items()}
    columns["background"] = [(*scene.background, 0.0)]
    columns["image"] = [(float(image.width), float(image.height), *image.sample)]
    return columns
