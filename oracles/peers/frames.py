"""Frames of the shapes that stand for ours.

Mitsuba has no infinite plane. A `rectangle` gets its hit from barycentric coordinates of its corners, so its error
grows with its size (1e-5 at 100). A `disk` is met in its own frame, t = -z_o/z_d, and its size enters nothing but the
test x² + y² <= 1: a disk whose frame is not scaled along the normal is the plane's own formula at any radius.
With RADIUS 1e7 it misses rays that meet the plane farther away than 1e7, which from one unit above it are
those within 1e-7 of the horizon, an angle that float32 does not resolve.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from scenes.model import Plane

RADIUS = 1e7
"""Radius of the disk that stands for a plane, in the scene's unit."""


def plane_frame(plane: Plane) -> NDArray[np.float64]:
    """Matrix (4, 4) that takes the unit disk to the plane, its normal to the plane's, unscaled along it."""
    normal = np.asarray(plane.normal)
    squared = float(normal @ normal)
    n = normal / np.sqrt(squared)
    # The axis farthest from n gives two tangents without cancellation; axis-aligned planes stay exact
    axis = np.eye(3)[int(np.argmin(np.abs(n)))]
    s = np.cross(axis, n)
    s /= np.sqrt(float(s @ s))
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2] = RADIUS * s, RADIUS * np.cross(n, s), n
    matrix[:3, 3] = normal * (plane.offset / squared)
    return matrix
