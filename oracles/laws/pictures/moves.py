"""Laws of what does not matter: order, names, and where the world stands."""

from __future__ import annotations

import numpy as np

from oracles.laws.dice import Dice
from oracles.laws.pictures.law import Studio, law
from oracles.laws.pictures.sets import HEIGHT, WIDTH, Vector, changed, lit, moved, stage
from oracles.laws.pictures.sight import Sight
from scenes.model import Scene

ORDER = "Ray Tracing Depth Sorting"
CAMERA = "Ray Vector Calculation"
VIEW = "Modifying Viewpoint in RT Example"
SECONDARY = {"shadow", "reflect", "refract"}
"""Features that need rays after the eye ray."""


def same(v: Vector) -> Vector:
    """The identity."""
    return v


@law("image/object-order", "the order of the objects does not matter", ORDER, "the object of the smallest λ > 0")
def object_order(dice: Dice, studio: Studio) -> Sight:
    """The nearest object is seen, whichever comes first in the file; no two surfaces of the scene coincide."""
    scene = stage(dice, studio.features)
    return studio.show(changed(scene, objects=scene.objects[::-1])) - studio.show(scene)


@law("image/light-order", "the order of the lamps does not matter", "Light Position", "RGB = Σ over the lights")
def light_order(dice: Dice, studio: Studio) -> Sight:
    """Light adds, and addition commutes but for rounding, which the tolerance holds."""
    scene = stage(dice, studio.features)
    return studio.show(changed(scene, lights=scene.lights[::-1])) - studio.show(scene)


@law("image/channels", "channels do not touch each other", "Basic Buffering", "RGB of permuted colours = permuted RGB")
def channels(dice: Dice, studio: Studio) -> Sight:
    """Geometry knows no colour: with all colours written G B R the picture is G B R."""
    scene = stage(dice, studio.features)
    colours = ("ambient", "diffuse", "specular", "reflect", "transmit")
    materials = {
        name: m.model_copy(update={part: turned(getattr(m, part)) for part in colours})
        for name, m in scene.materials.items()
    }
    lights = tuple(lamp.model_copy(update={"color": turned(lamp.color)}) for lamp in scene.lights)
    other = changed(scene, materials=materials, lights=lights, background=turned(scene.background))
    return studio.show(other) - studio.show(scene).seen(lambda part: np.roll(part, -1, axis=2))


def turned(colour: Vector) -> Vector:
    """(g, b, r) of (r, g, b)."""
    r, g, b = colour
    return g, b, r


@law(
    "image/mirrored-camera",
    "a camera with left and right exchanged draws the mirror picture",
    CAMERA,
    "right → -right: x → w-1-x",
)
def mirrored_camera(dice: Dice, studio: Studio) -> Sight:
    """X changes its sign; with samples at the pixels' centres pixel x becomes pixel w-1-x."""
    scene = stage(dice, studio.features)
    return studio.show(_camera(scene, right=_times(scene.camera.right, -1.0))) - studio.show(scene).seen(np.fliplr)


@law(
    "image/upside-down-camera",
    "a camera with up and down exchanged draws it upside down",
    CAMERA,
    "up → -up: y → h-1-y",
)
def upside_down_camera(dice: Dice, studio: Studio) -> Sight:
    """Y changes its sign.

    Rows count down, Y up: a tracer that has them confused draws both wrong alike, but not the rungs.
    """
    scene = stage(dice, studio.features)
    return studio.show(_camera(scene, up=_times(scene.camera.up, -1.0))) - studio.show(scene).seen(np.flipud)


