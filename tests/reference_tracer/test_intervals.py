"""Exact pixels against an interval tracer that shares nothing with them.

mpmath's end points, another recursion, other formulas: spheres by the foot point of the centre on the ray, a start
on a sphere by dropping the root that holds 0, Snell in vector form, Fresnel from the ratio of the indices alone.
"""

import random

import pytest
from mpmath import iv, mp

from reference_tracer import exact
from scenes.catalogue import ladder, rung
from scenes.model import PointLight, Sphere
from scenes.random_scenes import random_scene

BITS = 200
SCENES = {entry.name: rung(entry.name).scene() for entry in ladder()} | {
    f"random-{seed}": random_scene(seed) for seed in range(300, 312)
}


class OverlapError(Exception):
    """A comparison that these intervals cannot decide."""


def positive(x):
    if x.a > 0:
        return True
    if x.b <= 0:
        return False
    raise OverlapError


def vector(components):
    return [iv.mpf(c) for c in components]


def inner(a, b):
    return sum((x * y for x, y in zip(a, b, strict=True)), iv.mpf(0))


def along(o, v, d):
    return [x + d * y for x, y in zip(o, v, strict=True)]


def scaled(a, factor):
    return [x * factor for x in a]


def normalised(a):
    return scaled(a, 1 / iv.sqrt(inner(a, a)))


class IntervalTracer:
    """FindRGB once more."""

    def __init__(self, scene):
        self.scene = scene
        self.things = [scene.objects[k] for k in scene.tie_order]

    def pixel(self, i, j):
        image, camera = self.scene.image, self.scene.camera
        x = 2 * (iv.mpf(i) + image.sample[0]) / image.width - 1
        y = 1 - 2 * (iv.mpf(j) + image.sample[1]) / image.height
        axes = zip(*(vector(a) for a in (camera.forward, camera.right, camera.up)), strict=True)
        return self.seen(vector(camera.eye), normalised([f + x * r + y * u for f, r, u in axes]), None, 0)

    def distances(self, thing, o, v, starts_here):
        """Distances greater than 0 at which the ray meets the thing."""
        if not isinstance(thing, Sphere):
            n = vector(thing.normal)
            slope = inner(n, v)
            if starts_here or slope == 0:
                return []
            found = (thing.offset - inner(n, o)) / slope
            return [found] if positive(found) else []
        to_centre = [c - x for c, x in zip(vector(thing.center), o, strict=True)]
        foot = inner(to_centre, v)
        miss = [x - foot * y for x, y in zip(to_centre, v, strict=True)]
        square = iv.mpf(thing.radius) ** 2 - inner(miss, miss)
        if not positive(square):
            return []
        half = iv.sqrt(square)
        roots = [foot - half, foot + half]
        return [r for r in roots if not (starts_here and 0 in r) and positive(r)]

    def first(self, o, v, start):
        best = None
        for thing in self.things:
            for d in self.distances(thing, o, v, thing is start):
                if best is None or positive(best[0] - d):
                    best = (d, thing)
        return best

    def seen(self, o, v, start, generation):
        hit = self.first(o, v, start)
        if hit is None:
            return vector(self.scene.background)
        d, thing = hit
        p = along(o, v, d)
        m = self.scene.materials[thing.material]
        n = (
            normalised([x - c for x, c in zip(p, vector(thing.center), strict=True)])
            if isinstance(thing, Sphere)
            else normalised(vector(thing.normal))
        )
        inside = positive(inner(n, v))
        if inside:
            n = scaled(n, -1)
        colour = self.lit(m, thing, p, n, v)
        if generation == self.scene.depth:
            return colour
        cosine = -inner(n, v)
        mirrored = along(v, n, 2 * cosine)
        F, refracted = self.split(v, n, cosine, iv.mpf(m.index) if inside else 1 / iv.mpf(m.index))
        weights = [(m.reflect, F if self.scene.fresnel else 1, mirrored)]
        if refracted is not None:
            weights.append((m.transmit, 1 - F if self.scene.fresnel else 1, refracted))
        for shares, factor, direction in weights:
            if any(shares):
                beyond = self.seen(p, direction, thing, generation + 1)
                colour = [c + s * factor * b for c, s, b in zip(colour, shares, beyond, strict=True)]
        return colour

    def split(self, v, n, cosine, eta):
        """Fresnel's share, and the refracted direction t = ηv + (η cosθ1 - cosθ2)n, none under total reflection."""
        k = 1 - eta**2 * (1 - cosine**2)
        if not positive(k):
            return iv.mpf(1), None
        other = iv.sqrt(k)
        senkrecht = ((eta * cosine - other) / (eta * cosine + other)) ** 2
        parallel = ((cosine - eta * other) / (cosine + eta * other)) ** 2
        t = [eta * x + (eta * cosine - other) * y for x, y in zip(v, n, strict=True)]
        return (senkrecht + parallel) / 2, t

    def lit(self, m, thing, p, n, v):
        colour = vector(m.ambient)
        for light in self.scene.lights:
            limit, factor = None, iv.mpf(1)
            if isinstance(light, PointLight):
                w = [x - y for x, y in zip(vector(light.position), p, strict=True)]
                square = inner(w, w)
                limit = iv.sqrt(square)
                factor = {"none": factor, "inverse": 1 / limit, "inverse_square": 1 / square}[light.attenuation]
            else:
                w = vector(light.toward)
            i = normalised(w)
            cosine = inner(i, n)
            if not positive(cosine):
                continue
            lobe = 2 * cosine * inner(n, scaled(v, -1)) + inner(i, v)
            gloss = lobe**m.shininess if any(m.specular) and positive(lobe) else iv.mpf(0)
            if self.scene.shadows and self.hidden(p, i, thing, limit):
                continue
            colour = [
                c + factor * k * (d * cosine + s * gloss)
                for c, k, d, s in zip(colour, light.color, m.diffuse, m.specular, strict=True)
            ]
        return colour

    def hidden(self, p, i, start, limit):
        return any(
            limit is None or positive(limit - d)
            for thing in self.things
            for d in self.distances(thing, p, i, thing is start)
        )


