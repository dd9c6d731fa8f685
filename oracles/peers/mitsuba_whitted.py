"""The lecture's model on Mitsuba's own primitives.

Everything geometric is Mitsuba's: which shape a ray meets and where (`ray_intersect`), its frame, occlusion
(`ray_test`), the start of secondary rays (`spawn_ray`, which moves it along the normal by (1 + max|p|)·8.94e-5),
`reflect`, `refract` and `fresnel`. Only the order of the terms is ours: the sum of the scene format, which no
plugin of Mitsuba has. One body serves a scalar variant, a ray at a time, and an LLVM variant, all rays at once.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.peers.mitsuba_scene import Tables, load
from scenes.model import Light, PointLight, Scene


class Whitted:
    """Traces one scene in the chosen variant of Mitsuba."""

    def __init__(self, mi: Any, scene: Scene) -> None:
        self.mi, self.scene = mi, scene
        self.tables = Tables(mi, scene)
        self.dr = self.tables.dr
        self.loaded = load(mi, scene)
        self.background = mi.Color3f(*scene.background)

    def eye_rays(self, i: Any, j: Any) -> Any:
        """Rays through the samples of pixels (i, j): numbers, or arrays of them."""
        mi, camera, image = self.mi, self.scene.camera, self.scene.image
        X = 2.0 * (i + image.sample[0]) / image.width - 1.0
        Y = 1.0 - 2.0 * (j + image.sample[1]) / image.height
        forward, right, up = (mi.Vector3f(*axis) for axis in (camera.forward, camera.right, camera.up))
        return mi.Ray3f(mi.Point3f(*camera.eye), self.dr.normalize(forward + right * X + up * Y))

    def find_rgb(self, ray: Any, generation: int, active: Any) -> Any:
        """Colour along each active ray; the background where it meets nothing."""
        dr = self.dr
        si = self.loaded.scene.ray_intersect(ray, active)
        hit = active & si.is_valid()
        if not dr.any(hit):
            return dr.select(active, self.background, self.mi.Color3f(0.0))
        order = self.loaded.order(si.shape, hit)
        colour = self.local(si, order, hit)
        if generation < self.scene.depth:
            colour += self.branches(si, order, hit, generation)
        return dr.select(hit, colour, self.background)

    def local(self, si: Any, order: Any, hit: Any) -> Any:
        """Ambient, and the diffuse and specular light of every lamp in view."""
        ambient, diffuse, specular = (self.tables.colour(n, order, hit) for n in ("ambient", "diffuse", "specular"))
        colour = self.mi.Color3f(ambient)
        for light in self.scene.lights:
            ray, to_light, factor = self.toward(light, si)
            cosine, gloss = self.phong(si, to_light, order, hit)
            share = self.mi.Color3f(*light.color) * factor * (diffuse * cosine + specular * gloss)
            lit = hit & self.dr.any(share != 0.0)
            if self.scene.shadows:
                lit = self.in_view(ray, lit)
            colour += self.dr.select(lit, share, 0.0)
        return colour

    def in_view(self, ray: Any, lit: Any) -> Any:
        """Where nothing stands on the shadow ray."""
        if self.tables.scalar:
            return lit and not self.loaded.scene.ray_test(ray)
        return lit & ~self.loaded.scene.ray_test(ray, lit)

    def toward(self, light: Light, si: Any) -> tuple[Any, Any, Any]:
        """Shadow ray, unit direction to the light in the local frame, attenuation."""
        mi, dr = self.mi, self.dr
        if not isinstance(light, PointLight):
            direction = dr.normalize(mi.Vector3f(*light.toward))
            return si.spawn_ray(direction), si.to_local(direction), 1.0
        position = mi.Point3f(*light.position)
        w = position - si.p
        distance = dr.norm(w)
        factor = {"none": 1.0, "inverse": 1.0 / distance, "inverse_square": 1.0 / (distance * distance)}
        return si.spawn_ray_to(position), si.to_local(w / distance), factor[light.attenuation]

    def phong(self, si: Any, i: Any, order: Any, hit: Any) -> tuple[Any, Any]:
        """max(i·n, 0) and the specular factor, the frame's normal turned to the viewer."""
        mi, dr = self.mi, self.dr
        leaving = si.wi.z < 0.0
        wi = mi.Vector3f(si.wi.x, si.wi.y, dr.abs(si.wi.z))
        i = mi.Vector3f(i.x, i.y, dr.select(leaving, -i.z, i.z))
        base = dr.maximum(dr.dot(mi.reflect(i), wi), 0.0)
        exponent = self.tables.number(self.tables.shininess, order, hit)
        gloss = mi.Float(0.0)
        for s in self.tables.exponents:  # an integer power is a chain of products; a general one is 800 ulp off
            gloss = dr.select(exponent == s, base**s, gloss)
        return dr.maximum(i.z, 0.0), dr.select(i.z > 0.0, gloss, 0.0)

    def branches(self, si: Any, order: Any, hit: Any, generation: int) -> Any:
        """The reflected and the refracted ray's colours, weighted."""
        mi, dr = self.mi, self.dr
        colour = mi.Color3f(0.0)
        F, cos_t, _, ratio = mi.fresnel(si.wi.z, self.tables.number(self.tables.index, order, hit))
        for name, local, share, exists in (
            ("reflect", mi.reflect(si.wi), F, True),
            ("transmit", mi.refract(si.wi, cos_t, ratio), 1.0 - F, cos_t != 0.0),
        ):
            weight = self.tables.colour(name, order, hit)
            follow = hit & dr.any(weight != 0.0) & exists
            if self.tables.any(name) and dr.any(follow):
                seen = self.find_rgb(si.spawn_ray(si.to_world(local)), generation + 1, follow)
                weight = weight * share if self.scene.fresnel else weight
                colour += dr.select(follow, weight * seen, 0.0)
        return colour


def render(mi: Any, scene: Scene, seed: int, samples: int) -> NDArray[np.float32]:
    """The whole picture (height, width, 3), linear; nothing in it is random."""
    tracer = Whitted(mi, scene)
    width, height = scene.image.width, scene.image.height
    if tracer.tables.scalar:
        rows = [[tracer.find_rgb(tracer.eye_rays(i, j), 0, True) for i in range(width)] for j in range(height)]
        return np.array([[[c.x, c.y, c.z] for c in row] for row in rows], dtype=np.float32)
    j, i = np.mgrid[0:height, 0:width].astype(np.float32).reshape(2, -1)
    rays = tracer.eye_rays(mi.Float(i), mi.Float(j))
    colour = tracer.find_rgb(rays, 0, tracer.dr.full(mi.Bool, True, width * height))
    return np.ascontiguousarray(np.array(colour).T, dtype=np.float32).reshape(height, width, 3)
