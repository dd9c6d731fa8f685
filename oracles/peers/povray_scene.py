"""A scene in POV-Ray's language, saying the lecture's sum as nearly as POV-Ray 3.7 can.

POV-Ray adds pigment·(emission + diffuse·cosθ)·(1 - transmit), the highlight phong·(r∘v)^size uncoloured, reflection and
transmit: the lecture's sum, once pigment and emission are divided by what they are multiplied with. Its
highlight and its transmit have no colour of their own, so scenes where they need one are
translated a channel at a time (`channels`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from oracles.peers.cannot import CannotSayError
from scenes.model import Camera, Colour, Light, Material, Object, PointLight, Scene, Sphere

FAR = 1e5
"""Distance, in the scene's unit, of the plane that stands for a directional light: POV-Ray computes in float64."""
FADE = {"none": (0.0, 0), "inverse": (1e-8, 1), "inverse_square": (1e-5, 2)}
"""fade_distance D and fade_power p: POV-Ray's 2/(1 + (d/D)^p) is 2 D^p/d^p to a relative (D/d)^p, 1e-8 at d = 1."""
LEAST = 1e-10
"""Pigment of a channel that has no diffuse light: what its emission is divided by."""


def channels(scene: Scene) -> list[Scene]:
    """The scene, if its highlights and transmitted rays are grey; else its red, green and blue as three grey ones."""
    materials = [scene.materials[thing.material] for thing in scene.objects]
    if all(len(set(m.specular)) == 1 and len(set(m.transmit)) == 1 for m in materials):
        return [scene]
    return [_grey(scene, k) for k in range(3)]


def _grey(scene: Scene, k: int) -> Scene:
    """One channel of every colour, in all three."""

    def grey(colour: Colour) -> Colour:
        return (colour[k],) * 3

    names = ("ambient", "diffuse", "specular", "reflect", "transmit")
    materials = {
        name: material.model_copy(update={part: grey(getattr(material, part)) for part in names})
        for name, material in scene.materials.items()
    }
    lights = tuple(light.model_copy(update={"color": grey(light.color)}) for light in scene.lights)
    return scene.model_copy(update={"materials": materials, "lights": lights, "background": grey(scene.background)})


def to_povray(scene: Scene) -> str:
    """The scene file; raise CannotSayError naming material and reason."""
    return "\n".join(_lines(scene)) + "\n"


def _lines(scene: Scene) -> Iterator[str]:
    width, height = scene.image.width, scene.image.height
    yield f"// {scene.name}; povray +I{scene.name}.pov +FE +W{width} +H{height} -A"
    yield "#version 3.7;"
    yield f"global_settings {{ assumed_gamma 1 max_trace_level {scene.depth + 1} adc_bailout 0 ambient_light 1 }}"
    yield from _camera(scene)
    yield f"background {{ color rgb {_vector(scene.background)} }}"
    for light in scene.lights:
        yield from _light(light)
    for thing in scene.objects:
        yield from _object(scene, thing)


def _number(value: float) -> str:
    return repr(float(value))


def _vector(values: Iterable[float]) -> str:
    return "<" + ", ".join(_number(value) for value in values) + ">"


def _camera(scene: Scene) -> Iterator[str]:
    """POV-Ray samples a pixel's centre, and its right and up span the picture: another sample moves `direction`."""
    camera: Camera = scene.camera
    x = 2.0 * (scene.image.sample[0] - 0.5) / scene.image.width
    y = -2.0 * (scene.image.sample[1] - 0.5) / scene.image.height
    axes = zip(camera.forward, camera.right, camera.up, strict=True)
    direction = [f + x * right + y * up for f, right, up in axes]
    right, up = ([2.0 * part for part in axis] for axis in (camera.right, camera.up))
    yield f"camera {{ location {_vector(camera.eye)} direction {_vector(direction)}"
    yield f"  right {_vector(right)} up {_vector(up)} }}"


def _light(light: Light) -> Iterator[str]:
    if not isinstance(light, PointLight):
        length = max(abs(part) for part in light.toward)
        place = [part / length * FAR for part in light.toward]
        yield f"light_source {{ {_vector(place)} color rgb {_vector(light.color)} parallel point_at 0 }}"
        return
    distance, power = FADE[light.attenuation]
    if not power:
        yield f"light_source {{ {_vector(light.position)} color rgb {_vector(light.color)} }}"
        return
    colour = [part / (2.0 * distance**power) for part in light.color]
    fade = f"fade_distance {_number(distance)} fade_power {power}"
    yield f"light_source {{ {_vector(light.position)} color rgb {_vector(colour)} {fade} }}"


def _object(scene: Scene, thing: Object) -> Iterator[str]:
    """The thing; of a transparent one also an opaque twin that nothing but shadow rays sees."""
    shape = _shape(thing)
    material = scene.materials[thing.material]
    shadow = "" if scene.shadows else " no_shadow"
    if scene.shadows and any(material.transmit):
        yield f"{shape} no_image no_reflection }}"
        shadow = " no_shadow"
    texture = _texture(thing.material, material, scene.fresnel)
    yield f"{shape} {texture} interior {{ ior {_number(_ior(scene, thing))} }}{shadow} }}"


def _ior(scene: Scene, thing: Object) -> float:
    """POV-Ray's index is absolute, ours is relative to the outside: what lies in others is multiplied with theirs."""
    around = (other for other in scene.objects if other is not thing and _inside(thing, other))
    transparent = (scene.materials[other.material] for other in around)
    outside = math.prod(material.index for material in transparent if any(material.transmit))
    return scene.materials[thing.material].index * outside


def _inside(thing: Object, other: Object) -> bool:
    """Whether a sphere lies wholly in another sphere, or on the side of a plane that its normal points away from."""
    if not isinstance(thing, Sphere):
        return False
    if isinstance(other, Sphere):
        return math.dist(thing.center, other.center) + thing.radius < other.radius
    along = sum(n * c for n, c in zip(other.normal, thing.center, strict=True))
    return along + thing.radius * math.hypot(*other.normal) < other.offset


def _shape(thing: Object) -> str:
    if isinstance(thing, Sphere):
        return f"sphere {{ {_vector(thing.center)}, {_number(thing.radius)}"
    length = math.hypot(*thing.normal)
    return f"plane {{ {_vector(thing.normal)}, {_number(thing.offset / length)}"


def _texture(name: str, material: Material, fresnel: bool) -> str:
    transmit, specular = material.transmit[0], material.specular[0]
    if len(set(material.transmit)) > 1 or len(set(material.specular)) > 1:
        raise CannotSayError(f"material {name}: a highlight or a transmitted ray with a colour of its own")
    opacity = 1.0 - transmit
    if opacity <= 0.0 and (any(material.diffuse) or any(material.ambient)):
        raise CannotSayError(f"material {name}: wholly transparent, and yet with a colour of its own")
    divisor = opacity if opacity > 0.0 else 1.0
    pigment = [part / divisor or LEAST for part in material.diffuse]
    emission = [part / divisor / p for part, p in zip(material.ambient, pigment, strict=True)]
    finish = [f"ambient 0 diffuse 1 emission rgb {_vector(emission)}"]
    if specular:
        finish.append(f"phong {_number(specular)} phong_size {material.shininess}")
    if any(material.reflect):
        finish.append(f"reflection {{ rgb {_vector(material.reflect)}{' fresnel' if fresnel else ''} }}")
    if fresnel:
        finish.append("conserve_energy")
    return f"pigment {{ color rgb {_vector(pigment)} transmit {_number(transmit)} }} finish {{ {' '.join(finish)} }}"
