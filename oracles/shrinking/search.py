"""The smallest scene that still fails: delta debugging on everything a scene is made of.

After A. Zeller and R. Hildebrandt, "Simplifying and Isolating Failure-Inducing Input" (IEEE Transactions on Software
Engineering 28(2), 2002): what can be left out while the failure stays is left out, large parts first. A scene becomes
smaller in the order of `size`, whose parts are natural numbers, so every search ends; equal answers give equal scenes.

What fails must not come to fail for a reason that the tracer never had to face: no step takes the eye, a light or a
surface to the other side of a surface, or nearer to one than the gap at which any lawful epsilon is harmless (where
something stood nearer already, than that).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from pydantic import ValidationError

from oracles.shrinking.arrangement import gap, sides
from oracles.shrinking.edits import (
    Edit,
    Pixel,
    ask_for_less,
    crops,
    fewer_lights,
    fewer_objects,
    fewer_terms,
    plainer_cameras,
    rounder,
    shallower,
    smaller_pictures,
)
from scenes.generator import GAP
from scenes.model import PointLight, Scene, Sphere

Fails = Callable[[Scene], Pixel | None]
"""(i, j) of a pixel that is wrong, or None where the scene does not fail as the first one did."""


@dataclass(frozen=True)
class Limits:
    """What a search may cost: scenes tried, and seconds by the clock; the try under way is finished."""

    tries: int
    seconds: float
    clock: Callable[[], float] = time.monotonic


@dataclass(frozen=True)
class Step:
    """A scene that fails at this pixel, found with so many tries; least: no edit makes it any smaller."""

    scene: Scene
    pixel: Pixel
    tries: int
    least: bool = False


PASSES: tuple[Callable[[Scene], Sequence[Edit]], ...] = (
    smaller_pictures,
    shallower,
    crops,
    fewer_objects,
    fewer_lights,
    ask_for_less,
    fewer_terms,
    plainer_cameras,
    rounder,
)
"""Kinds of edits, those first that make all later tries cheaper."""


def shrink(scene: Scene, fails: Fails, limits: Limits) -> Iterator[Step]:
    """Ever smaller scenes that fail, the given one first; nothing if that does not fail.

    The last step is `least` if the search came to its end within the limits.
    """
    end = limits.clock() + limits.seconds
    tries = 1
    pixel = fails(scene)
    if pixel is None:
        return
    step = Step(scene, pixel, tries)
    yield step
    floor = min(gap(scene), GAP)
    seen = {scene.content_hash()}
    while True:
        before = step.scene
        for kind in PASSES:
            for edit in kind(step.scene):
                candidate = _edited(step, edit, floor)
                if candidate is None or candidate.content_hash() in seen:
                    continue
                if tries >= limits.tries or limits.clock() >= end:
                    return
                seen.add(candidate.content_hash())
                tries += 1
                pixel = fails(candidate)
                if pixel is not None:
                    step = Step(candidate, pixel, tries)
                    yield step
        if step.scene is before:
            yield Step(step.scene, step.pixel, tries, least=True)
            return


def _edited(step: Step, edit: Edit, floor: float) -> Scene | None:
    """The scene after an edit; None unless it is a scene, smaller, no more crowded, and arranged as before."""
    try:
        found = edit(step.scene, step.pixel)
    except ValidationError:  # a radius of 0, a direction of none
        return None
    if found is None or size(found) >= size(step.scene) or gap(found) < floor:
        return None
    return found if _things(found) < _things(step.scene) or sides(found) == sides(step.scene) else None


def _things(scene: Scene) -> int:
    return len(scene.objects) + len(scene.lights)


def size(scene: Scene) -> tuple[int, int, int, int, int]:
    """How much there is to think of: things, generations, terms, pixels, digits, in this order."""
    return (
        _things(scene),
        scene.depth,
        _terms(scene),
        scene.image.width * scene.image.height,
        _digits(scene.model_dump(include={"image": {"sample"}, **dict.fromkeys(_NUMBERS, True)})),
    )


_NUMBERS = ("camera", "background", "materials", "objects", "lights")


def _terms(scene: Scene) -> int:
    """Materials, their terms that are not zero, and everything else that a tracer is asked to heed."""
    terms = sum(
        1 + sum(map(any, (m.ambient, m.diffuse, m.specular, m.reflect, m.transmit))) + (m.index != 1.0)
        for m in scene.materials.values()
    )
    fading = sum(isinstance(light, PointLight) and light.attenuation != "none" for light in scene.lights)
    asked = (scene.shadows, scene.fresnel, scene.display != "lecture", any(scene.background), any(scene.image.sample))
    return terms + fading + sum(asked)


def _digits(data: object) -> int:
    """Letters of all numbers as the text form writes them; a zero counts none."""
    if isinstance(data, dict):
        return sum(map(_digits, data.values()))
    if isinstance(data, tuple | list):
        return sum(map(_digits, data))
    return len(f"{data:.17g}") if isinstance(data, int | float) and data else 0


def words(scene: Scene) -> str:
    """What there is, as one says it: "1 sphere, 1 light, depth 0, 1x1 pixels"."""
    spheres = sum(isinstance(thing, Sphere) for thing in scene.objects)
    counts = (("sphere", spheres), ("plane", len(scene.objects) - spheres), ("light", len(scene.lights)))
    said = [f"{n} {word}{'s' if n > 1 else ''}" for word, n in counts if n]
    image = scene.image
    pixels = "1 pixel" if image.width * image.height == 1 else f"{image.width}x{image.height} pixels"
    return ", ".join([*(said or ["nothing"]), f"depth {scene.depth}", pixels])
