"""Where a ray meets a sphere."""

from __future__ import annotations

from collections.abc import Callable

from reference_tracer.numbers import Condition, Number, at_least, less, select, sqrt0
from reference_tracer.vector import Vec, dot, unit


def sphere_distances(b: Vec, bv: Number, v: Vec, r: Number) -> tuple[Number, Number, Number]:
    """Both roots λ1 <= λ2 of |b + λv| = r for unit v, and D, negative where there is none.

    L11 "Example of Sphere Intersection": with b = o - c and bv = b∘v,
    λ = -b∘v ± sqrt((b∘v)² - (|b|² - r²)). Error 4u(D + D²/cos) r at a distance of D radii.
    """
    D = bv * bv - (dot(b, b) - r * r)
    root = sqrt0(D)
    return -bv - root, -bv + root, D


def sphere_hit(
    distances: Callable[[Vec, Number, Vec, Number], tuple[Number, Number, Number]],
    o: Vec,
    v: Vec,
    c: Vec,
    r: Number,
    starts_here: Condition,
    start: Number,
) -> tuple[Number, Condition]:
    """The λ at which the ray meets the sphere, and whether it does: the smallest root beyond `start`.

    A ray that starts on this sphere has the roots 0 and -2 b∘v exactly: one that leaves outward
    (b∘v > 0) does not meet it again, one that enters has its far root in closed form. So no
    start is excluded by an epsilon (derivation: put |b| = r into the quadratic).
    """
    b = o - c
    bv = dot(b, v)
    near, far, D = distances(b, bv, v, r)
    chord = -(bv + bv)
    first, last = select(starts_here, chord, near), select(starts_here, chord, far)
    distance = select(less(start, first), first, last)
    return distance, (at_least(D, 0.0) | starts_here) & less(start, distance)


def sphere_normal(p: Vec, c: Vec) -> Vec:
    """Outward unit normal at p. L11 "Ray Tracing with a Sphere": n = (p - c)/|p - c|."""
    return unit(p - c)
