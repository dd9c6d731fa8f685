"""Edits that make a scene smaller: of its picture, its things, its terms, its numbers.

Each kind of edit lists, for a scene, what may be done to it, the boldest first. The edits are then applied one after
the other to whatever the scene has become, so they name things by places that earlier edits leave in place: lists
are shortened from their ends.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

from scenes.model import Camera, ImagePlane, PointLight, Scene, Vector

Pixel = tuple[int, int]
"""(i, j), i to the right, j down."""
Edit = Callable[[Scene, Pixel], Scene | None]
"""The scene, and a pixel at which it fails, to the edited scene; None where that edit does not apply."""

VIEWS = ((8, 6), (16, 12), (32, 24), (64, 48))
WINDOWS = ((1, 1), (2, 1), (1, 2), (2, 2), (4, 3), *VIEWS)
"""Pictures tried, as (width, height); of the same view, and of a part of it."""
STEPS = (1.0, 0.5, 0.25, 0.125, 2.0**-6, 2.0**-10)
"""Grids that numbers are rounded to: binary ones, which float32 holds exactly."""
BLACK: Vector = (0.0, 0.0, 0.0)
TERMS = ("ambient", "diffuse", "specular", "reflect", "transmit")


def smaller_pictures(scene: Scene) -> Sequence[Edit]:
    """The same view in fewer pixels."""
    return [partial(_resized, width=width, height=height) for width, height in VIEWS]


def _resized(scene: Scene, _: Pixel, width: int, height: int) -> Scene:
    return scene.resized(width, height)


def crops(scene: Scene) -> Sequence[Edit]:
    """The same pixels, but only those about the wrong one."""
    return [partial(_crop, width=width, height=height) for width, height in WINDOWS]


def _crop(scene: Scene, pixel: Pixel, width: int, height: int) -> Scene | None:
    """Pixels [i0, i0 + width) x [j0, j0 + height) of the picture.

    X = -1 + 2(i0 + i + s)/W is (w/W)·X' + (2·i0 + w)/W - 1 in the X' of the smaller picture, and likewise Y = (h/H)·Y'
    - (2·j0 + h)/H + 1: the window is the same camera with shorter `right` and `up` and another `forward`.
    """
    whole, camera = scene.image, scene.camera
    if width > whole.width or height > whole.height:
        return None
    i0 = min(max(pixel[0] - width // 2, 0), whole.width - width)
    j0 = min(max(pixel[1] - height // 2, 0), whole.height - height)
    x = (2 * i0 + width) / whole.width - 1.0
    y = 1.0 - (2 * j0 + height) / whole.height
    aimed = Camera(
        eye=camera.eye,
        forward=_sum((1.0, camera.forward), (x, camera.right), (y, camera.up)),
        right=_sum((width / whole.width, camera.right)),
        up=_sum((height / whole.height, camera.up)),
    )
    image = ImagePlane(width=width, height=height, sample=whole.sample)
    return scene.model_copy(update={"image": image, "camera": aimed})


def _sum(*parts: tuple[float, Vector]) -> Vector:
    x, y, z = (sum(weight * vector[k] for weight, vector in parts) for k in range(3))
    return (x, y, z)


def shallower(scene: Scene) -> Sequence[Edit]:
    """Fewer generations."""
    return [partial(_with_depth, depth=depth) for depth in range(scene.depth)]


def _with_depth(scene: Scene, _: Pixel, depth: int) -> Scene:
    return scene.with_depth(depth)


def fewer_objects(scene: Scene) -> Sequence[Edit]:
    """Without all, halves, quarters, single ones; then all of the first one's material."""
    left_out = [partial(_without, part="objects", first=a, last=b) for a, b in _ranges(len(scene.objects))]
    return [*left_out, _of_one_material]


def fewer_lights(scene: Scene) -> Sequence[Edit]:
    """Without all, halves, quarters, single ones."""
    return [partial(_without, part="lights", first=a, last=b) for a, b in _ranges(len(scene.lights))]


def _ranges(count: int) -> Iterator[tuple[int, int]]:
    """[first, last) of parts of a list, whole, halves, quarters, ... one, each from the list's end."""
    part = count
    while part:
        yield from ((max(0, last - part), last) for last in range(count, 0, -part))
        part = part // 2


def _without(scene: Scene, _: Pixel, part: str, first: int, last: int) -> Scene:
    things = getattr(scene, part)
    return _tidy(scene.model_copy(update={part: (*things[:first], *things[last:])}))


def _of_one_material(scene: Scene, _: Pixel) -> Scene | None:
    if not scene.objects:
        return None
    name = scene.objects[0].material
    return _tidy(
        scene.model_copy(update={"objects": tuple(o.model_copy(update={"material": name}) for o in scene.objects)})
    )


def _tidy(scene: Scene) -> Scene:
    """Without materials that nothing is made of."""
    used = {thing.material for thing in scene.objects}
    return scene.model_copy(update={"materials": {name: m for name, m in scene.materials.items() if name in used}})


