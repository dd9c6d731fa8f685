"""Between which values the colours of a scene lie, whatever a ray meets: what a ray in doubt is held to.

Local light lies between 0 and ambient + Σ attenuation·colour·(diffuse + specular), the ambient term once or with
each light's colour, whichever is more. From the last generation up, the rulebook's own mixing is evaluated at
the ends of everything it mixes: it is linear in each, so its values lie between. Weights may be anything that a
dialect makes of them: each from 0 to the material's, and under total reflection both on the mirrored ray.

A tracer's rounding makes a cosine larger than 1 and a light nearer than it is; see docs/tolerance.md, "Spans".
"""

from __future__ import annotations

import itertools
import math

from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec
from scenes.model import Light, Material, Object, PointLight, Scene, Sphere

Span = tuple[float, float]
BLACK = Vec(0.0, 0.0, 0.0)


def colours(scene: Scene, rules: Rulebook, u: float) -> list[list[Span]]:
    """The lowest and highest value of each channel of a ray of generation 0, 1, ... in a tracer of roundoff u."""
    generations = rules.generations(scene.depth)
    more = 1.0 + 32.0 * u * (generations + 2)
    used = [scene.materials[name] for name in {thing.material for thing in scene.objects}]
    near = [_strongest(light, scene, u) for light in scene.lights]
    brightest = [_local(m, scene, near, more) for m in used]
    beyond: tuple[Vec, ...] = ()
    found = []
    for _ in range(generations + 1):
        values = [Vec(*scene.background)]
        for m, local in zip(used, brightest, strict=True):
            values += _mixed(m, local, beyond, rules, Vec(*scene.background))
        spans = [_span(channel, more) for channel in zip(*values, strict=True)]
        beyond = (Vec(*(low for low, _ in spans)), Vec(*(top for _, top in spans)))
        found.append(spans)
    return found[::-1]


def _mixed(m: Material, local: Vec, beyond: tuple[Vec, ...], rules: Rulebook, background: Vec) -> list[Vec]:
    """The shading sum at all ends of what goes into it; `beyond` holds the ends of the next generation, if any."""
    r, t = Vec(*m.reflect), Vec(*m.transmit)
    weights = [(BLACK, BLACK), (r, BLACK), (BLACK, t), (r, t), (r + t, BLACK)]
    if not beyond:
        seen = (background, BLACK)
        return [rules.last(own, w, background, x, end) for own in (BLACK, local) for w, x in weights for end in seen]
    ends = [Vec(*(x if w else 0.0 for x, w in zip(end, r + t, strict=True))) for end in beyond]
    return [
        rules.mix(own, reflect, mirrored, transmit, refracted)
        for own, (reflect, transmit) in itertools.product((BLACK, local), weights)
        for mirrored, refracted in itertools.product(ends, repeat=2)
    ]


def _span(values: tuple[float, ...], more: float) -> Span:
    """The ends of 0 and these values, with the roundings of the tracer and of this estimate."""
    if any(map(math.isnan, values)):
        return -math.inf, math.inf
    return min(0.0, *values) * (more + 1e-6), max(0.0, *values) * (more + 1e-6)


def _local(m: Material, scene: Scene, near: list[float], more: float) -> Vec:
    """The brightest colour of a surface without its branches, each cosine at most `more`."""
    channels = []
    for k in range(3):
        lit = m.diffuse[k] * more + (m.specular[k] * more**m.shininess if m.specular[k] else 0.0)
        ambient = m.ambient[k] * max(1.0, sum(light.color[k] for light in scene.lights))
        strength = zip(near, scene.lights, strict=True)
        channels.append(ambient + sum(a * light.color[k] * lit for a, light in strength if light.color[k] * lit))
    return Vec(*channels)


def _strongest(light: Light, scene: Scene, u: float) -> float:
    """The largest attenuation factor of a light on any surface, as a tracer finds it."""
    if not isinstance(light, PointLight) or light.attenuation == "none":
        return 1.0
    k = light.position
    extent = max([math.hypot(*k), math.hypot(*scene.camera.eye), *map(_reach, scene.objects)])
    gap = min((_gap(k, thing) - _residual(thing, extent, u) for thing in scene.objects), default=math.inf)
    if gap <= 0.0:
        return math.inf
    return 1.0 / (gap if light.attenuation == "inverse" else gap * gap)


def _gap(k: tuple[float, float, float], thing: Object) -> float:
    """The distance of a point from a surface."""
    if isinstance(thing, Sphere):
        return abs(math.dist(k, thing.center) - thing.radius)
    return abs(sum(a * b for a, b in zip(thing.normal, k, strict=True)) - thing.offset) / math.hypot(*thing.normal)


def _reach(thing: Object) -> float:
    """The distance of a surface's farthest point from the origin; of a plane, which has none, its nearest."""
    if isinstance(thing, Sphere):
        return math.hypot(*thing.center) + thing.radius
    return abs(thing.offset) / math.hypot(*thing.normal)


def _residual(thing: Object, extent: float, u: float) -> float:
    """How far off its surface a hit point may be: 8u·extent, and for a sphere D = 2·extent/r radii away 4uD²r more."""
    bend = 2.0 * extent / thing.radius if isinstance(thing, Sphere) else 0.0
    return 8.0 * u * extent * (1.0 + bend)
