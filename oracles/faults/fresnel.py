"""Faults of Fresnel's share."""

from __future__ import annotations

from typing import Any

from oracles.faults.fault import maker
from reference_tracer import rulebook
from reference_tracer.formulas import optics
from reference_tracer.numbers import Condition, Number, less, power, select, sqrt0
from reference_tracer.vector import Vec, dot, select_vec


def _across(v: Vec, n: Vec) -> Vec:
    found: Vec = n * -dot(v, n) + v
    return found


def _shares(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Number, Number]:
    """Fresnel's amplitudes across and along the plane of incidence, by the formulas of optics.fresnel."""
    c1, p = -dot(v, n), _across(v, n)
    s = select_vec(leaving, p * index, p / index)
    c2 = sqrt0(1.0 - dot(s, s))
    n1, n2 = select(leaving, index, 1.0), select(leaving, 1.0, index)
    across, along = n1 * c1 + n2 * c2, n2 * c1 + n1 * c2
    return (n1 * c1 - n2 * c2) / across, (n2 * c1 - n1 * c2) / along


def _s_only(v: Vec, n: Vec, leaving: Any, index: Any) -> Number:
    r_s, _ = _shares(v, n, leaving, index)
    return r_s * r_s


def _not_squared(v: Vec, n: Vec, leaving: Any, index: Any) -> Number:
    return 0.5 * sum(select(less(r, 0.0), -r, r) for r in _shares(v, n, leaving, index))


def _no_total_case(v: Vec, n: Vec, leaving: Any, index: Any) -> Number:
    r_s, r_p = _shares(v, n, leaving, index)
    return 0.5 * (r_s * r_s + r_p * r_p)


def _straight_on(v: Vec, n: Vec, leaving: Any, index: Any) -> Number:
    r = (index - 1.0) / (index + 1.0)
    return r * r + 0.0 * v.x


def _schlick_of_the_root(v: Vec, n: Vec, leaving: Any, index: Any) -> Number:
    r = (index - 1.0) / (index + 1.0)
    first = select(less(r, 0.0), -r, r)
    _, total = optics.refract(v, n, leaving, index)
    return select(total, 1.0, first + (1.0 - first) * power(1.0 + dot(v, n), 5))


def _white(weight: Vec) -> Vec:
    return Vec(*(select(less(0.0, part), 1.0, 0.0) for part in weight))


def _weighed(kept: Any) -> Any:
    """`weights` with kept(reflect, transmit, total, F) for the two weights where the scene asks for Fresnel's share."""

    def weights(reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Any) -> tuple[Vec, Vec]:
        if not asked:
            return rulebook.weights(reflect, transmit, total, False, share)
        reflect, transmit = kept(reflect, transmit, share())
        return reflect, transmit

    return weights


_TR = "Refraction with geo.tr vector"

_F = "F = (r_s*r_s + r_p*r_p)/2;"

_BORN = "Born & Wolf, Principles of Optics, 1.5.2"
_SCHLICK = "Schlick, An Inexpensive BRDF Model for Physically-based Rendering, 1994"


_glass = maker("glass", _BORN, _SCHLICK)

FAULTS = (
    _glass(
        "fresnel-left-out",
        _TR,
        "keep = reflect; pass = transmit;",
        "keep = reflect*F; pass = transmit*(1 - F);",
        "glass has no bright rim",
        "where the scene asks, weigh by F and 1 - F",
        weights=_weighed(lambda r, t, F: (r, t)),
    ),
    _glass(
        "fresnel-swapped",
        _BORN,
        "keep = reflect*(1 - F); pass = transmit*F;",
        "keep = reflect*F; pass = transmit*(1 - F);",
        "glass is a mirror straight on",
        "F is what is reflected",
        weights=_weighed(lambda r, t, F: (r * (1.0 - F), t * F)),
    ),
    _glass(
        "fresnel-for-the-weights",
        _BORN,
        "keep = F; pass = 1 - F;",
        "keep = reflect*F; pass = transmit*(1 - F);",
        "clear where the glass should be tinted",
        "F multiplies the material's weights",
        weights=_weighed(lambda r, t, F: (_white(r) * F, _white(t) * (1.0 - F))),
    ),
    _glass(
        "fresnel-on-the-mirror-only",
        _BORN,
        "keep = reflect*F; pass = transmit;",
        "keep = reflect*F; pass = transmit*(1 - F);",
        "more light than came",
        "what is reflected does not pass",
        weights=_weighed(lambda r, t, F: (r * F, t)),
    ),
    _glass(
        "fresnel-of-one-polarisation",
        _BORN,
        "F = r_s*r_s;",
        _F,
        "rims are too bright",
        "the mean of both",
        fresnel=_s_only,
    ),
    _glass(
        "fresnel-not-squared",
        _BORN,
        "F = (fabs(r_s) + fabs(r_p))/2;",
        _F,
        "glass reflects far too much",
        "light goes with the square of the amplitude",
        fresnel=_not_squared,
    ),
    _glass(
        "fresnel-index-not-inverted",
        _BORN,
        "F = fresnel(index);  // leaving too",
        "F = fresnel(1/index);  // leaving",
        "wrong brightness where light leaves glass",
        "invert on leaving, as in Snell's law",
        fresnel=lambda v, n, leaving, index: optics.fresnel(v, n, leaving & ~leaving, index),
    ),
    _glass(
        "fresnel-straight-on-everywhere",
        _BORN,
        "F = pow((index - 1)/(index + 1), 2);",
        _F,
        "glass has no bright rim",
        "that is F at normal incidence only",
        fresnel=_straight_on,
    ),
    _glass(
        "schlick-of-the-root",
        _SCHLICK,
        "F0 = fabs(index - 1)/(index + 1); F = F0 + (1 - F0)*pow(1 - cosθ, 5);",
        _F,
        "glass reflects far too much",
        "F0 is the square of that; and the scene asks for Fresnel's own formula",
        fresnel=_schlick_of_the_root,
    ),
    _glass(
        "fresnel-without-total-reflection",
        _BORN,
        "F = (r_s*r_s + r_p*r_p)/2;  // no case sinθ2 >= 1",
        _F,
        "nothing",
        "none needed",
        "equivalent",
        "Where sin²θ2 >= 1, sqrt0 makes cosθ2 = 0; then r_s = n1 c1/(n1 c1) = 1 = r_p, so F = 1: the case left out.",
        fresnel=_no_total_case,
    ),
)
