"""Faults of refraction."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracles.faults.fault import maker
from reference_tracer.formulas import optics
from reference_tracer.methods import REFRACT
from reference_tracer.numbers import Condition, at_least, less, select, sqrt0
from reference_tracer.vector import Vec, dot, select_vec, unit

Bent = tuple[Vec, Condition]


def _bent(v: Vec, n: Vec, s: Vec) -> Bent:
    sin2 = dot(s, s)
    return unit(s - n * sqrt0(1.0 - sin2)), at_least(sin2, 1.0)


def _across(v: Vec, n: Vec) -> Vec:
    found: Vec = n * -dot(v, n) + v
    return found


def _never_inverted(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    return _bent(v, n, _across(v, n) / index)


def _always_inverted(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    return optics.refract(v, n, ~leaving, index)


def _upward(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    s = select_vec(leaving, _across(v, n) * index, _across(v, n) / index)
    sin2 = dot(s, s)
    return unit(s + n * sqrt0(1.0 - sin2)), at_least(sin2, 1.0)


def _outward(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    return optics.refract(v, select_vec(leaving, -n, n), leaving, index)


def _never_total(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    t, total = optics.refract(v, n, leaving, index)
    return t, total & ~total


def _straight_on(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    t, total = optics.refract(v, n, leaving, index)
    return select_vec(total, v, t), total & ~total


def _entering_only(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    t, total = optics.refract(v, n, leaving, index)
    return select_vec(leaving, v, t), total & ~leaving


def _p_not_unit(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    p = _across(v, n)
    s1 = sqrt0(dot(p, p))
    s2 = select(leaving, s1 * index, s1 / index)
    return unit(p * s2 - n * sqrt0(1.0 - s2 * s2)), at_least(s2, 1.0)


def _sine_for_its_square(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    s = select_vec(leaving, _across(v, n) * index, _across(v, n) / index)
    sin = sqrt0(dot(s, s))
    return unit(s - n * sqrt0(1.0 - sin)), at_least(sin, 1.0)


def _angles_for_sines(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    p = _across(v, n)
    s1 = sqrt0(dot(p, p))
    angle = np.arcsin(np.minimum(s1, 1.0))
    bent = select(leaving, angle * index, angle / index)
    t = unit(p) * np.sin(bent) - n * np.cos(bent)
    return t, at_least(bent, np.pi / 2)


def _total_on_entering(v: Vec, n: Vec, leaving: Any, index: Any) -> Bent:
    t, total = optics.refract(v, n, leaving, index)
    p = _across(v, n) * index
    return t, total | at_least(dot(p, p), 1.0)


_BEND = "Refraction Vector Calculation"
_CODE = "Get Refraction Vector"

_RATIO = "s2 = leaving ? s1*index : s1/index;"

_T = "t = p_u*s2 - n*sqrt(1 - s2*s2);"


_glass = maker("glass")

FAULTS = (
    _glass(
        "ratio-not-inverted-on-leaving",
        _CODE,
        "s2 = s1/geo.tr;",
        _RATIO,
        "the ray bends the wrong way out of glass",
        "out of the glass the ratio is the inverse: the slide's code forgets it",
        refract=_never_inverted,
    ),
    _glass(
        "ratio-inverted",
        "Refraction",
        "s2 = leaving ? s1/index : s1*index;",
        _RATIO,
        "glass behaves as a bubble does",
        "n1 sinθ1 = n2 sinθ2",
        refract=_always_inverted,
    ),
    _glass(
        "not-bent",
        "Refraction",
        "t = v;",
        _T,
        "glass is clear as air",
        "Snell's law",
        refract=lambda v, n, leaving, index: (v, less(v.x, v.x)),
    ),
    _glass(
        "bent-back",
        _BEND,
        "t = p_u*s2 + n*sqrt(1 - s2*s2);",
        _T,
        "the ray comes back from the surface",
        "minus: t goes through the surface",
        refract=_upward,
    ),
    _glass(
        "normal-not-turned-on-leaving",
        _CODE,
        "t = refract(v, n, index);",
        "if (leaving) n = -n;",
        "light turns back inside glass",
        "turn the normal where v∘n > 0",
        refract=_outward,
    ),
    _glass(
        "total-reflection-left-out",
        _CODE,
        "t = ...;  // whatever s2",
        "if (s2 >= 1) return 0;",
        "a bright rim on bubbles",
        "beyond the critical angle nothing is refracted",
        refract=_never_total,
    ),
    _glass(
        "straight-on-beyond-the-critical-angle",
        _CODE,
        "if (s2 >= 1) t = v;",
        "if (s2 >= 1) return 0;",
        "a clear rim on bubbles",
        "no light passes there",
        refract=_straight_on,
    ),
    _glass(
        "bent-on-entering-only",
        _CODE,
        "if (leaving) t = v;",
        _RATIO,
        "glass balls invert nothing",
        "the ray bends on leaving too",
        refract=_entering_only,
    ),
    _glass(
        "total-reflection-on-entering",
        _CODE,
        "if (s1*index >= 1) return 0;  // entering too",
        "if (s2 >= 1) return 0;",
        "a black rim on glass seen from outside",
        "into the denser medium there is always a refracted ray: test sinθ2",
        refract=_total_on_entering,
    ),
    _glass(
        "index-squared",
        "Refraction",
        "s2 = leaving ? s1*eps : s1/eps;  // eps = index*index",
        _RATIO,
        "glass bends too much",
        "Snell's law has the index, not the permittivity",
        refract=lambda v, n, leaving, index: optics.refract(v, n, leaving, index * index),
    ),
    _glass(
        "p-not-unit",
        _BEND,
        "t = p*s2 - n*sqrt(1 - s2*s2);",
        _T,
        "images in glass are displaced, most near the middle",
        "divide p by its length",
        refract=_p_not_unit,
    ),
    _glass(
        "sine-for-its-square",
        _BEND,
        "c2 = sqrt(1 - s2);",
        "c2 = sqrt(1 - s2*s2);",
        "glass bends too much",
        "cosθ2 = sqrt(1 - sin²θ2)",
        refract=_sine_for_its_square,
    ),
    _glass(
        "angles-for-sines",
        "Refraction",
        "θ2 = θ1/index;",
        "θ2 = asin(sin(θ1)/index);",
        "right near the middle, wrong toward the rim",
        "the sines are proportional, not the angles",
        refract=_angles_for_sines,
    ),
    _glass(
        "index-fixed",
        _CODE,
        "index = 1.5;",
        "index = material.index;",
        "water and bubbles bend as glass does",
        "the material's index",
        refract=lambda v, n, leaving, index: optics.refract(v, n, leaving, index * 0.0 + 1.5),
    ),
    _glass(
        "zero-over-zero",
        _BEND,
        "p_u = p/|p|;",
        "t = p*(s2/s1) - n*c2;  // s2/s1 is the ratio",
        "a speck where the ray meets glass straight on",
        "at normal incidence p = 0: use the ratio, not the sines",
        refract=REFRACT["slide"].refract,
    ),
)
