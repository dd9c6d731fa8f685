"""Faults of planes and of normals."""

from __future__ import annotations

from typing import Any

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas import optics
from reference_tracer.formulas.plane import plane_hit
from reference_tracer.numbers import Condition, Number, less, select
from reference_tracer.vector import Vec, dot, unit

Hit = tuple[Number, Condition]


def _one_sided(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    root, meets = plane_hit(o, v, normal, offset, elsewhere, start, again)
    return root, meets & less(dot(normal, v), 0.0)


def _offset_sign(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    return plane_hit(o, v, normal, -offset, elsewhere, start, again)


def _unit_for_hit(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    return plane_hit(o, v, unit(normal), offset, elsewhere, start, again)


def _behind(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    root, _ = plane_hit(o, v, normal, offset, elsewhere, start, again)
    return root, elsewhere & (less(root, 0.0) | less(0.0, root))


def _eye_left_out(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    return plane_hit(o - o, v, normal, offset, elsewhere, start, again)


def _slope_left_out(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    root = dot(normal, o) - offset
    return root, elsewhere & less(0.0, root) & less(dot(normal, v), 0.0)


def _floor_only(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    up = Vec(0.0 * normal.x, normal.y, 0.0 * normal.z)
    return plane_hit(o, v, up, offset, elsewhere, start, again)


def _parallel_too_soon(o: Vec, v: Vec, normal: Vec, offset: Any, elsewhere: Any, start: Any, again: Any = 0.0) -> Hit:
    root, meets = plane_hit(o, v, normal, offset, elsewhere, start, again)
    slope = dot(normal, v)
    return root, meets & less(0.01, slope * slope)


def _never_turned(v: Vec, n: Vec) -> tuple[Vec, Condition]:
    _, leaving = optics.face(v, n)
    return n, leaving


def _never_leaving(v: Vec, n: Vec) -> tuple[Vec, Condition]:
    turned, leaving = optics.face(v, n)
    return turned, leaving & ~leaving


def _sides_swapped(v: Vec, n: Vec) -> tuple[Vec, Condition]:
    turned, leaving = optics.face(v, n)
    return turned, ~leaving


def _dark_inside(n: Vec, leaving: Condition) -> Vec:
    found: Vec = n * select(leaving, 0.0, 1.0)
    return found


_BALL, _PLANE, _REFRACT = "Ray Tracing with a Sphere", "Object Modeling in uObj", "Get Refraction Vector"
_N, _ROOT = "n = unit(p - c);", "λ = (offset - dot(normal, o))/dot(normal, v);"
_FACE = "if (dot(n, v) > 0) n = -n;"


def _entry(name: str, slide: str, wrong: str, right: str, seen: str, mend: str, **entries: Any) -> Fault:
    group = "plane" if "plane_hit" in entries or "plane_normal" in entries else "normal"
    return Fault(name, group, f'L11 "{slide}"', wrong, right, seen, mend, instead(name, **entries))


FAULTS = (
    _entry(
        "normal-not-unit",
        _BALL,
        "n = p - c;",
        _N,
        "balls of radius 1 are right, small ones dark, large ones bright",
        "divide by |p - c|",
        sphere_normal=lambda p, c: p - c,
    ),
    _entry(
        "normal-over-its-square",
        _BALL,
        "n = (p - c)/dot(p - c, p - c);",
        _N,
        "balls of radius 1 are right, small ones bright, large ones dark",
        "divide by the length, the root of the dot product",
        sphere_normal=lambda p, c: (p - c) / dot(p - c, p - c),
    ),
    _entry(
        "normal-inward",
        _BALL,
        "n = unit(c - p);",
        _N,
        "glass bends the wrong way: entering and leaving are exchanged",
        "the outward normal goes from the centre to p",
        sphere_normal=lambda p, c: unit(c - p),
    ),
    _entry(
        "normal-from-the-origin",
        _BALL,
        "n = unit(p);",
        _N,
        "right for a ball at the origin only",
        "subtract the centre",
        sphere_normal=lambda p, c: unit(p),
    ),
    _entry(
        "normal-plus-centre",
        _BALL,
        "n = unit(p + c);",
        _N,
        "shading turns with the ball's place",
        "subtract the centre",
        sphere_normal=lambda p, c: unit(p + c),
    ),
    _entry(
        "normal-of-the-plane-as-given",
        _PLANE,
        "n = normal;",
        "n = unit(normal);",
        "planes whose normal is not unit are too bright or too dark",
        "make it unit for shading, and for shading only",
        plane_normal=lambda normal: normal,
    ),
    _entry(
        "every-plane-is-a-floor",
        _PLANE,
        "n = {0, 1, 0};",
        "n = unit(normal);",
        "walls are lit as floors",
        "use the plane's own normal",
        plane_normal=lambda normal: Vec(0.0 * normal.x, 0.0 * normal.y + 1.0, 0.0 * normal.z),
    ),
    _entry(
        "every-plane-is-met-as-a-floor",
        _PLANE,
        "λ = (offset/normal.y - o.y)/v.y;",
        _ROOT,
        "walls are missing",
        "use all three components of the normal",
        plane_hit=_floor_only,
    ),
    _entry(
        "plane-from-one-side",
        _PLANE,
        "if (dot(normal, v) >= 0) no hit;",
        "if (dot(normal, v) == 0) no hit;",
        "planes vanish from behind",
        "a plane has two sides",
        plane_hit=_one_sided,
    ),
    _entry(
        "offset-with-a-minus",
        _PLANE,
        "λ = -(offset + dot(normal, o))/dot(normal, v);",
        _ROOT,
        "planes stand mirrored at the origin",
        "normal∘p = offset, not normal∘p + offset = 0",
        plane_hit=_offset_sign,
    ),
    _entry(
        "unit-normal-with-raw-offset",
        _PLANE,
        "normal = unit(normal);  // then λ",
        _ROOT,
        "planes whose normal is not unit stand at another distance",
        "dividing the normal by its length needs the offset divided too",
        plane_hit=_unit_for_hit,
    ),
    _entry(
        "plane-behind-the-eye",
        _PLANE,
        "if (λ < fmin) ...",
        "if (λ > 0 && λ < fmin) ...",
        "the floor is seen in the sky",
        "a negative λ lies behind",
        plane_hit=_behind,
    ),
    _entry(
        "plane-without-the-eye",
        _PLANE,
        "λ = offset/dot(normal, v);",
        _ROOT,
        "planes move with the eye; mirrors and shadows on them are wrong",
        "subtract normal∘o",
        plane_hit=_eye_left_out,
    ),
    _entry(
        "distance-along-the-normal",
        _PLANE,
        "λ = dot(normal, o) - offset;",
        _ROOT,
        "the floor is a shell about the eye",
        "divide by normal∘v: the ray is slanted",
        plane_hit=_slope_left_out,
    ),
    _entry(
        "parallel-too-soon",
        _PLANE,
        "if (fabs(dot(normal, v)) < 0.1) no hit;",
        "if (dot(normal, v) == 0) no hit;",
        "the far floor is missing below the horizon",
        "only 0 is parallel",
        plane_hit=_parallel_too_soon,
    ),
    _entry(
        "normal-never-turned",
        "Get Refraction Vector",
        "n as given",
        _FACE,
        "inside of balls and undersides of planes are dark; glass is wrong",
        "the normal faces the ray",
        face=_never_turned,
    ),
    _entry(
        "never-leaving",
        _REFRACT,
        "entering = true;",
        "leaving = dot(n, v) > 0;",
        "light turns back inside glass",
        "ask the outward normal before you turn it",
        face=_never_leaving,
    ),
    _entry(
        "inside-for-outside",
        _REFRACT,
        "leaving = dot(n, v) < 0;",
        "leaving = dot(n, v) > 0;",
        "glass behaves as a bubble does",
        "n∘v > 0: along the outward normal, so out",
        face=_sides_swapped,
    ),
    _entry(
        "unlit-from-inside",
        _PLANE,
        "if (leaving) n = 0;",
        _FACE,
        "what is seen from inside or below is only ambient",
        "both sides are lit",
        shading_normal=_dark_inside,
    ),
)
