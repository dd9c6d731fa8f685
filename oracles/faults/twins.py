"""Twins: correct tracers that differ from the reference, which nothing may fail."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.faults.fault import Twin, instead
from oracles.faults.files import linear
from oracles.images import Picture
from reference_tracer.formulas import optics, plane, sphere
from reference_tracer.formulas.display import encode
from reference_tracer.methods import REFRACT, SPHERE
from reference_tracer.numbers import Condition, Number, at_least, clamp0, less, power, select, sqrt0
from reference_tracer.vector import Vec, dot, select_vec, unit
from scenes.model import Scene


def _view_mirrored(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Number:
    gloss = power(clamp0(dot(i, optics.reflect(-v, n))), s)
    return select(less(0.0, dot(i, n)), gloss, 0.0)


def _two_b(b: Vec, bv: Any, v: Vec, r: Any) -> tuple[Number, Number, Number]:
    B, C = 2.0 * bv, dot(b, b) - r * r
    D = B * B - 4.0 * C
    return 0.5 * (-B - sqrt0(D)), 0.5 * (-B + sqrt0(D)), D


def _folded(i: Vec, n: Vec) -> Vec:
    found: Vec = -(i - n * dot(i, n) - n * dot(i, n))
    return found


def _at_minus_n(i: Vec, n: Vec) -> Vec:
    return optics.reflect(i, -n)


def _as_it_comes(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Condition]:
    p = n * -dot(v, n) + v
    s = select_vec(leaving, p * index, p / index)
    sin2 = dot(s, s)
    return s - n * sqrt0(1.0 - sin2), at_least(sin2, 1.0)


def _weighed_first(colour: Vec, factor: Any, diffuse: Vec, cosine: Any, specular: Vec, gloss: Any) -> Vec:
    light = colour * factor
    share: Vec = diffuse * light * cosine + specular * light * gloss
    return share


def _mixed_backwards(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    return (transmitted * transmit + reflected * reflect) + local


def _inverse_first(distance: Any, inverse: Any, square: Any) -> Number:
    one = 1.0 / select(less(0.0, distance), distance, 1.0)
    return select(square, one * one, select(inverse, one, 1.0))


def _from(least: float) -> dict[str, Any]:
    """Both hits by a tracer that looks for roots beyond this distance only."""

    def ball(distances: Any, o: Vec, v: Vec, c: Vec, r: Any, here: Any, start: Any) -> tuple[Number, Condition]:
        return sphere.sphere_hit(distances, o, v, c, r, here, start + least)

    def flat(o: Vec, v: Vec, n: Vec, d: Any, elsewhere: Any, start: Any, again: Any = plane.NEVER) -> Any:
        return plane.plane_hit(o, v, n, d, elsewhere, start + least, again)

    return {"sphere_hit": ball, "plane_hit": flat}


def _half_file(pixels: NDArray[Any], scene: Scene) -> Picture:
    return linear(pixels.astype(np.float16), 2.0**-11)


def _codes(pixels: NDArray[Any], scene: Scene) -> Picture:
    return Picture(encode(pixels, scene.display).astype(np.float64), 255)


def _backwards(scene: Scene) -> Scene:
    return scene.model_copy(update={"objects": scene.objects[::-1]})


def _lights_backwards(scene: Scene) -> Scene:
    return scene.model_copy(update={"lights": scene.lights[::-1]})


TWINS = (
    Twin("float32", "the reference on float32 lanes"),
    Twin("float64", "the reference on float64 lanes, judged as float32", precision=64),
    *(Twin(f"sphere-{name}", f"roots by the method {name!r}", SPHERE[name]) for name in SPHERE if name != "lecture"),
    Twin("roots-with-2b", "roots by a, 2b and 4ac", instead("roots-with-2b", sphere_distances=_two_b)),
    Twin("refract-vector", "refraction by ηv + (η cosθ1 - cosθ2)n", REFRACT["vector"]),
    Twin(
        "view-mirrored",
        "the highlight by the mirrored view: i∘r_v = r_i∘(-v)",
        instead("view-mirrored", phong=_view_mirrored),
    ),
    Twin("reflect-folded", "reflection in two halves", instead("reflect-folded", reflect=_folded, mirror=_folded)),
    Twin("weighed-first", "the light multiplied into each term", instead("weighed-first", direct_light=_weighed_first)),
    Twin("mixed-backwards", "the branches added in the other order", instead("mixed-backwards", mix=_mixed_backwards)),
    Twin("inverse-first", "1/d formed first, then squared", instead("inverse-first", attenuation=_inverse_first)),
    Twin("mirrored-at-minus-n", "reflection at the other normal", instead("mirrored-at-minus-n", mirror=_at_minus_n)),
    Twin(
        "refracted-as-it-comes",
        "a refracted ray not made unit: s - cosθ2 n has length 1",
        instead("refracted-as-it-comes", refract=_as_it_comes),
    ),
    Twin(
        "unit-again",
        "reflected rays made unit again",
        instead("unit-again", mirror=lambda i, n: unit(optics.reflect(i, n))),
    ),
    Twin("least-distance-1e-4", "no hit before 1e-4", instead("least-distance-1e-4", **_from(1e-4))),
    Twin(
        "least-distance-2e-3",
        "no hit before 0.002, as a float32 tracer with one least distance for all scenes needs it",
        instead("least-distance-2e-3", **_from(2e-3)),
    ),
    Twin("half-float-file", "written as half floats", picture=_half_file),
    Twin("byte-file", "written as 8-bit codes", picture=_codes),
    Twin("objects-backwards", "objects in the other order", scene=_backwards),
    Twin("lights-backwards", "lights in the other order", scene=_lights_backwards),
)
"""Rulebooks, files and orders that no law settles."""
