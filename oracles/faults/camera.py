"""Faults between the pixel and its ray."""

from __future__ import annotations

from typing import Any

import numpy as np

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas.camera import camera_ray, plane_point
from reference_tracer.numbers import Number
from reference_tracer.vector import Vec, length, unit

Point = tuple[Number, Number]


def _y_down(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return X, -Y


def _x_mirrored(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return -X, Y


def _no_aspect(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return X * h / w, Y


def _aspect_on_y(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return X * h / w, Y * h / w


def _minus_one(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    return plane_point(i, j, w - 1.0, h - 1.0, sample)


def _half_twice(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    return plane_point(i + 0.5, j + 0.5, w, h, sample)


def _x_only(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    return plane_point(i, j, w, h, (sample[0], 0.0))


def _swapped(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    return plane_point(j, i, h, w, sample)


def _integer(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    return -1.0 + np.floor(2.0 * i / w), 1.0 - np.floor(2.0 * j / h)


def _half_view(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return 0.5 * X, 0.5 * Y


def _even_angles(i: Any, j: Any, w: Any, h: Any, sample: Any) -> Point:
    X, Y = plane_point(i, j, w, h, sample)
    return np.tan(X * (np.pi / 4.0)), np.tan(Y * (np.pi / 4.0))


def _not_unit(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    found: Vec = (forward + right * X) + up * Y
    return found


def _backwards(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    return camera_ray(-forward, right, up, X, Y)


def _never_turned(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    return unit(Vec(length(right) * X, length(up) * Y, length(forward) + 0.0 * X))


def _plane_at_one(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    return camera_ray(unit(forward), right, up, X, Y)


def _up_for_right(forward: Vec, right: Vec, up: Vec, X: Any, Y: Any) -> Vec:
    return camera_ray(forward, up, right, X, Y)


_VECTOR, _PLANE, _VIEW = (
    "Ray Vector Calculation",
    "Ray through Z=-1 (Near) plane",
    "Modifying Viewpoint in RT Example",
)
_X, _Y, _V = "X = -1 + 2*(x + sx)/w;", "Y = 1 - 2*(y + sy)/h;", "v = unit(forward + right*X + up*Y);"


def _point(name: str, wrong: str, right: str, seen: str, mend: str, plane: Any) -> Fault:
    rules = instead(name, plane_point=plane)
    return Fault(name, "camera", f'L11 "{_VECTOR}"', wrong, right, seen, mend, rules)


def _ray(name: str, slide: str, wrong: str, seen: str, mend: str, ray: Any) -> Fault:
    return Fault(name, "camera", f'L11 "{slide}"', wrong, _V, seen, mend, instead(name, camera_ray=ray))


FAULTS = (
    _point(
        "y-not-turned",
        "Y = -1 + 2*(y + sy)/h;",
        _Y,
        "the picture is upside down",
        "rows count downward in the image, y upward in space: the minus sign in front of Y",
        _y_down,
    ),
    _point(
        "x-mirrored",
        "X = 1 - 2*(x + sx)/w;",
        _X,
        "left and right are exchanged",
        "only Y carries the minus sign",
        _x_mirrored,
    ),
    _point(
        "aspect-left-out",
        "v = unit([X, Y, Z] - o);",
        "v = unit([X*w/h, Y, Z] - o);",
        "in a picture that is not square balls are eggs",
        "X times w/h, which `right` carries in the scene file",
        _no_aspect,
    ),
    _point(
        "aspect-in-height",
        "v = unit([X, Y*h/w, Z] - o);",
        "v = unit([X*w/h, Y, Z] - o);",
        "balls are round but everything is too large",
        "the factor belongs to X: the height of the view is fixed",
        _aspect_on_y,
    ),
    _point(
        "last-pixel-at-the-edge",
        "X = -1 + 2*(x + sx)/(w - 1);",
        _X,
        "everything shifts by a fraction of a pixel that grows to the right and down",
        "w pixels divide [-1, 1] into w parts, not w - 1",
        _minus_one,
    ),
    _point(
        "half-pixel-twice",
        "X = -1 + 2*(x + 0.5 + sx)/w;",
        _X,
        "everything is half a pixel off; only edges show it",
        "the scene's sample is the whole offset: 0 the corner, 0.5 the centre",
        _half_twice,
    ),
    _point(
        "sample-in-x-only",
        "Y = 1 - 2*y/h;",
        _Y,
        "with centred samples everything is half a pixel too low",
        "the sample has two parts",
        _x_only,
    ),
    _point(
        "rows-for-columns",
        "ray(y, x)",
        "ray(x, y)",
        "the picture is mirrored on its diagonal and stretched",
        "which of the two loops is the row, and which argument comes first",
        _swapped,
    ),
    _point(
        "integer-division",
        "X = -1 + 2*x/w;  // x, w int",
        "X = -1 + 2.0*(x + sx)/w;",
        "four rectangles of one colour each",
        "int/int drops the fraction: make one of them a float",
        _integer,
    ),
    _point(
        "plane-half-as-wide",
        "X = -0.5 + (x + sx)/w;",
        _X,
        "everything is twice as large",
        "the image plane reaches from -1 to 1",
        _half_view,
    ),
    _point(
        "even-angles-for-even-points",
        "X = tan((-1 + 2*(x + sx)/w)*fov/2);",
        _X,
        "straight edges bend, balls are too small between middle and edge",
        "pixels are evenly spaced on the plane, not in the angle",
        _even_angles,
    ),
    _ray(
        "ray-not-unit",
        _VECTOR,
        "v = forward + right*X + up*Y;",
        "balls swell toward the edges or vanish, highlights change",
        "λ = -b∘v ± ... holds for |v| = 1 only",
        _not_unit,
    ),
    _ray(
        "looks-backwards",
        _PLANE,
        "v = unit([X, Y, -Z] - o);",
        "what is before the eye is missing, what is behind it is seen",
        "(0,0,-1) - (0,0,-2) looks toward +z, although the slide's near plane is Z = -1",
        _backwards,
    ),
    _ray(
        "camera-never-turned",
        _VIEW,
        "v = unit([X*|right|, Y*|up|, |forward|]);",
        "right for the lecture's camera, wrong for every camera that is turned",
        "multiply by the vectors forward, right and up, not by their lengths",
        _never_turned,
    ),
    _ray(
        "plane-always-at-distance-1",
        _PLANE,
        "v = unit(unit(forward) + right*X + up*Y);",
        "the field of view is wrong where |forward| is not 1",
        "the length of forward is the distance of the image plane",
        _plane_at_one,
    ),
    _ray(
        "up-for-right",
        _VIEW,
        "v = unit(forward + up*X + right*Y);",
        "the view is turned by a quarter",
        "X goes along right, Y along up",
        _up_for_right,
    ),
)