@law("image/crop", "a part of the picture is the same part of the whole", CAMERA, "half the frame at half the size")
def crop(dice: Dice, studio: Studio) -> Sight:
    """The lower left quarter seen by a camera of its own, forward - right/2 - up/2 with half right and up.

    The same rays.
    """
    scene = stage(dice, studio.features)
    camera = scene.camera
    forward = tuple(f - r / 2.0 - u / 2.0 for f, r, u in zip(camera.forward, camera.right, camera.up, strict=True))
    part = _camera(scene, forward=forward, right=_times(camera.right, 0.5), up=_times(camera.up, 0.5))
    image = scene.image.model_copy(update={"width": WIDTH // 2, "height": HEIGHT // 2})
    whole = studio.show(scene).seen(lambda pixels: pixels[HEIGHT // 2 :, : WIDTH // 2])
    return studio.show(changed(part, image=image)) - whole


@law(
    "image/view-length",
    "the length of the camera's vectors together does not matter",
    CAMERA,
    "v = unit(w): unit(2w) = unit(w)",
)
def view_length(dice: Dice, studio: Studio) -> Sight:
    """Eye rays are unit vectors: twice forward, right and up are the same rays."""
    scene = stage(dice, studio.features)
    doubled = {name: _times(getattr(scene.camera, name), 2.0) for name in ("forward", "right", "up")}
    return studio.show(_camera(scene, **doubled)) - studio.show(scene)


def _camera(scene: Scene, **parts: object) -> Scene:
    return changed(scene, camera=scene.camera.model_copy(update=parts))


def _times(v: Vector, factor: float) -> Vector:
    x, y, z = v
    return factor * x, factor * y, factor * z


@law("image/translate", "a world moved together with its camera looks the same", VIEW, "all positions + d")
def translate(dice: Dice, studio: Studio) -> Sight:
    """Only differences of positions enter. d is made of whole numbers: the moved numbers are exact.

    Local light only: how far a secondary ray must step off its surface grows with the distance from the origin, and
    a tracer's least distance is made for worlds of the catalogue's size.
    """
    scene = stage(dice, studio.features - SECONDARY)
    dx, dy, dz = (float(np.round(x)) for x in 2.0 + dice.point(6.0)[0])
    other = moved(scene, lambda p: (p[0] + dx, p[1] + dy, p[2] + dz), same)
    return studio.show(other) - studio.show(scene)


@law("image/rotate", "a world turned together with its camera looks the same", VIEW, "all vectors turned")
def rotate(dice: Dice, studio: Studio) -> Sight:
    """Inner products do not depend on the axes. A third of a turn about (1, 1, 1), (x, y, z) → (y, z, x), is exact."""
    scene = stage(dice, studio.features)
    return studio.show(moved(scene, turned, turned)) - studio.show(scene)


@law("image/mirror-world", "a world mirrored together with its camera looks the same", VIEW, "all x → -x")
def mirror_world(dice: Dice, studio: Studio) -> Sight:
    """Light knows no handedness, so no formula may contain a cross product that is not squared."""
    scene = stage(dice, studio.features)

    def mirror(v: Vector) -> Vector:
        return -v[0], v[1], v[2]

    return studio.show(moved(scene, mirror, mirror)) - studio.show(scene)


@law("image/scale", "a world of twice the size looks the same", VIEW, "all lengths · 2")
def scale(dice: Dice, studio: Studio) -> Sight:
    """Directions do not change, and the lamps do not fade with distance; twice is exact.

    Local light only, for the reason given for the moved world.
    """
    scene = stage(dice, studio.features - SECONDARY)
    return studio.show(moved(scene, lambda p: _times(p, 2.0), same, 2.0)) - studio.show(scene)


@law(
    "image/plane-normal",
    "the length of a plane's normal does not matter",
    "Object Modeling in uObj",
    "kn∘p = k·offset",
    "plane",
)
def plane_normal(dice: Dice, studio: Studio) -> Sight:
    """The same points satisfy both equations, and the normal is made unit for shading."""
    scene = stage(dice, studio.features)
    objects = tuple(
        thing
        if thing.shape == "sphere"
        else thing.model_copy(update={"normal": _times(thing.normal, 4.0), "offset": 4.0 * thing.offset})
        for thing in scene.objects
    )
    return studio.show(changed(scene, objects=objects)) - studio.show(scene)


@law("image/hidden-object", "what is inside an opaque ball is not seen", ORDER, "the object of the smallest λ > 0")
def hidden_object(dice: Dice, studio: Studio) -> Sight:
    """A ray meets the outer surface first. Without shadows, so that only the nearest hit decides."""
    scene = lit(dice)
    outer = scene.objects[0]
    inner = outer.model_copy(update={"radius": 0.5, "material": "floor"})
    return studio.show(changed(scene, objects=(*scene.objects, inner))) - studio.show(scene)


@law("image/behind-the-eye", "what is behind the eye is not seen", "Modified FindRGB", "λ > 0")
def behind_the_eye(dice: Dice, studio: Studio) -> Sight:
    """A hit at negative λ is no hit. The ball stands wholly behind the eye; without shadows it changes nothing."""
    scene = lit(dice)
    back = scene.objects[0].model_copy(update={"center": (0.25, 0.5, -8.0), "radius": 2.0})
    return studio.show(changed(scene, objects=(back, *scene.objects))) - studio.show(scene)