@pytest.fixture(autouse=True)
def many_bits():
    before, iv.prec, mp.prec = (iv.prec, mp.prec), BITS, BITS
    yield
    iv.prec, mp.prec = before


def apart(pixel, channels):
    """Channels in which the two enclosures have nothing in common."""
    return [
        k
        for k, (value, bound, other) in enumerate(zip(pixel.value, pixel.bound, channels, strict=True))
        if other.a > mp.mpf(value) + mp.mpf(bound) or other.b < mp.mpf(value) - mp.mpf(bound)
    ]


def sample(scene, count):
    chance = random.Random(scene.name)  # noqa: S311 - pixels, not secrets
    return [(chance.randrange(scene.image.width), chance.randrange(scene.image.height)) for _ in range(count)]


@pytest.mark.parametrize("name", SCENES)
def test_exact_pixels_overlap_those_of_another_tracer(name):
    scene = SCENES[name]
    theirs, ours = IntervalTracer(scene), exact.ExactTracer(scene)
    told = 0
    for i, j in sample(scene, 10):
        pixel = ours.pixel(i, j)
        assert pixel.decided
        try:
            channels = theirs.pixel(i, j)
        except OverlapError:
            continue
        told += 1
        assert apart(pixel, channels) == []
        assert all(channel.delta < 2.0**-64 for channel in channels)  # narrow beside a float64's 2^-53
    assert told >= 7


def test_a_formula_gone_wrong_is_told():
    scene = SCENES["glass-sphere"]
    other = scene.materials["glass"].model_copy(update={"index": 1.5 + 1e-12})
    changed = scene.model_copy(update={"materials": {**scene.materials, "glass": other}})
    theirs, ours = IntervalTracer(changed), exact.ExactTracer(scene)
    places = [(i, scene.image.height // 2 + 3) for i in range(5, scene.image.width, 11)]
    assert any(apart(ours.pixel(i, j), theirs.pixel(i, j)) for i, j in places)
