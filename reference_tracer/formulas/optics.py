"""Reflection, refraction, Fresnel."""

from __future__ import annotations

from reference_tracer.numbers import Condition, Number, at_least, less, select, sqrt0
from reference_tracer.vector import Vec, dot, select_vec, unit


def face(v: Vec, n: Vec) -> tuple[Vec, Condition]:
    """The normal turned to face the ray v (n∘v <= 0), and whether v leaves the object (n∘v > 0)."""
    leaving = less(0.0, dot(n, v))
    return select_vec(leaving, -n, n), leaving


def shading_normal(n: Vec, leaving: Condition) -> Vec:
    """The normal that light is counted by: the one that faces the ray, so that both sides are lit."""
    return n


def reflect(i: Vec, n: Vec) -> Vec:
    """Mirror direction of i, both pointing away from the surface.

    L11 "Math of Reflection Vector": r = 2(i∘n)n - i. (The slide's second form 2n - i is equal
    only for i = n.)
    """
    mirrored: Vec = n * (2.0 * dot(i, n)) - i
    return mirrored


def refract(v: Vec, n: Vec, leaving: Condition, index: Number) -> tuple[Vec, Condition]:
    """Refracted unit direction t of the travelling unit ray v, n facing it; and whether it is totally reflected.

    L11 "Refraction Vector Calculation": t = sinθ2 p_u - cosθ2 n with p = (i∘n)n - i and i = -v.
    |p| = sinθ1, so sinθ2 p_u = p sinθ2/sinθ1 = p/index (entering) or p·index (leaving, where the
    slide's code forgets to invert): no 0/0 at normal incidence, error O(u) instead of O(sqrt u).
    Total reflection where sinθ2 >= 1, as in the slide's code.
    """
    p = n * -dot(v, n) + v
    s = select_vec(leaving, p * index, p / index)
    sin2 = dot(s, s)
    t = s - n * sqrt0(1.0 - sin2)
    return unit(t), at_least(sin2, 1.0)


def fresnel(v: Vec, n: Vec, leaving: Condition, index: Number) -> Number:
    """Reflected share F of unpolarised light at a dielectric; 1 under total internal reflection.

    Born & Wolf, Principles of Optics, 1.5.2: F = (r_s² + r_p²)/2 with r_s = (n1 c1 - n2 c2)/(n1 c1 + n2 c2) and
    r_p = (n2 c1 - n1 c2)/(n2 c1 + n1 c2), c1 and c2 the cosines of incidence and refraction.
    """
    c1 = -dot(v, n)
    p = n * c1 + v
    s = select_vec(leaving, p * index, p / index)
    sin2 = dot(s, s)
    c2 = sqrt0(1.0 - sin2)
    n1 = select(leaving, index, 1.0)
    n2 = select(leaving, 1.0, index)
    s_sum, p_sum = n1 * c1 + n2 * c2, n2 * c1 + n1 * c2
    r_s = (n1 * c1 - n2 * c2) / select(less(0.0, s_sum), s_sum, 1.0)
    r_p = (n2 * c1 - n1 * c2) / select(less(0.0, p_sum), p_sum, 1.0)
    F = 0.5 * (r_s * r_s + r_p * r_p)
    return select(at_least(sin2, 1.0), 1.0, F)


def cut(total: Condition, refracted: Vec) -> Vec:
    """What the refracted ray brings: nothing under total reflection. L11 "Get Refraction Vector": s2 >= 1."""
    return Vec(*(select(total, 0.0, part) for part in refracted))