def ask_for_less(scene: Scene) -> Sequence[Edit]:
    """Without what a scene can ask for beside its things."""
    plain: list[dict[str, Any]] = [
        {"shadows": False, "fresnel": False, "background": BLACK, "display": "lecture"},
        {"shadows": False},
        {"fresnel": False},
        {"background": BLACK},
        {"display": "lecture"},
    ]
    return [
        *(partial(_updated, update=update) for update in plain),
        _at_the_corner,
        *(partial(_steady, place=k) for k in range(len(scene.lights))),
    ]


def _updated(scene: Scene, _: Pixel, update: dict[str, Any]) -> Scene:
    return scene.model_copy(update=update)


def _at_the_corner(scene: Scene, _: Pixel) -> Scene:
    return scene.model_copy(update={"image": scene.image.model_copy(update={"sample": (0.0, 0.0)})})


def _steady(scene: Scene, _: Pixel, place: int) -> Scene | None:
    """A point light that does not fade."""
    if place >= len(scene.lights) or not isinstance(scene.lights[place], PointLight):
        return None
    lights = list(scene.lights)
    lights[place] = lights[place].model_copy(update={"attenuation": "none"})
    return scene.model_copy(update={"lights": tuple(lights)})


def fewer_terms(scene: Scene) -> Sequence[Edit]:
    """Terms of the shading sum that are zero, and glass that does not bend."""
    plain: list[dict[str, Any]] = [{term: BLACK} for term in TERMS]
    return [
        partial(_changed, name=name, update=update)
        for name in scene.materials
        for update in [*plain, {"index": 1.0}, {"shininess": 1}]
    ]


def _changed(scene: Scene, _: Pixel, name: str, update: dict[str, Any]) -> Scene | None:
    if name not in scene.materials:
        return None
    return scene.model_copy(
        update={"materials": scene.materials | {name: scene.materials[name].model_copy(update=update)}}
    )


def plainer_cameras(_: Scene) -> Sequence[Edit]:
    """The lecture's camera; one whose `right` and `up` are axes."""
    return [_lectures_camera, _along_axes]


def _lectures_camera(scene: Scene, _: Pixel) -> Scene:
    aspect = scene.image.width / scene.image.height
    camera = Camera(eye=(0.0, 0.0, -2.0), forward=(0.0, 0.0, 1.0), right=(aspect, 0.0, 0.0), up=(0.0, 1.0, 0.0))
    return scene.model_copy(update={"camera": camera})


def _along_axes(scene: Scene, _: Pixel) -> Scene | None:
    """Of a single pixel only its ray counts: forward + X·right + Y·up is kept, its largest component made 1."""
    if (scene.image.width, scene.image.height) != (1, 1):
        return None
    camera = scene.camera
    x, y = 2.0 * scene.image.sample[0] - 1.0, 1.0 - 2.0 * scene.image.sample[1]
    ray = _sum((1.0, camera.forward), (x, camera.right), (y, camera.up))
    longest = max(map(abs, ray))
    right, up = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    if longest == 0.0:
        return None
    forward = _sum((1.0 / longest, ray), (-x, right), (-y, up))
    aimed = Camera.model_validate({"eye": camera.eye, "forward": forward, "right": right, "up": up})
    return scene.model_copy(update={"camera": aimed})


def rounder(scene: Scene) -> Sequence[Edit]:
    """Numbers on coarser grids: all at once, those of one thing, of one vector, single ones; vectors of zero."""
    paths = list(_paths(scene.model_dump(include=dict.fromkeys(_NUMBERS, True))))
    groups = dict.fromkeys(path[:length] for length in range(4) for path in paths if len(path) > length)
    singles = dict.fromkeys((*groups, *paths))
    return [partial(_rounded, path=path, step=step) for path in singles for step in (0.0, *STEPS)]


_NUMBERS = ("camera", "background", "materials", "objects", "lights")
_Path = tuple[str | int, ...]


def _paths(data: Any, path: _Path = ()) -> Iterator[_Path]:
    """Where the numbers are."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from _paths(value, (*path, key))
    elif isinstance(data, tuple | list):
        for k, value in enumerate(data):
            yield from _paths(value, (*path, k))
    elif isinstance(data, float):
        yield path


def _rounded(scene: Scene, _: Pixel, path: _Path, step: float) -> Scene | None:
    """The numbers at a place and below it, rounded to multiples of step; 0: nothing is left of them."""
    data = scene.model_dump()
    if path:
        try:
            data = _replaced(data, path, step)
        except (KeyError, IndexError):  # earlier edits took it away
            return None
    else:
        data |= {key: _on_grid(data[key], step) for key in _NUMBERS}
    return Scene.model_validate(data)


def _replaced(data: Any, path: _Path, step: float) -> Any:
    if not path:
        return _on_grid(data, step)
    key, *rest = path
    inner = _replaced(data[key], tuple(rest), step)
    if isinstance(data, dict):
        return data | {key: inner}
    return tuple(inner if k == key else value for k, value in enumerate(data))


def _on_grid(data: Any, step: float) -> Any:
    if isinstance(data, dict):
        return {key: _on_grid(value, step) for key, value in data.items()}
    if isinstance(data, tuple | list):
        return tuple(_on_grid(value, step) for value in data)
    if isinstance(data, float):
        return round(data / step) * step if step else 0.0
    return data
