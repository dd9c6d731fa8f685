"""Faults of highlights and of mirror directions."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracles.faults.fault import maker
from reference_tracer.formulas import optics, shading
from reference_tracer.numbers import Number, clamp0, less, power, select
from reference_tracer.vector import Vec, dot, unit


def _even_power(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Number:
    x = -dot(mirrored, v)
    size = power(select(less(x, 0.0), -x, x), s)
    signed = select(less(x, 0.0) & (s & 1 == 1), -size, size)
    return select(less(0.0, dot(i, n)), signed, 0.0)


def _flat(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Number:
    return select(less(0.0, dot(i, n)), 1.0, 0.0 * i.x)


def _two_n(i: Vec, n: Vec) -> Vec:
    return unit(n * 2.0 - i)


def _by_components(i: Vec, n: Vec) -> Vec:
    found: Vec = n * (i * n) * 2.0 - i
    return found


def _copied_line(i: Vec, n: Vec) -> Vec:
    r = optics.reflect(i, n)
    return Vec(r.x, r.y, n.y * (2.0 * dot(i, n)) - i.z)


def _schlick(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Number:
    x = shading.phong(i, n, v, s * 0 + 1, mirrored)
    return x / (s - s * x + x)


_PHONG = "Phong Effect"
_RESULT = "Phong's effect Result"
_MIRROR = "Mirror with No Transparency"
_MATH = "Math of Reflection Vector"

_S = "gloss = pow(max(dot(r, -v), 0), s);"
_R = "r = 2*dot(i, n)*n - i;"


_phong = maker("highlight")
_mirror = maker("mirror")

FAULTS = (
    _phong(
        "even-power-of-a-negative",
        _PHONG,
        "gloss = pow(dot(r, -v), s);",
        _S,
        "a second highlight opposite to the first",
        "an even power of a negative number is positive: clamp first",
        phong=_even_power,
    ),
    _phong(
        "exponent-plus-1",
        _RESULT,
        "for (k = 0; k <= s; k++) gloss *= x;",
        _S,
        "highlights are a little too small",
        "s factors, not s + 1",
        phong=lambda i, n, v, s, r: shading.phong(i, n, v, s + 1, r),
    ),
    _phong(
        "exponent-fixed",
        _RESULT,
        "gloss = pow(x, 20);",
        _S,
        "all highlights have one size",
        "the material's shininess",
        phong=lambda i, n, v, s, r: shading.phong(i, n, v, s * 0 + 20, r),
    ),
    _phong(
        "highlight-times-cosine",
        _RESULT,
        "c = light*(diffuse + specular*gloss)*cosθ;",
        "c = light*(diffuse*cosθ + specular*gloss);",
        "highlights fade toward the terminator",
        "the cosine belongs to the diffuse term",
        phong=lambda i, n, v, s, r: shading.phong(i, n, v, s, r) * clamp0(dot(i, n)),
    ),
    _phong(
        "view-with-the-wrong-sign",
        _PHONG,
        "gloss = pow(max(dot(r, v), 0), s);",
        _S,
        "no highlights, or on the far side",
        "the slide's v points to the eye: minus the ray",
        phong=lambda i, n, v, s, r: shading.phong(i, n, -v, s, r),
    ),
    _phong(
        "specular-is-a-constant",
        "uRT-10-RT5-Colors-Ambient_diffuse",
        "c = ambient + diffuse*cosθ + specular;",
        _S,
        "everything lit is washed out",
        "specular times (r∘(-v))^s",
        phong=_flat,
    ),
    _phong(
        "no-highlight",
        _RESULT,
        "c = ambient + diffuse*cosθ;",
        _S,
        "no highlights",
        "add specular*gloss",
        phong=lambda i, n, v, s, r: i.x * 0.0,
    ),
    _phong(
        "highlight-normalised",
        _RESULT,
        "gloss = (s + 2)/(2π)*pow(x, s);",
        _S,
        "highlights are too bright",
        "the lecture's lobe has no factor",
        phong=lambda i, n, v, s, r: (
            shading.phong(i, n, v, s, r) * ((s + 2) * np.float32(0.5 / np.pi)).astype(i.x.dtype)
        ),
    ),
    _phong(
        "normal-for-the-mirror-direction",
        _PHONG,
        "gloss = pow(max(dot(n, -v), 0), s);",
        _S,
        "highlights stand where the eye looks straight on",
        "r, not n",
        phong=lambda i, n, v, s, r: shading.phong(i, n, v, s, n),
    ),
    _phong(
        "light-mirrored-by-2n-minus-i",
        _MATH,
        "r = unit(2*n - l);",
        _R,
        "highlights are too large and displaced",
        "2n - i is right for i = n only",
        reflect=_two_n,
    ),
    _phong(
        "mirror-direction-reversed",
        _MATH,
        "r = i - 2*dot(i, n)*n;",
        _R,
        "no highlights",
        "with i away from the surface the signs turn",
        reflect=lambda i, n: -optics.reflect(i, n),
    ),
    _phong(
        "light-mirrored-by-components",
        _MATH,
        "r = 2*(i*n)*n - i;  // i*n by components",
        _R,
        "highlights are displaced and of odd shapes",
        "i∘n is one number: the sum of the three products",
        reflect=_by_components,
    ),
    _phong(
        "light-mirrored-with-a-copied-line",
        _MATH,
        "r.z = 2*d*n.y - i.z;",
        "r.z = 2*d*n.z - i.z;",
        "highlights are displaced to one side",
        "a line copied for the next component",
        reflect=_copied_line,
    ),
    _phong(
        "highlight-seen-from-the-camera",
        _PHONG,
        "view = unit(camera - p);  // in every generation",
        "view = -v;  // of the ray that came here",
        "highlights in mirrors stand in the wrong places",
        "in a mirror the ray comes from the mirror, not from the camera",
        view_vector=lambda v, p, eye: unit(p - eye),
    ),
    _phong(
        "gloss-by-schlick",
        _RESULT,
        "gloss = x/(s - s*x + x);",
        _S,
        "highlights have wide tails",
        "that is Schlick's cheap stand-in for the power (Graphics Gems IV, 1994), not the power",
        phong=_schlick,
    ),
    _mirror(
        "mirrored-by-components",
        _MATH,
        "r = 2*(i*n)*n - i;  // i*n by components",
        _R,
        "mirror images are torn",
        "i∘n is one number: the sum of the three products",
        mirror=_by_components,
    ),
    _mirror(
        "mirrored-by-2n-minus-i",
        _MATH,
        "r = unit(2*n - i);",
        _R,
        "mirror images are distorted",
        "2n - i is right for i = n only",
        mirror=_two_n,
    ),
    _mirror(
        "mirrored-ray-enters",
        _MIRROR,
        "r = reflect(v, n);",
        "r = reflect(-v, n);",
        "mirrors show what is behind them",
        "the formula's i points away from the surface; the ray points to it",
        mirror=lambda i, n: -optics.reflect(i, n),
    ),
    _mirror(
        "factor-2-left-out",
        _MATH,
        "r = unit(dot(i, n)*n - i);",
        _R,
        "mirrors show what lies along them",
        "2(i∘n)n - i",
        mirror=lambda i, n: unit(n * dot(i, n) - i),
    ),
    _mirror(
        "mirrored-straight-back",
        _MIRROR,
        "r = i;",
        _R,
        "mirrors show the eye's side only",
        "r = 2(i∘n)n - i",
        mirror=lambda i, n: i,
    ),
    _mirror(
        "mirrored-along-the-normal",
        _MIRROR,
        "r = n;",
        _R,
        "mirrors show one point blown up",
        "r = 2(i∘n)n - i",
        mirror=lambda i, n: n,
    ),
)
