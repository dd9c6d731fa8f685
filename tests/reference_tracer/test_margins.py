"""Margins of decisions against the plain tracer asking the same questions one by one, by other formulas."""

import math

import numpy as np
import pytest

from reference_tracer.lanes import render as lanes
from reference_tracer.plain import PlainTracer
from reference_tracer.vector import dot, unit
from scenes.catalogue import rung
from scenes.model import Sphere
from scenes.random_scenes import random_scene


class Watching(PlainTracer):
    """The plain tracer, noting how clear each decision on a pixel's path is."""

    def margin(self, i, j):
        self.found = math.inf
        self.pixel(i, j)
        return self.found

    def note(self, margin):
        self.found = min(self.found, abs(margin))

    def clear(self, o, v, start):
        """Every sphere by its foot point, every plane by the angle; the distances of those met."""
        met = []
        for order, thing in enumerate(self.objects):
            if order != start:
                if isinstance(thing, Sphere):
                    b = o - self.vec(thing.center)
                    foot = b - v * dot(b, v)
                    self.note(1.0 - dot(foot, foot) / thing.radius**2)
                else:
                    self.note(dot(unit(self.vec(thing.normal)), v))
            distance, meets = self.meet(o, v, thing, order == start)
            if meets:
                met.append(distance)
        return sorted(met)

    def nearest(self, o, v, start):
        first, second = (*self.clear(o, v, start), math.inf, math.inf)[:2]
        if second < math.inf:
            self.note((second - first) / first)
        return super().nearest(o, v, start)

    def find_rgb(self, o, v, start, generation):
        ends = generation == self.scene.depth  # what lies beyond the last surface is not asked
        hit = None if ends else PlainTracer.nearest(self, o, v, start)
        if hit is not None and any(self.scene.materials[hit.thing.material].transmit):
            index = self.scene.materials[hit.thing.material].index
            cosine = dot(v, hit.n)
            sine = math.sqrt(max(0.0, 1.0 - cosine**2)) * (index if cosine > 0.0 else 1.0 / index)
            self.note((1.0 - sine) * (1.0 + sine))
        return super().find_rgb(o, v, start, generation)

    def local_colour(self, hit, n, v):
        for light in self.scene.lights:
            point = getattr(light, "position", None)
            i = unit(self.vec(point) - hit.p) if point else unit(self.vec(light.toward))
            self.note(dot(i, n))
        return super().local_colour(hit, n, v)

    def shadowed(self, p, i, light_distance, start):
        self.clear(p, i, start)
        return super().shadowed(p, i, light_distance, start)


SCENES = {
    name: rung(name).scene().resized(24, 18)
    for name in ("lecture-final", "two-lights", "shadow-glass", "air-bubble", "facing-mirrors-3", "plane-both-sides")
} | {f"random-{seed}": random_scene(seed).resized(16, 12) for seed in range(12)}


@pytest.mark.parametrize("name", SCENES)
def test_a_margin_is_the_smallest_of_all_decisions_on_the_path(name):
    scene = SCENES[name]
    tracer = Watching(scene)
    width, height = scene.image.width, scene.image.height
    expected = np.array([[tracer.margin(i, j) for i in range(width)] for j in range(height)])
    found = lanes.margins(scene)
    # Differences of numbers near 1, good to 4u at the first hit and thirty times less so each generation after it
    rounded = 4 * 2.0**-53 * 30.0**3
    assert np.allclose(found, expected, rtol=rounded, atol=rounded)


def test_a_margin_does_not_depend_on_its_neighbours(monkeypatch):
    scene = random_scene(7).resized(24, 18)
    whole = lanes.margins(scene)
    monkeypatch.setattr(lanes, "tile_size", lambda scene, backend: 7)
    assert (lanes.margins(scene) == whole).all()


def test_nothing_decided_is_no_end_of_margin():
    assert np.isinf(lanes.margins(rung("background").scene().resized(4, 3))).all()
