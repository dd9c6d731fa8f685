"""The plain tracer: the lecture's FindRGB on Python floats, the specification of all the others.

Read this file to know what a picture means; the lanes compute the same numbers,
bit for bit, only faster.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from reference_tracer.formulas.optics import cut
from reference_tracer.image import Image
from reference_tracer.numbers import Number
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec
from scenes.model import Object, PointLight, Scene, Sphere

BLACK = Vec(0.0, 0.0, 0.0)


def black(colour: Vec) -> bool:
    """Whether a colour is 0 for certain."""
    return all(part == 0.0 for part in colour)


@dataclass(frozen=True)
class Hit:
    """The nearest object on a ray, where, and the object's outward normal there."""

    order: int
    thing: Object
    p: Vec
    n: Vec


class PlainTracer:
    """Traces one scene, one ray at a time.

    number: what a number of the scene becomes before it is computed with.
    """

    def __init__(self, scene: Scene, rules: Rulebook = LECTURE, number: Callable[[float], Number] = float) -> None:
        self.scene = scene
        self.rules = rules
        self.number = number
        self.objects = [scene.objects[k] for k in scene.tie_order]

    def vec(self, components: tuple[float, float, float]) -> Vec:
        """A vector or colour of the scene."""
        return Vec(*(self.number(component) for component in components))

    def pixel(self, i: int, j: int) -> Vec:
        """Linear colour of pixel (i, j)."""
        return self.find_rgb(self.vec(self.scene.camera.eye), self.eye_ray(i, j), None, 0)

    def eye_ray(self, i: int, j: int) -> Vec:
        """Unit direction of the ray through pixel (i, j)."""
        image, camera = self.scene.image, self.scene.camera
        x, y, width, height, *sample = (self.number(n) for n in (i, j, image.width, image.height, *image.sample))
        X, Y = self.rules.plane_point(x, y, width, height, sample)
        return self.rules.camera_ray(self.vec(camera.forward), self.vec(camera.right), self.vec(camera.up), X, Y)

    def find_rgb(self, o: Vec, v: Vec, start: int | None, generation: int) -> Vec:
        """Colour seen from o along unit v. L11 "Modified FindRGB" and "Refraction with geo.tr vector".

        start: the object (its place in self.objects) that the ray starts on.
        """
        rules = self.rules
        hit = self.nearest(o, v, start)
        background = self.vec(self.scene.background)
        if hit is None:
            return rules.seen(rules.stray(background, generation))  # L11 "three features": the ray goes astray

        # The light on the surface, and where the ray goes on
        material = self.scene.materials[hit.thing.material]
        index = self.number(material.index)
        n, leaving = rules.face(v, hit.n)
        local = self.local_colour(hit, rules.shading_normal(n, leaving), v)
        t, total = rules.refract(v, n, leaving, index) if any(material.transmit) else (v, False)
        reflect, transmit = rules.weights(
            self.vec(material.reflect),
            self.vec(material.transmit),
            total,
            self.scene.fresnel,
            lambda: rules.fresnel(v, n, leaving, index),
        )
        if generation == rules.generations(self.scene.depth):
            return rules.seen(rules.last(local, reflect, background, transmit, cut(total, background)))

        # Follow the branches whose weight is not 0
        reflected = transmitted = BLACK
        if not black(reflect):
            reflected = self.find_rgb(hit.p, rules.mirror(-v, n), hit.order, generation + 1)
        if not (total or black(transmit)):
            transmitted = self.find_rgb(hit.p, t, hit.order, generation + 1)
        return rules.seen(rules.mix(local, reflect, reflected, transmit, transmitted))

    def nearest(self, o: Vec, v: Vec, start: int | None) -> Hit | None:
        """The first object along the ray. L11 "Ray Tracing Depth Sorting"."""
        best, found = float("inf"), -1
        for order, thing in enumerate(self.objects):
            distance, meets = self.meet(o, v, thing, order == start)
            if meets and (found < 0 or self.rules.nearer(distance, best, order, found)):
                best, found = distance, order
        if found < 0:
            return None
        thing = self.objects[found]
        p = o + v * best
        return Hit(found, thing, p, self.normal(thing, p))

    def meet(self, o: Vec, v: Vec, thing: Object, starts_here: bool) -> tuple[float, bool]:
        """Distance to one object, and whether the ray meets it."""
        rules = self.rules
        if isinstance(thing, Sphere):
            c = self.vec(thing.center)
            return rules.sphere_hit(rules.sphere_distances, o, v, c, self.number(thing.radius), starts_here, 0.0)
        return rules.plane_hit(o, v, self.vec(thing.normal), self.number(thing.offset), not starts_here, 0.0)

    def normal(self, thing: Object, p: Vec) -> Vec:
        """Outward unit normal of an object at p."""
        if isinstance(thing, Sphere):
            return self.rules.sphere_normal(p, self.vec(thing.center))
        return self.rules.plane_normal(self.vec(thing.normal))

    def local_colour(self, hit: Hit, n: Vec, v: Vec) -> Vec:
        """Ambient, and the diffuse and specular light of every lamp in view. L11 "Phong Effect"."""
        rules = self.rules
        material = self.scene.materials[hit.thing.material]
        ambient = self.vec(material.ambient)
        v = rules.view_vector(v, hit.p, self.vec(self.scene.camera.eye))
        colour = rules.ambient_light(ambient)
        for light in self.scene.lights:
            is_point = isinstance(light, PointLight)
            k = self.vec(light.position if isinstance(light, PointLight) else light.toward)
            kind = light.attenuation if isinstance(light, PointLight) else "none"
            i, distance = rules.light_vector(k, hit.p, is_point)
            factor = rules.attenuation(distance, kind == "inverse", kind == "inverse_square")
            cosine = rules.lambert(i, n)
            gloss = rules.phong(i, n, v, material.shininess, rules.reflect(i, n))
            diffuse, specular = self.vec(material.diffuse), self.vec(material.specular)
            terms = (self.vec(light.color), factor, diffuse, cosine, specular, gloss)
            share = rules.direct_light(*terms)
            if self.scene.shadows and not black(share) and self.shadowed(hit.p, i, distance, hit.order):
                share = rules.shaded_light(*terms)
            colour = rules.add_light(colour, share, ambient, self.vec(light.color))
        return colour

    def shadowed(self, p: Vec, i: Vec, light_distance: float, start: int) -> bool:
        """Does anything stand strictly between p and the light? L11 "Example of Ray Tracing"."""
        for order, thing in enumerate(self.objects):
            distance, meets = self.meet(p, i, thing, order == start)
            opaque = not any(self.scene.materials[thing.material].transmit)
            if meets and self.rules.blocks(distance, light_distance, opaque):
                return True
        return False


def render(scene: Scene, rules: Rulebook = LECTURE, progress: Callable[[float], Any] = lambda share: None) -> Image:
    """Render a whole scene; pixels (height, width, 3) float64, linear."""
    tracer = PlainTracer(scene, rules)
    width, height = scene.image.width, scene.image.height
    pixels = np.empty((height, width, 3))
    for j in range(height):
        for i in range(width):
            pixels[j, i] = tracer.pixel(i, j)
        progress((j + 1) / height)
    return Image(pixels)
