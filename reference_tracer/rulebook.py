"""The frozen record of formulas a tracer runs by.

A method of the accuracy-speed chart is a rulebook with another sphere or
refraction formula; a dialect is one with other lawful conventions; a fault is one
with an entry replaced by a wrong one. None ever puts a flag into a tracer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from reference_tracer.formulas import camera, display, optics, plane, shading, sphere
from reference_tracer.numbers import Condition, Number, at_least, less
from reference_tracer.vector import Vec


def nearer(distance: Number, best: Number, order: Any, best_order: Any) -> Condition:
    """Where a hit at `distance` wins over the best so far: the smaller λ, then the earlier object.

    L11 "Ray Tracing Depth Sorting": the nearest to the viewpoint. `order` is the object's place,
    spheres before planes; without a tie it does not matter.
    """
    return less(distance, best) | (at_least(best, distance) & (order < best_order))


def blocks(distance: Number, light_distance: Number, opaque: Condition) -> Condition:
    """Where a surface at `distance` stands strictly between the point and the light; transparent ones block too."""
    return less(distance, light_distance)


def mix(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    """Add the branches to the local colour: ret + ref·specular + tra·transparent.

    L11 "Refraction with geo.tr vector".
    """
    return (local + reflect * reflected) + transmit * transmitted


def weights(reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Callable[[], Number]) -> tuple[Vec, Vec]:
    """What the two branches count for: the material's weights, under total reflection too.

    asked: the scene asks for Fresnel's share F = share(); then the weights are multiplied by F and 1 - F.
    """
    if asked:
        F = share()
        reflect, transmit = reflect * F, transmit * (1.0 - F)
    return reflect, transmit


def last(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, refracted: Vec) -> Vec:
    """Colour of a ray of the last generation: what lies beyond, at most the background, is worth nothing."""
    return local


def generations(depth: int) -> int:
    """How many generations follow the eye ray. L11 "Ray Tracing has three features": the depth limit."""
    return depth


def stray(background: Vec, generation: int) -> Vec:
    """What a ray of that generation brings that meets nothing. L11 "Nothing to meet": the background, in every one."""
    return background


def seen(colour: Vec) -> Vec:
    """What a ray brings back of the colour it found: all, unclamped."""
    return colour


@dataclass(frozen=True)
class Rulebook:
    """One entry a formula; the default entries are the lecture's, mended where it errs."""

    name: str = "lecture"
    plane_point: Callable[..., tuple[Number, Number]] = camera.plane_point
    camera_ray: Callable[..., Vec] = camera.camera_ray
    sphere_distances: Callable[..., tuple[Number, Number, Number]] = sphere.sphere_distances
    sphere_hit: Callable[..., tuple[Number, Condition]] = sphere.sphere_hit
    plane_hit: Callable[..., tuple[Number, Condition]] = plane.plane_hit
    nearer: Callable[..., Condition] = nearer
    sphere_normal: Callable[..., Vec] = sphere.sphere_normal
    plane_normal: Callable[..., Vec] = plane.plane_normal
    face: Callable[..., tuple[Vec, Condition]] = optics.face
    reflect: Callable[[Vec, Vec], Vec] = optics.reflect
    mirror: Callable[[Vec, Vec], Vec] = optics.reflect
    refract: Callable[..., tuple[Vec, Condition]] = optics.refract
    fresnel: Callable[..., Number] = optics.fresnel
    shading_normal: Callable[[Vec, Condition], Vec] = optics.shading_normal
    weights: Callable[..., tuple[Vec, Vec]] = weights
    light_vector: Callable[..., tuple[Vec, Number]] = shading.light_vector
    attenuation: Callable[..., Number] = shading.attenuation
    view_vector: Callable[[Vec, Vec, Vec], Vec] = shading.view_vector
    lambert: Callable[[Vec, Vec], Number] = shading.lambert
    phong: Callable[..., Number] = shading.phong
    direct_light: Callable[..., Vec] = shading.direct_light
    shaded_light: Callable[..., Vec] = shading.shaded_light
    ambient_light: Callable[[Vec], Vec] = shading.ambient_light
    add_light: Callable[[Vec, Vec, Vec, Vec], Vec] = shading.add_light
    blocks: Callable[[Number, Number, Condition], Condition] = blocks
    mix: Callable[[Vec, Vec, Vec, Vec, Vec], Vec] = mix
    last: Callable[[Vec, Vec, Vec, Vec, Vec], Vec] = last
    generations: Callable[[int], int] = generations
    stray: Callable[[Vec, int], Vec] = stray
    seen: Callable[[Vec], Vec] = seen
    encode: Callable[..., display.Codes] = display.encode


LECTURE = Rulebook()
