"""Mitsuba's optics and intersections on given rays: one row in, one row out."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.peers.frames import plane_frame
from scenes.model import Plane

Rows = NDArray[np.float32]


def evaluate(mi: Any, name: str, rows: Rows) -> Rows:
    """Rows of the formula `name` (see oracles.peers.formulas) as Mitsuba computes them."""
    if name in ("sphere", "plane"):
        return _met(mi, name, rows)
    if mi.variant().startswith("scalar"):
        return np.array([_optics(mi, name, *row.tolist()) for row in rows], dtype=np.float32)
    columns = _optics(mi, name, *(mi.Float(np.ascontiguousarray(column)) for column in rows.T))
    return np.array([np.array(column) for column in columns], dtype=np.float32).T


def _optics(mi: Any, name: str, x: Any, y: Any, z: Any, nx: Any, ny: Any, nz: Any, index: Any) -> tuple[Any, ...]:
    i, n = mi.Vector3f(x, y, z), mi.Normal3f(nx, ny, nz)
    if name == "reflect":
        r = mi.reflect(i, n)
        return r.x, r.y, r.z
    F, cos_t, _, ratio = mi.fresnel(i.x * n.x + i.y * n.y + i.z * n.z, index)
    if name == "fresnel":
        return (F,)
    t = mi.refract(i, n, cos_t, ratio)
    return t.x, t.y, t.z


def _met(mi: Any, name: str, rows: Rows) -> Rows:
    """Distance, point and normal: rays o, v (columns 0-5) at the one shape that all rows name (columns 6-9)."""
    x, y, z, r = (float(part) for part in rows[0, 6:])
    shape: dict[str, Any] = {"type": "sphere", "center": [x, y, z], "radius": r}
    if name == "plane":
        frame = plane_frame(Plane(shape="plane", normal=(x, y, z), offset=r, material="m"))
        shape = {"type": "disk", "to_world": mi.ScalarTransform4f(frame)}
    scene = mi.load_dict({"type": "scene", "shape": shape}, optimize=False)
    if mi.variant().startswith("scalar"):
        found = [scene.ray_intersect(mi.Ray3f(row[:3].tolist(), row[3:6].tolist())) for row in rows]
        return np.array([[s.t, *s.p, *s.n] for s in found], dtype=np.float32)
    columns = [mi.Float(np.ascontiguousarray(column)) for column in rows.T[:6]]
    s = scene.ray_intersect(mi.Ray3f(mi.Point3f(*columns[:3]), mi.Vector3f(*columns[3:])))
    return np.array([np.array(part) for part in (s.t, *s.p, *s.n)], dtype=np.float32).T
