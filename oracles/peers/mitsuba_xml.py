"""The scenes that a stock renderer shares with us, as a file that a Mitsuba user can open.

A physically based renderer has no lecture's ambient or Phong term. What both can say: diffuse surfaces under
directional and inverse-square point lights, with shadows; perfect mirrors and Fresnel glass among things that shine by
themselves (our `ambient`, Mitsuba's area emitters). Our colours are radiances: a light of colour c gives
c·diffuse·cosθ where Mitsuba's diffuse surface divides by π, so lights are written π times as strong.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from oracles.peers.cannot import CannotSayError
from oracles.peers.frames import plane_frame
from scenes.model import DirectionalLight, Light, Material, Object, Plane, Scene, Sphere

SQUARE = 2.0**-40
"""What rounding the camera's axes may make of a right angle or of equal sides, far below float32's 2^-24."""
FAR = 1e9
"""Far clip: Mitsuba's own 1e4 takes the floor away below a horizon's last 1e-4 radians for each unit of height."""
NO_ROULETTE = 1000
"""`rr_depth`: Russian roulette would begin only after that many bounces."""
PERFECT = '<string name="material" value="none"/>'
SAMPLES = 256
"""Samples a pixel where a path chooses between two branches by chance."""


def to_mitsuba(scene: Scene, by_chance: bool | None = None) -> str:
    """The XML file for Mitsuba 3; raise CannotSayError naming what a stock Mitsuba lacks.

    by_chance: independent samples over each pixel's area, else its middle once; as the scene needs it unless said.
    """
    return "\n".join(_lines(scene, is_stochastic(scene) if by_chance is None else by_chance)) + "\n"


def is_stochastic(scene: Scene) -> bool:
    """Whether a path tracer's picture of the scene depends on chance: glass, where each path follows one branch."""
    return any(kind(scene, thing.material) == "glass" for thing in scene.objects)


def one_light_each(scene: Scene) -> list[Scene]:
    """The scene by lights: with one sample a path tracer sees one light only, and light adds."""
    if len(scene.lights) < 2:
        return [scene]
    return [scene.model_copy(update={"lights": (light,)}) for light in scene.lights]


def kind(scene: Scene, name: str) -> str:
    """What a material is to Mitsuba: shining, diffuse, mirror or glass."""
    m: Material = scene.materials[name]
    has = {part for part in ("ambient", "diffuse", "specular", "reflect", "transmit") if any(getattr(m, part))}
    follows = scene.depth > 0
    if has <= {"ambient"}:
        return "shining"
    if has == {"diffuse"}:
        return "diffuse"
    if has == {"reflect"} and follows and not scene.fresnel:
        return "mirror"
    if has == {"reflect", "transmit"} and follows and scene.fresnel:
        return "glass"
    raise CannotSayError(f"material {name}: no stock material has {' and '.join(sorted(has))} as the lecture adds them")


def max_depth(scene: Scene) -> int:
    """Vertices of the longest path: our generations, and one for what shines or two for what is lit there."""
    kinds = {kind(scene, thing.material) for thing in scene.objects}
    if "diffuse" not in kinds:
        return scene.depth + 1
    if len(kinds) > 1:
        raise CannotSayError("diffuse surfaces beside others, which a path tracer lights them by")
    if any(scene.background):
        raise CannotSayError("a background that shines on diffuse surfaces")
    if scene.lights and not scene.shadows:
        raise CannotSayError("lights without shadows")
    return 2


def _lines(scene: Scene, by_chance: bool) -> Iterator[str]:
    depth = max_depth(scene)
    if any(_eye_inside(scene, thing) for thing in scene.objects if kind(scene, thing.material) == "glass"):
        raise CannotSayError("an eye inside glass, where radiance is index² times the air's and the lecture's is not")
    yield f"<!-- {scene.name}; mitsuba -m scalar_rgb {scene.name}.xml -->"
    yield '<scene version="3.0.0">'
    yield f'  <integrator type="path"><integer name="max_depth" value="{depth}"/>'
    yield f'    <integer name="rr_depth" value="{NO_ROULETTE}"/></integrator>'
    yield from _sensor(scene, by_chance)
    if any(scene.background):
        yield f'  <emitter type="constant">{_rgb("radiance", scene.background)}</emitter>'
    for light in scene.lights:
        yield _light(light)
    for k, thing in enumerate(scene.objects):
        yield _shape(scene, k, thing)
    yield "</scene>"


def _eye_inside(scene: Scene, thing: Object) -> bool:
    eye = scene.camera.eye
    if isinstance(thing, Sphere):
        return math.dist(eye, thing.center) < thing.radius
    return sum(a * b for a, b in zip(thing.normal, eye, strict=True)) < thing.offset


def _number(value: float) -> str:
    return repr(float(value))


def _rgb(name: str, colour: Iterable[float]) -> str:
    return f'<rgb name="{name}" value="{" ".join(_number(part) for part in colour)}"/>'


def _matrix(matrix: Iterable[Iterable[float]]) -> str:
    words = " ".join(_number(float(part)) for row in matrix for part in row)
    return f'<transform name="to_world"><matrix value="{words}"/></transform>'


