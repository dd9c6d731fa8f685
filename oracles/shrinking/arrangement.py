"""How the things of a scene stand to each other: what must not change while their numbers are rounded."""

from __future__ import annotations

import math
from collections.abc import Iterator

from scenes.generator import GAP
from scenes.model import Plane, PointLight, Scene, Sphere, Vector


def gap(scene: Scene) -> float:
    """Least distance of a surface from the eye, a point light or another surface; 0 where two of them cross.

    Planes may cross each other; GAP where there is nothing to be near to.
    """
    return min((distance for distance, _ in _pairs(scene)), default=GAP)


def sides(scene: Scene) -> tuple[int, ...]:
    """Of each surface and each eye, point light or other surface: 1 outside or above, -1 inside or below, 0 across."""
    return tuple(side for _, side in _pairs(scene))


def _pairs(scene: Scene) -> Iterator[tuple[float, int]]:
    """(distance, side) of every pair, in an order that numbers do not change."""
    points = [scene.camera.eye, *(light.position for light in scene.lights if isinstance(light, PointLight))]
    balls = [thing for thing in scene.objects if isinstance(thing, Sphere)]
    floors = [thing for thing in scene.objects if isinstance(thing, Plane)]
    yield from (_told(math.dist(p, ball.center) - ball.radius) for p in points for ball in balls)
    yield from (_told(_height(p, floor)) for p in points for floor in floors)
    yield from (_told(_height(ball.center, floor), ball.radius) for ball in balls for floor in floors)
    yield from (_two_balls(one, other) for k, one in enumerate(balls) for other in balls[:k])


def _told(away: float, radius: float = 0.0) -> tuple[float, int]:
    """Of a ball of that radius (0: a point) whose centre is `away` from a surface, with a sign."""
    distance = abs(away) - radius
    return (distance, 1 if away > 0.0 else -1) if distance > 0.0 else (0.0, 0)


def _height(p: Vector, floor: Plane) -> float:
    """Distance of p from a plane, positive where its normal points to."""
    return (sum(a * b for a, b in zip(p, floor.normal, strict=True)) - floor.offset) / math.hypot(*floor.normal)


def _two_balls(one: Sphere, other: Sphere) -> tuple[float, int]:
    apart = math.dist(one.center, other.center)
    outside = apart - one.radius - other.radius
    nested = abs(one.radius - other.radius) - apart
    if outside > 0.0:
        return outside, 1
    return (nested, -1) if nested > 0.0 else (0.0, 0)
