"""Faults where a ray meets a sphere, and in the order of what it meets."""

from __future__ import annotations

from typing import Any

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas.plane import plane_hit
from reference_tracer.formulas.sphere import sphere_distances, sphere_hit
from reference_tracer.methods.spheres import Roots
from reference_tracer.numbers import Condition, Number, at_least, clamp0, less, select, sqrt0
from reference_tracer.vector import Vec, dot, unit


def _far_root(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, far, D = sphere_distances(b, bv, v, r)
    return far, far, D


def _near_root(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    near, _, D = sphere_distances(b, bv, v, r)
    return near, near, D


def _roots_of(D: Any, bv: Any, scale: float = 1.0) -> Roots:
    root = sqrt0(D)
    return (-bv - root) * scale, (-bv + root) * scale, D


def _size_of_d(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, _, D = sphere_distances(b, bv, v, r)
    return _roots_of(select(less(D, 0.0), -D, D), bv)


def _clamped_d(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, _, D = sphere_distances(b, bv, v, r)
    return _roots_of(clamp0(D), bv)


def _r_for_r2(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    return _roots_of(bv * bv - (dot(b, b) - r), bv)


def _four_ac(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    return _roots_of(bv * bv - 4.0 * (dot(b, b) - r * r), bv)


def _over_two(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, _, D = sphere_distances(b, bv, v, r)
    return _roots_of(D, bv, 0.5)


def _plus_b(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    return sphere_distances(b, -bv, v, r)


def _plus_r2(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    return _roots_of(bv * bv - (dot(b, b) + r * r), bv)


def _no_root(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, _, D = sphere_distances(b, bv, v, r)
    return -bv - D, -bv + D, D


def _diameter(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    return sphere_distances(b, bv, v, 0.5 * r)


def _closest_point(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    _, _, D = sphere_distances(b, bv, v, r)
    return -bv, -bv, D


def _behind(distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any) -> tuple[Number, Condition]:
    b = o - c
    near, _, D = distances(b, dot(b, v), v, r)
    return near, at_least(D, 0.0) & ~starts_here


def _without_sign(
    distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
) -> tuple[Number, Condition]:
    distance, meets = _behind(distances, o, v, c, r, starts_here, start)
    return select(less(distance, 0.0), -distance, distance), meets


def _o_plus_c(distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any) -> tuple[Number, Condition]:
    return sphere_hit(distances, o, v, -c, r, starts_here, start)


def _acne(distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any) -> tuple[Number, Condition]:
    return sphere_hit(distances, o, v, c, r, starts_here & less(r, 0.0), start)


def _into_the_surface(
    distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
) -> tuple[Number, Condition]:
    """The start moved against where the ray goes: inward where it leaves, outward where it enters."""
    outward = dot(v, o - c)
    return _moved(select(less(0.0, outward), -_STEP, _STEP), distances, o, v, c, r, starts_here, start)


def _always_outward(
    distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
) -> tuple[Number, Condition]:
    return _moved(_STEP, distances, o, v, c, r, starts_here, start)


def _moved(
    step: Any, distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
) -> tuple[Number, Condition]:
    """The ball as a ray meets it whose start was moved off it by `step` along the normal; others as they are."""
    along = (o - c) * select(starts_here, step / r, 0.0)
    return sphere_hit(distances, o + along, v, c, r, starts_here & less(r, 0.0), start)


def _plane_into(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Any:
    """A ray that starts on the plane, moved to its other side, meets it at once."""
    root, meets = plane_hit(o, v, normal, offset, elsewhere, start, again)
    slope = dot(unit(normal), v)
    at_once = _STEP / select(less(slope, 0.0), -slope, select(less(0.0, slope), slope, 1.0))
    return select(elsewhere, root, at_once), select(elsewhere, meets, less(0.0, at_once))


def _never_again(
    distances: Any, o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
) -> tuple[Number, Condition]:
    distance, meets = sphere_hit(distances, o, v, c, r, starts_here, start)
    return distance, meets & ~starts_here


def _last_drawn(distance: Any, best: Any, order: Any, best_order: Any) -> Condition:
    return at_least(distance, 0.0)


def _farthest(distance: Any, best: Any, order: Any, best_order: Any) -> Condition:
    return less(best, distance)


def _first_found(distance: Any, best: Any, order: Any, best_order: Any) -> Condition:
    return less(distance, distance)


_STEP = 1e-3
"""The offset of a start, in lengths of the scene."""

_LAMBDA = "λ = -dot(b, v) - sqrt(D);"
_D = "D = bv*bv - (dot(b, b) - r*r);"
_SMALLEST = "λ = λ1 > 0 ? λ1 : λ2;"
_NEAREST = "if (f > 0 && f < fmin) { fmin = f; found = k; }"
_SPHERE, _PASSES, _ORDER = (
    "Example of Sphere Intersection",
    "If Ray passes the Sphere or Not",
    "Ray Tracing Depth Sorting",
)


def _root(name: str, wrong: str, right: str, seen: str, mend: str, distances: Any) -> Fault:
    rules = instead(name, sphere_distances=distances)
    return Fault(name, "sphere", f'L11 "{_SPHERE}"', wrong, right, seen, mend, rules)


def _hit(name: str, slide: str, wrong: str, right: str, seen: str, mend: str, hit: Any, **entries: Any) -> Fault:
    rules = instead(name, sphere_hit=hit, **entries)
    return Fault(name, "sphere", f'L11 "{slide}"', wrong, right, seen, mend, rules)


def _order(name: str, slide: str, wrong: str, seen: str, mend: str, nearer: Any) -> Fault:
    return Fault(name, "order", f'L11 "{slide}"', wrong, _NEAREST, seen, mend, instead(name, nearer=nearer))


FAULTS = (
    _root(
        "far-root",
        "λ = -dot(b, v) + sqrt(D);",
        _LAMBDA,
        "the inside of the back of each ball is seen",
        "the smaller positive root is the front",
        _far_root,
    ),
    _root(
        "near-root-only",
        "λ = -dot(b, v) - sqrt(D);  // else: no hit",
        _SMALLEST,
        "a ball vanishes for an eye inside it",
        "inside, the near root is behind the eye: take the far one",
        _near_root,
    ),
    _root(
        "size-of-the-discriminant",
        "λ = -dot(b, v) - sqrt(fabs(D));",
        _D + " if (D < 0) no hit;",
        "every ray before a ball meets it",
        "D < 0 says that the ray passes by",
        _size_of_d,
    ),
    _root(
        "discriminant-cut-at-0",
        "λ = -dot(b, v) - sqrt(max(D, 0));",
        _D + " if (D < 0) no hit;",
        "every ray before a ball meets it",
        "D < 0 says that the ray passes by; cutting it at 0 says that it touches",
        _clamped_d,
    ),
    _root(
        "radius-not-squared",
        "D = bv*bv - (dot(b, b) - r);",
        _D,
        "balls of radius 1 are right, smaller ones too large",
        "|b|² - r²: both are squares",
        _r_for_r2,
    ),
    _root(
        "four-from-the-other-formula",
        "D = bv*bv - 4*(dot(b, b) - r*r);",
        _D,
        "balls shrink, or vanish",
        "the 4 belongs to the formula with 2b∘v and /2a",
        _four_ac,
    ),
    _root(
        "over-two-from-the-other-formula",
        "λ = (-dot(b, v) - sqrt(D))/2;",
        _LAMBDA,
        "outlines are right, shading is off: hit points lie half way",
        "the /2 belongs to the formula with 2b∘v",
        _over_two,
    ),
    _root(
        "sign-of-b",
        "λ = dot(b, v) - sqrt(D);",
        _LAMBDA,
        "what is before the eye is missing, what is behind it is seen",
        "b = o - c points from the centre to the eye: λ = -b∘v",
        _plus_b,
    ),
    _root(
        "sign-of-the-radius",
        "D = bv*bv - (dot(b, b) + r*r);",
        _D,
        "no ball is seen, but from inside or near",
        "|o + λv - c|² = r² brings r² with a minus",
        _plus_r2,
    ),
    _root(
        "root-forgotten",
        "λ = -dot(b, v) - D;",
        _LAMBDA,
        "outlines are right, balls are bent in depth",
        "λ = -b∘v ± sqrt(D)",
        _no_root,
    ),
    _root(
        "diameter-for-radius",
        "r = size/2;",
        "r = size;",
        "balls have half their size",
        "the scene gives the radius",
        _diameter,
    ),
    _root(
        "closest-point-for-hit",
        "λ = -dot(b, v);",
        _LAMBDA,
        "balls look like flat discs: normals lie across the ray",
        "-b∘v is where the ray comes nearest to the centre; the surface is sqrt(D) before it",
        _closest_point,
    ),
    _hit(
        "hits-behind-the-eye",
        "Ray Tracing with a Sphere; FindRGB",
        "if (f < fmin) { fmin = f; ... } if (f < 0) ...",
        _NEAREST,
        "a ball behind the eye wins over one before it",
        "test f > 0 before fmin is updated",
        _behind,
    ),
    _hit(
        "distance-without-sign",
        "Ray Tracing with a Sphere; FindRGB",
        "f = fabs(λ);",
        _SMALLEST,
        "a ball behind the eye is seen before it",
        "a negative λ lies behind: it is no hit",
        _without_sign,
    ),
    _hit(
        "sign-of-the-centre",
        _SPHERE,
        "b = o + c;",
        "b = o - c;",
        "balls stand mirrored at the origin",
        "b is the way from the centre to the eye",
        _o_plus_c,
    ),
    _hit(
        "meets-its-own-surface",
        "Modified FindRGB",
        "if (f >= 0 && f < fmin)",
        "if (f > 0 && k != start || ...)",
        "specks of shadow and colour on balls (acne)",
        "a ray that starts on a ball has the roots 0 and -2b∘v there: do not ask the rounded one",
        _acne,
    ),
    _hit(
        "start-moved-into-the-surface",
        "Modified FindRGB",
        "o = p - 0.001*n;  // leaving",
        "o = p + 0.001*n;  // to the side where the ray goes",
        "everything is in its own shadow, mirrors show themselves",
        "an offset goes to the side where the ray goes, or there is none",
        _into_the_surface,
        plane_hit=_plane_into,
    ),
    _hit(
        "start-always-moved-outward",
        "Get Refraction Vector",
        "o = p + 0.001*n;  // entering too",
        "o = p - 0.001*n;  // for a ray that enters",
        "light never gets into glass: the refracted ray meets the outside again",
        "an offset goes to the side where the ray goes",
        _always_outward,
    ),
    _hit(
        "never-meets-its-own-ball",
        "Various Types of Transparency",
        "if (k == start) continue;",
        "if (k == start) λ = -2*dot(b, v);",
        "light that entered a glass ball never leaves it through its other side",
        "inside a ball the ray must meet the same ball again",
        _never_again,
    ),
    _order(
        "last-drawn-wins",
        "Ray Tracing with a Sphere; FindRGB",
        "if (f > 0) { fmin = f; found = k; }",
        "the object last in the file covers all others",
        "keep the smallest f so far",
        _last_drawn,
    ),
    _order(
        "first-drawn-wins",
        _ORDER,
        "if (f > 0) { found = k; break; }",
        "the object first in the file covers all others",
        "ask all objects before you decide",
        _first_found,
    ),
    _order(
        "farthest-wins",
        _ORDER,
        "if (f > fmax) { fmax = f; found = k; }",
        "what is behind covers what is before",
        "the nearest wins: f < fmin",
        _farthest,
    ),
)