def _sensor(scene: Scene, by_chance: bool) -> Iterator[str]:
    """A perspective sensor: x to the left, y up, z forward in its frame; ours may be left- or right-handed.

    A `forward` that leans against the image plane, and a sample beside the pixel's centre, move the principal point.
    """
    camera, image = scene.camera, scene.image
    right, up, forward = (np.asarray(axis) for axis in (camera.right, camera.up, camera.forward))
    width, height = math.hypot(*camera.right), math.hypot(*camera.up)
    if abs(float(right @ up)) > SQUARE * width * height:
        raise CannotSayError("a picture that is no rectangle")
    if abs(width * image.height / (height * image.width) - 1.0) > SQUARE:
        raise CannotSayError("pixels that are not square")
    lean_x, lean_y = float(forward @ right) / width**2, float(forward @ up) / height**2
    ahead = forward - lean_x * right - lean_y * up
    distance = math.hypot(*ahead)
    if not distance > 0.0:
        raise CannotSayError("a camera that looks along its picture")
    frame = np.eye(4)
    frame[:3, 0], frame[:3, 1], frame[:3, 2], frame[:3, 3] = -right / width, up / height, ahead / distance, camera.eye
    fov = math.degrees(2.0 * math.atan2(width, distance))
    x = (image.sample[0] - 0.5) / image.width + 0.5 * lean_x  # a positive offset moves the picture to the left, and up
    y = (image.sample[1] - 0.5) / image.height - 0.5 * lean_y
    yield '  <sensor type="perspective">'
    yield f"    {_matrix(frame)}"
    yield f'    <float name="far_clip" value="{_number(FAR)}"/>'
    yield f'    <string name="fov_axis" value="x"/><float name="fov" value="{_number(fov)}"/>'
    for name, offset in (("x", x), ("y", y)):
        if offset != 0.0:
            yield f'    <float name="principal_point_offset_{name}" value="{_number(offset)}"/>'
    yield from _film(scene, by_chance)
    yield "  </sensor>"


def _film(scene: Scene, by_chance: bool) -> Iterator[str]:
    if by_chance:
        yield f'    <sampler type="independent"><integer name="sample_count" value="{SAMPLES}"/></sampler>'
    else:
        yield '    <sampler type="stratified"><integer name="sample_count" value="1"/>'
        yield '      <boolean name="jitter" value="false"/></sampler>'
    width, height = scene.image.width, scene.image.height
    yield f'    <film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="{height}"/>'
    yield '      <string name="pixel_format" value="rgb"/><string name="component_format" value="float32"/>'
    yield '      <rfilter type="box"/></film>'


def _light(light: Light) -> str:
    strong = tuple(math.pi * part for part in light.color)
    if isinstance(light, DirectionalLight):
        away = " ".join(f'{axis}="{_number(-part)}"' for axis, part in zip("xyz", light.toward, strict=True))
        direction = f'<vector name="direction" {away}/>'
        return f'  <emitter type="directional">{direction}{_rgb("irradiance", strong)}</emitter>'
    if light.attenuation != "inverse_square":
        raise CannotSayError(f"a point light of attenuation {light.attenuation}")
    place = " ".join(f'{axis}="{_number(part)}"' for axis, part in zip("xyz", light.position, strict=True))
    return f'  <emitter type="point"><point name="position" {place}/>{_rgb("intensity", strong)}</emitter>'


def _shape(scene: Scene, k: int, thing: Object) -> str:
    what = kind(scene, thing.material)
    if isinstance(thing, Sphere):
        place = " ".join(f'{axis}="{_number(part)}"' for axis, part in zip("xyz", thing.center, strict=True))
        where = f'<point name="center" {place}/><float name="radius" value="{_number(thing.radius)}"/>'
    else:
        where = _matrix(plane_frame(thing if what == "glass" else _facing(thing, scene)))
    shape = "sphere" if isinstance(thing, Sphere) else "disk"
    return f'  <shape type="{shape}" id="object-{k}">{where}{_surface(what, scene.materials[thing.material])}</shape>'


def _facing(plane: Plane, scene: Scene) -> Plane:
    """The same plane, its normal on the eye's side: Mitsuba's diffuse, mirror and shining surfaces have one side."""
    if sum(n * e for n, e in zip(plane.normal, scene.camera.eye, strict=True)) >= plane.offset:
        return plane
    x, y, z = plane.normal
    return plane.model_copy(update={"normal": (-x, -y, -z), "offset": -plane.offset})


def _surface(what: str, m: Material) -> str:
    match what:
        case "shining":
            emitter = f'<emitter type="area">{_rgb("radiance", m.ambient)}</emitter>'
            return _bsdf("diffuse", _rgb("reflectance", (0.0,) * 3)) + emitter
        case "diffuse":
            return _bsdf("diffuse", _rgb("reflectance", m.diffuse))
        case "mirror":
            perfect = '<string name="material" value="none"/>'
            return _bsdf("conductor", perfect + _rgb("specular_reflectance", m.reflect))
    index = f'<float name="int_ior" value="{_number(m.index)}"/><float name="ext_ior" value="1"/>'
    shares = _rgb("specular_reflectance", m.reflect) + _rgb("specular_transmittance", m.transmit)
    return _bsdf("dielectric", index + shares)


def _bsdf(name: str, inside: str) -> str:
    return f'<bsdf type="{name}">{inside}</bsdf>'
