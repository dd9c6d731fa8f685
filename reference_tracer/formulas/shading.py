"""Light at a surface point."""

from __future__ import annotations

from typing import Any

from reference_tracer.numbers import Condition, Number, clamp0, less, power, select
from reference_tracer.vector import Vec, dot, length, unit


def light_vector(k: Vec, p: Vec, is_point: Condition) -> tuple[Vec, Number]:
    """Unit vector i from p to the light, and the distance to it (infinite for a directional light).

    L11 "How to Calculate the Distance to Point Lights": i = k - p, made unit (the slide leaves
    that out). For a directional light k is the direction itself.
    """
    w = Vec(select(is_point, k.x - p.x, k.x), select(is_point, k.y - p.y, k.y), select(is_point, k.z - p.z, k.z))
    return unit(w), select(is_point, length(w), float("inf"))


def attenuation(distance: Number, is_inverse: Condition, is_inverse_square: Condition) -> Number:
    """Factor on a light's colour: 1, 1/d or 1/d².

    L11 "Light Position": α = func(distance); "three features": inverse proportional to the
    distance. The scene decides which. At d = 0 the factor is 1: a light on the surface has no
    direction there, so nothing of it is seen.
    """
    d = select(is_inverse | is_inverse_square, distance, 1.0)
    divisor = select(is_inverse_square, d * d, d)
    return 1.0 / select(less(0.0, divisor), divisor, 1.0)


def view_vector(v: Vec, p: Vec, eye: Vec) -> Vec:
    """Unit direction in which a highlight at p is looked at: the ray's own, in mirrors and glass too.

    L11 "Phong Effect" has one eye; only for rays of generation 0 is it the camera's.
    """
    return v


def lambert(i: Vec, n: Vec) -> Number:
    """cosθ = i∘n, 0 for a light behind the surface. L11 "Lambertian Reflection Model"."""
    return clamp0(dot(i, n))


def phong(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Number:
    """Specular factor (r∘(-v))^s, 0 where the light is behind the surface or the product is negative.

    L11 "Phong Effect": S(α) = (r∘v)^s with r the light's mirror direction and v pointing to the
    eye, which is minus our travelling ray.
    """
    gloss = power(clamp0(-dot(mirrored, v)), s)
    return select(less(0.0, dot(i, n)), gloss, 0.0)


def direct_light(colour: Vec, factor: Number, diffuse: Vec, cosine: Number, specular: Vec, gloss: Number) -> Vec:
    """One light's share: α · colour · (diffuse·cosθ + specular·gloss). L11 "Phong's effect Result"."""
    share: Vec = (colour * factor) * (diffuse * cosine + specular * gloss)
    return share


def shaded_light(colour: Vec, factor: Number, diffuse: Vec, cosine: Number, specular: Vec, gloss: Number) -> Vec:
    """The share of a light that something hides: nothing. L11 "Example of Ray Tracing", shadows."""
    return Vec(0.0, 0.0, 0.0)


def ambient_light(ambient: Vec) -> Vec:
    """What the sum over the lights begins with. L11 "uRT-10-RT5-Colors-Ambient_diffuse": ambient, once."""
    return ambient


def add_light(total: Vec, share: Vec, ambient: Vec, colour: Vec) -> Vec:
    """The sum over the lights with one more share; `ambient` of the material and the light's `colour` are not used."""
    return total + share
