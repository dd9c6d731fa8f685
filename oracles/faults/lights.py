"""Faults of lights: direction, distance, cosine."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas import shading
from reference_tracer.numbers import Number, clamp0, less, select
from reference_tracer.vector import Vec, dot, length, select_vec, unit


def _not_unit(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    _, distance = shading.light_vector(k, p, is_point)
    return select_vec(is_point, k - p, k), distance


def _reversed(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    i, distance = shading.light_vector(k, p, is_point)
    return -i, distance


def _all_points(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    return unit(k - p), length(k - p)


def _all_directions(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    _, distance = shading.light_vector(k, p, is_point)
    return unit(select_vec(is_point, k, k)), distance + 0.0 * p.x


def _sun_reversed(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    i, distance = shading.light_vector(k, p, is_point)
    return select_vec(is_point, i, -i), distance


def _squared_distance(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    i, distance = shading.light_vector(k, p, is_point)
    return i, distance * distance


def _from_the_origin(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    i, distance = shading.light_vector(k, p, is_point)
    return i, select(is_point, length(k) + 0.0 * p.x, distance)


def _never(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(distance, inverse & ~inverse, square & ~square)


def _inverse_for_square(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(distance, inverse | square, square & ~square)


def _square_for_inverse(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(distance, inverse & ~inverse, inverse | square)


def _unasked(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(distance, ~square & less(distance, np.inf), square)


def _at_most_one(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(select(less(distance, 1.0), 1.0, distance), inverse, square)


def _one_plus(distance: Any, inverse: Any, square: Any) -> Number:
    return shading.attenuation(distance + 1.0, inverse, square)


def _over_sphere(distance: Any, inverse: Any, square: Any) -> Number:
    factor = shading.attenuation(distance, inverse, square)
    return select(square, factor * (0.25 / np.pi), factor)


def _over_square(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    w = select_vec(is_point, k - p, k)
    return w / dot(w, w), shading.light_vector(k, p, is_point)[1]


def _absolute(i: Vec, n: Vec) -> Number:
    cosine = dot(i, n)
    return select(less(cosine, 0.0), -cosine, cosine)


def _flat(i: Vec, n: Vec) -> Number:
    return select(less(0.0, dot(i, n)), 1.0, 0.0 * i.x)


_POSITION = "Light Position"
_LAMBERT = "Lambertian Reflection Model"
_FEATURES = "Ray Tracing has three features"

_EXAMPLE = "Example of Ray Tracing"
_DISTANCE = "How to Calculate the Distance to Point Lights"
_AMBIENT = "uRT-10-RT5-Colors-Ambient_diffuse"

_BAD = "Ex) Bad and Good Case"
_RESULT = "Phong's effect Result"

_I = "i = unit(k - p);"
_COS = "cosθ = max(dot(i, n), 0);"

_SUM = "c = c + α*light*(diffuse*cosθ + specular*gloss);"

_ALPHA = "α = kind == inverse ? 1/d : kind == inverse_square ? 1/(d*d) : 1;"


def _light(name: str, slide: str, wrong: str, right: str, seen: str, mend: str, **entries: Any) -> Fault:
    return Fault(name, "light", f'L11 "{slide}"', wrong, right, seen, mend, instead(name, **entries))


FAULTS = (
    _light(
        "light-vector-not-unit",
        _DISTANCE,
        "i = k - p;",
        _I,
        "light grows with the distance of the lamp",
        "the slide leaves `unit` out: divide by |k - p|",
        light_vector=_not_unit,
    ),
    _light(
        "light-vector-reversed",
        _DISTANCE,
        "i = unit(p - k);",
        _I,
        "the wrong sides are lit",
        "from the surface to the light",
        light_vector=_reversed,
    ),
    _light(
        "sun-as-a-lamp",
        _POSITION,
        "i = unit(k - p);  // directional too",
        "i = unit(toward);",
        "the light of the sun changes from place to place",
        "a directional light has no place",
        light_vector=_all_points,
    ),
    _light(
        "lamp-as-a-sun",
        _POSITION,
        "i = unit(k);  // point light too",
        _I,
        "light is the same everywhere",
        "a point light has a place: subtract p",
        light_vector=_all_directions,
    ),
    _light(
        "sun-reversed",
        _POSITION,
        "i = -unit(toward);",
        "i = unit(toward);",
        "the sun shines from below",
        "`toward` points to the light already",
        light_vector=_sun_reversed,
    ),
    _light(
        "distance-not-rooted",
        _DISTANCE,
        "d = dot(k - p, k - p);",
        "d = sqrt(dot(k - p, k - p));",
        "light falls too fast, or shadows are cast by what is behind the lamp",
        "take the root",
        light_vector=_squared_distance,
    ),
    _light(
        "distance-from-the-origin",
        _DISTANCE,
        "d = |k|;",
        "d = |k - p|;",
        "attenuation is the same everywhere",
        "from p to the lamp",
        light_vector=_from_the_origin,
    ),
    _light(
        "no-attenuation",
        _FEATURES,
        "α = 1;",
        _ALPHA,
        "far things are too bright",
        "the scene says how each light fades",
        attenuation=_never,
    ),
    _light(
        "inverse-for-square",
        _FEATURES,
        "α = 1/d;  // inverse_square",
        _ALPHA,
        "light fades too slowly",
        "1/d² where the scene asks for it",
        attenuation=_inverse_for_square,
    ),
    _light(
        "square-for-inverse",
        _FEATURES,
        "α = 1/(d*d);  // inverse",
        _ALPHA,
        "light fades too fast",
        "1/d where the scene asks for it",
        attenuation=_square_for_inverse,
    ),
    _light(
        "attenuation-unasked",
        _POSITION,
        "α = 1/d;  // always",
        _ALPHA,
        "lamps without attenuation fade",
        "the scene may ask for none",
        attenuation=_unasked,
    ),
    _light(
        "attenuation-at-most-1",
        _POSITION,
        "α = 1/max(d, 1);",
        _ALPHA,
        "too dark within one unit of a lamp",
        "1/d above 1 is right near a lamp",
        attenuation=_at_most_one,
    ),
    _light(
        "attenuation-one-plus-d",
        _POSITION,
        "α = 1/(1 + d);",
        _ALPHA,
        "too dark near a lamp",
        "there is no 1 in the scene's formula",
        attenuation=_one_plus,
    ),
    _light(
        "attenuation-over-4-pi",
        _FEATURES,
        "α = 1/(4*π*d*d);",
        _ALPHA,
        "lamps that fade with the square are 12 times too dark",
        "the light's colour is what arrives at distance 1, not the lamp's power",
        attenuation=_over_sphere,
    ),
    _light(
        "light-vector-over-its-square",
        _DISTANCE,
        "i = (k - p)/dot(k - p, k - p);",
        _I,
        "light fades although the scene asks for none",
        "divide by the length, the root of the dot product",
        light_vector=_over_square,
    ),
    _light(
        "cosine-not-clamped",
        _BAD,
        "cosθ = dot(i, n);",
        _COS,
        "light from behind takes light away",
        "max(..., 0)",
        lambert=dot,
    ),
    _light(
        "cosine-absolute",
        _LAMBERT,
        "cosθ = fabs(dot(i, n));",
        _COS,
        "the dark side is lit",
        "light behind the surface gives nothing",
        lambert=_absolute,
    ),
    _light(
        "cosine-without-z",
        _LAMBERT,
        "cosθ = max(i.x*n.x + i.y*n.y, 0);",
        _COS,
        "what faces the eye is dark",
        "the inner product of three dimensions has three terms",
        lambert=lambda i, n: clamp0(i.x * n.x + i.y * n.y),
    ),
    _light(
        "cosine-half",
        _LAMBERT,
        "cosθ = (dot(i, n) + 1)/2;",
        _COS,
        "soft, too bright shading",
        "Lambert's law has no half",
        lambert=lambda i, n: clamp0((dot(i, n) + 1.0) * 0.5),
    ),
    _light(
        "cosine-squared",
        _LAMBERT,
        "c = diffuse*cosθ*cosθ;",
        _SUM,
        "too dark toward the terminator",
        "the cosine enters once",
        lambert=lambda i, n: clamp0(dot(i, n)) * clamp0(dot(i, n)),
    ),
    _light(
        "cosine-left-out",
        _LAMBERT,
        "c = diffuse;  // if lit",
        _SUM,
        "balls look like discs",
        "diffuse times cosθ",
        lambert=_flat,
    ),
)
