"""From a pixel to its ray."""

from __future__ import annotations

from reference_tracer.numbers import Number
from reference_tracer.vector import Vec, unit


def plane_point(
    i: Number, j: Number, width: Number, height: Number, sample: tuple[Number, Number]
) -> tuple[Number, Number]:
    """Image-plane point (X, Y) of pixel (i, j), both in [-1, 1], y up.

    L11 "Ray Vector Calculation": X = -1 + 2x/w, Y = -(-1 + 2y/h), at x = i + sample.
    """
    X = -1.0 + (2.0 * (i + sample[0])) / width
    Y = 1.0 - (2.0 * (j + sample[1])) / height
    return X, Y


def camera_ray(forward: Vec, right: Vec, up: Vec, X: Number, Y: Number) -> Vec:
    """Unit direction v of the eye ray through (X, Y).

    L11 "Ray through Z=-1 (Near) plane": v = unit([X, Y, Z] - o), with the aspect factor in `right`.
    """
    return unit((forward + right * X) + up * Y)
