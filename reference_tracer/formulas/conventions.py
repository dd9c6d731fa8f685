"""Formulas that other tracers lawfully use in the place of the scene model's.

Each is what real tracers do; none touches geometry, visibility or Snell's law. `reference_tracer.dialects` puts
them into a rulebook.
"""

from __future__ import annotations

from collections.abc import Callable

from reference_tracer.formulas import camera
from reference_tracer.formulas.optics import cut
from reference_tracer.numbers import Condition, Number, at_least, clamp0, less, over_pi, power, select, sqrt0
from reference_tracer.vector import Vec, dot, select_vec, unit


def at_corner(
    i: Number, j: Number, width: Number, height: Number, sample: tuple[Number, Number]
) -> tuple[Number, Number]:
    """The image-plane point of a pixel's upper left corner, whatever the scene asks for."""
    return camera.plane_point(i, j, width, height, (0.0, 0.0))


def at_centre(
    i: Number, j: Number, width: Number, height: Number, sample: tuple[Number, Number]
) -> tuple[Number, Number]:
    """The image-plane point of a pixel's centre, whatever the scene asks for."""
    return camera.plane_point(i, j, width, height, (0.5, 0.5))


def outward_normal(n: Vec, leaving: Condition) -> Vec:
    """The outward normal, from inside too: only the outer side is lit."""
    return select_vec(leaving, -n, n)


def phong_lobe(i: Vec, n: Vec, v: Vec, s: Number, mirrored: Vec) -> Number:
    """(r∘(-v))^s without asking whether the light is in front of the surface."""
    return power(clamp0(-dot(mirrored, v)), s)


def blinn_lobe(i: Vec, n: Vec, v: Vec, s: Number, mirrored: Vec) -> Number:
    """(n∘h)^s with h halfway between the light and the eye.

    Blinn, Models of Light Reflection for Computer Synthesized Pictures, SIGGRAPH 1977.
    """
    return power(clamp0(dot(n, unit(i - v))), s)


def in_front(lobe: Callable[..., Number]) -> Callable[..., Number]:
    """The lobe, 0 where the light is behind the surface."""

    def gloss(i: Vec, n: Vec, v: Vec, s: Number, mirrored: Vec) -> Number:
        return select(less(0.0, dot(i, n)), lobe(i, n, v, s, mirrored), 0.0)

    return gloss


def lambert_over_pi(i: Vec, n: Vec) -> Number:
    """max(i∘n, 0)/π: the radiance of a white diffuse surface under unit irradiance."""
    return over_pi(clamp0(dot(i, n)))


def specular_share(colour: Vec, factor: Number, diffuse: Vec, cosine: Number, specular: Vec, gloss: Number) -> Vec:
    """A hidden light still makes its highlight: only the diffuse term asks for shadows."""
    share: Vec = (colour * factor) * (specular * gloss)
    return share


def no_ambient(ambient: Vec) -> Vec:
    """The sum over the lights begins with black; each light adds its ambient share."""
    return ambient * 0.0


def add_light_and_ambient(total: Vec, share: Vec, ambient: Vec, colour: Vec) -> Vec:
    """One more light, with its share of the ambient term: ambient · colour, in shadow too."""
    return (total + ambient * colour) + share


def opaque_blocks(distance: Number, light_distance: Number, opaque: Condition) -> Condition:
    """Only opaque surfaces cast shadows."""
    return less(distance, light_distance) & opaque


def lerp(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    """local·(1 - reflect - transmit) + reflect·reflected + transmit·transmitted, channel by channel."""
    own = Vec(*(1.0 - r - t for r, t in zip(reflect, transmit, strict=True)))
    return (local * own + reflect * reflected) + transmit * transmitted


def clamped(colour: Vec) -> Vec:
    """Each generation's colour cut at 1."""
    return Vec(*(select(less(1.0, part), 1.0, part) for part in colour))


def schlick(v: Vec, n: Vec, leaving: Condition, index: Number) -> Number:
    """F0 + (1 - F0)(1 - cosθ)^5 with θ the angle on the thinner side, F0 = ((1 - n)/(1 + n))².

    Schlick, An Inexpensive BRDF Model for Physically-based Rendering, Eurographics 1994.
    1 under total internal reflection.
    """
    c1 = -dot(v, n)
    p = n * c1 + v
    s = select_vec(leaving, p * index, p / index)
    sin2 = dot(s, s)
    c2 = sqrt0(1.0 - sin2)
    denser = less(1.0, index)
    outside = select(leaving, c2, c1)
    inside = select(leaving, c1, c2)
    m = clamp0(1.0 - select(denser, outside, inside))
    root = (1.0 - index) / (1.0 + index)
    F0 = root * root
    F = F0 + (1.0 - F0) * power(m, 5)
    return select(at_least(sin2, 1.0), 1.0, F)


def on_glass(transmit: Vec, F: Number) -> Number:
    """F on transparent surfaces, 1 on others: a mirror that is no dielectric keeps its weight."""
    glass = less(0.0, transmit.x) | less(0.0, transmit.y) | less(0.0, transmit.z)
    return select(glass, F, 1.0)


def total_reflects(weights: Callable[..., tuple[Vec, Vec]]) -> Callable[..., tuple[Vec, Vec]]:
    """Under total reflection the mirrored ray carries the weight of the refracted one too."""

    def moved(
        reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Callable[[], Number]
    ) -> tuple[Vec, Vec]:
        kept, passed = weights(reflect, transmit, total, asked, share)
        return select_vec(total, reflect + transmit, kept), cut(total, passed)

    return moved
