"""Faults of arithmetic: the formula is right, the numbers are not."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas import camera, optics, plane, shading, sphere
from reference_tracer.methods.spheres import Roots
from reference_tracer.numbers import Condition, Number, less
from reference_tracer.vector import Vec, dot


def _half(x: Any) -> Any:
    """The number rounded to 11 significant bits and back."""
    return np.asarray(x).astype(np.float16).astype(np.asarray(x).dtype)


def _halved(a: Vec) -> Vec:
    return Vec(*map(_half, a))


def _in_steps(steps: float) -> Any:
    return lambda x: np.floor(x * steps) / steps


def _fast_unit(a: Vec) -> Vec:
    """A times 1/sqrt(a∘a) by the bit trick and one Newton step, as published in Quake III Arena's q_math.c."""
    square = np.asarray(dot(a, a), dtype=np.float32)
    guess = (np.int32(0x5F3759DF) - (square.view(np.int32) >> 1)).view(np.float32)
    root = guess * (np.float32(1.5) - np.float32(0.5) * square * guess * guess)
    return a * root.astype(np.asarray(a.x).dtype)


def _fast_ray(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    return _fast_unit((forward + right * X) + up * Y)


def _fast_light(k: Vec, p: Vec, is_point: Any) -> tuple[Vec, Number]:
    i, distance = shading.light_vector(k, p, is_point)
    return _fast_unit(i), distance


def _half_roots(b: Vec, bv: Any, v: Vec, r: Any) -> Roots:
    near, far, D = sphere.sphere_distances(b, bv, v, r)
    return _half(near), _half(far), D


def _cut(change: Any) -> dict[str, Any]:
    """Both hits with change(distance, meets, elsewhere): what a bound on λ makes of them."""

    def ball(distances: Any, o: Vec, v: Vec, c: Vec, r: Any, here: Any, start: Any) -> tuple[Number, Condition]:
        return change(*sphere.sphere_hit(distances, o, v, c, r, here, start))  # type: ignore[no-any-return]

    def flat(o: Vec, v: Vec, n: Vec, d: Any, elsewhere: Any, start: Any, again: Any = plane.NEVER) -> Any:
        return change(*plane.plane_hit(o, v, n, d, elsewhere, start, again))

    return {"sphere_hit": ball, "plane_hit": flat}


def below(limit: float) -> dict[str, Any]:
    """Entries under which nothing is met at or beyond this distance."""
    return _cut(lambda distance, meets: (distance, meets & less(distance, limit)))


def above(limit: float) -> dict[str, Any]:
    """Entries under which nothing is met before this distance."""
    return _cut(lambda distance, meets: (distance, meets & less(limit, distance)))


_MODIFIED, _BOOK = 'L11 "Modified FindRGB"', "RayTracing/raytracing.github.io#1665, on where such epsilons come from"
_NEAREST = "if (f > 0 && f < fmin) { fmin = f; found = k; }"
_INFINITE, _FLOAT = "fmin = INFINITY;", "float c;"
_SCALE = "mitsuba-renderer/mitsuba2#171, a fixed epsilon as the scene grows"


def _fault(
    name: str,
    source: str,
    wrong: str,
    right: str,
    shows: str,
    mend: str,
    **entries: Any,
) -> Fault:
    return Fault(name, "numbers", source, wrong, right, shows, mend, instead(name, **entries))


_QUAKE = "id Software, Quake III Arena, q_math.c, Q_rsqrt"
_UNIT = "v = a/sqrt(dot(a, a));"

FAULTS = (
    _fault(
        "half-precision-colours",
        'L11 "Basic Buffering"',
        "half c;  // in find_rgb",
        _FLOAT,
        "fine steps in shading",
        "round when the file is written, not between",
        seen=_halved,
    ),
    _fault(
        "bytes-between-bounces",
        'L11 "Ex) Bad and Good Case"',
        "return floor(255*c)/255;  // find_rgb",
        "return c;",
        "steps in mirrors and shading",
        "make bytes once, at the end",
        seen=lambda c: Vec(*map(_in_steps(255.0), c)),
    ),
    _fault(
        "fast-root-for-the-ray",
        _QUAKE,
        "v = a*Q_rsqrt(dot(a, a));",
        _UNIT,
        "outlines move by up to 0.2 % of the distance",
        "the trick is good to 0.17 %: use sqrt",
        camera_ray=_fast_ray,
    ),
    _fault(
        "fast-root-for-the-normal",
        _QUAKE,
        "n = (p - c)*Q_rsqrt(...);",
        "n = unit(p - c);",
        "shading is up to 0.2 % off",
        "the trick is good to 0.17 %: use sqrt",
        sphere_normal=lambda p, c: _fast_unit(p - c),
    ),
    _fault(
        "fast-root-for-the-light",
        _QUAKE,
        "i = (k - p)*Q_rsqrt(...);",
        "i = unit(k - p);",
        "shading is up to 0.2 % off",
        "the trick is good to 0.17 %: use sqrt",
        light_vector=_fast_light,
    ),
    _fault(
        "half-precision-distances",
        'L11 "Example of Sphere Intersection"',
        "half λ;",
        "float λ;",
        "rings on balls",
        "11 bits are 0.05 % of the distance",
        sphere_distances=_half_roots,
    ),
    _fault(
        "half-precision-normals",
        'L11 "Ray Tracing with a Sphere"',
        "half n[3];",
        "float n[3];",
        "steps in highlights and mirrors",
        "normals need the precision of the rest",
        sphere_normal=lambda p, c: _halved(sphere.sphere_normal(p, c)),
    ),
    _fault(
        "half-precision-rays",
        'L11 "Ray Vector Calculation"',
        "half v[3];",
        "float v[3];",
        "jagged outlines",
        "directions need the precision of the rest",
        camera_ray=lambda *a: _halved(camera.camera_ray(*a)),
    ),
    _fault(
        "half-precision-refraction",
        'L11 "Refraction Vector Calculation"',
        "half t[3];",
        "float t[3];",
        "grain in glass",
        "directions need the precision of the rest",
        refract=lambda *a: (_halved(optics.refract(*a)[0]), optics.refract(*a)[1]),
    ),
    _fault(
        "cosine-from-a-table",
        'L11 "Lambertian Reflection Model"',
        "cosθ = table[int(256*dot(i, n))];",
        "cosθ = max(dot(i, n), 0);",
        "steps in smooth shading",
        "compute it",
        lambert=lambda i, n: _in_steps(256.0)(shading.lambert(i, n)),
    ),
    _fault(
        "power-from-a-table",
        'L11 "Phong\'s effect Result"',
        "gloss = table[int(256*x)];",
        "gloss = pow(x, s);",
        "rings in highlights",
        "compute it",
        phong=lambda *a: _in_steps(256.0)(shading.phong(*a)),
    ),
    _fault(
        "infinity-is-1e10",
        _MODIFIED,
        "fmin = 1e10;",
        _INFINITE,
        "what is farther than 1e10 is missing",
        "infinity is infinity",
        **below(1e10),
    ),
    _fault(
        "infinity-is-10",
        _MODIFIED,
        "fmin = 10;",
        _INFINITE,
        "the far floor is missing",
        "infinity is infinity",
        **below(10.0),
    ),
    _fault(
        "least-distance-a-tenth",
        _SCALE,
        "if (f > 0.1 && f < fmin)",
        _NEAREST,
        "gaps at contacts, holes in thin glass",
        "a fixed epsilon is wrong at some scale",
        **above(0.1),
    ),
    _fault(
        "least-distance-a-hundredth",
        _BOOK,
        "if (f > 0.01 && f < fmin)",
        _NEAREST,
        "gaps at contacts",
        "a fixed epsilon is wrong at some scale",
        **above(0.01),
    ),
)
