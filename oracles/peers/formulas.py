"""Formula by formula: a peer, ours and exact numbers on the same float32 rows, with a float32 budget for each.

Rows: `reflect`, `refract`, `fresnel` i(3), n(3), index, i and n away from the surface on its outer side or (refract,
fresnel) i on its inner; `sphere`, `plane` o(3), v(3), then centre and radius or normal and offset. Vectors of a
row are unit to float32; truth normalises them exactly, so their norms' errors (u each) count in the budgets,
which docs/peers.md derives. u = 2⁻²⁴.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from oracles.truth import ROUNDOFF
from reference_tracer import exact  # noqa: F401  (makes arb a number type)
from reference_tracer.formulas import optics, plane, sphere
from reference_tracer.numbers import Number
from reference_tracer.vector import Vec, length, unit

Reals = NDArray[np.float64]
u = ROUNDOFF["float32"]
BITS = 256


@dataclass(frozen=True)
class Stratum:
    """Rows of one formula in one regime."""

    formula: str
    name: str
    rows: NDArray[np.float32]


@dataclass(frozen=True)
class Errors:
    """How far a column of answers lies from exact ones: the worst share of the budget, and the worst itself."""

    worst: float
    share: float
    outside: int
    cases: int


def ours(formula: str, row: tuple[Number, ...]) -> tuple[Number, ...]:
    """The reference formulas on one row, or on rows as columns, in any number type; vectors are made unit."""
    a, b, rest = unit(Vec(*row[:3])), unit(Vec(*row[3:6])), row[6:]
    if formula == "reflect":
        return tuple(optics.reflect(a, b))
    if formula in ("refract", "fresnel"):
        n, leaving = optics.face(-a, b)
        if formula == "fresnel":
            return (optics.fresnel(-a, n, leaving, rest[0]),)
        return tuple(optics.refract(-a, n, leaving, rest[0])[0])
    o = Vec(*row[:3])
    if formula == "sphere":
        c = Vec(*rest[:3])
        distance, _ = sphere.sphere_hit(sphere.sphere_distances, o, b, c, rest[3], row[0] != row[0], 0.0)
        p = o + b * distance
        return (distance / length(Vec(*row[3:6])), *p, *sphere.sphere_normal(p, c))
    normal = Vec(*rest[:3])
    distance, _ = plane.plane_hit(o, b, normal, rest[3], row[0] == row[0], 0.0)
    return (distance / length(Vec(*row[3:6])), *(o + b * distance), *plane.plane_normal(normal))


def exactly(stratum: Stratum) -> Reals:
    """Answers to a half ulp of float64, from 256-bit balls."""
    before, ctx.prec = ctx.prec, BITS
    try:
        rows = [tuple(arb(float(x)) for x in row) for row in stratum.rows]
        return np.array([[float(x.mid()) for x in map(arb, ours(stratum.formula, row))] for row in rows])
    finally:
        ctx.prec = before


def _cosines(rows: Reals) -> tuple[Reals, Reals, Reals]:
    """|cos| of incidence, of refraction, and the relative index toward the other side."""
    c = np.einsum("ij,ij->i", rows[:, :3], rows[:, 3:6])
    ratio = np.where(c > 0.0, 1.0 / rows[:, 6], rows[:, 6])
    squared = 1.0 - (1.0 - c * c) * ratio * ratio
    return np.abs(c), np.sqrt(np.maximum(squared, 0.0)), ratio


def _cosine_budget(rows: Reals) -> Reals:
    """Of cosθ2 = sqrt(1 - (1-c²)ratio²): radicand off by e = (6 ratio² + 5)u, its root by min(e/root, sqrt(e))."""
    _, root, ratio = _cosines(rows)
    e = (6.0 * ratio * ratio + 5.0) * u
    return np.asarray(np.minimum(e / np.maximum(root, 1e-300), np.sqrt(e)))


def _refract_budget(rows: Reals) -> Reals:
    ratio = _cosines(rows)[2]
    return np.asarray((_cosine_budget(rows) + (10.0 * ratio + 8.0) * u)[:, None])


def _fresnel_budget(rows: Reals) -> Reals:
    c, root, ratio = _cosines(rows)
    index = 1.0 / ratio
    moved = _cosine_budget(rows)
    s = 2.0 * (index * moved + 3.0 * u) / (c + index * root) + 9.0 * u
    p = 2.0 * (moved + 3.0 * u * index) / (index * c + root) + 9.0 * u
    return np.asarray((s + p + 3.0 * u)[:, None])


def _sphere_budget(rows: Reals) -> Reals:
    o, c, r = rows[:, :3], rows[:, 6:9], rows[:, 9]
    v = rows[:, 3:6] / np.linalg.norm(rows[:, 3:6], axis=1)[:, None]
    b = o - c
    D = np.linalg.norm(b, axis=1) / r
    s = np.sqrt(np.maximum(D * D - (np.einsum("ij,ij->i", b, v) / r) ** 2, 0.0))
    cosine = np.sqrt(np.maximum(1.0 - s * s, u))
    world = np.abs(o).max(axis=1) + np.abs(c).max(axis=1)
    t = 4.0 * u * (D * r * (1.0 + s / cosine) + world / cosine)
    return np.concatenate([t[:, None], np.repeat((t + 4.0 * u * world)[:, None], 3, 1), _normal(t, r)], axis=1)


def _normal(t: Reals, r: Reals) -> Reals:
    return np.repeat((t / r + 4.0 * u)[:, None], 3, 1)


def _plane_budget(rows: Reals) -> Reals:
    o, v, n = rows[:, :3], rows[:, 3:6], rows[:, 6:9]
    size = np.linalg.norm(n, axis=1)
    cosine = np.abs(np.einsum("ij,ij->i", v, n)) / size
    reach = np.abs(o).sum(axis=1) + np.abs(rows[:, 9]) / size
    distance = np.abs(rows[:, 9] - np.einsum("ij,ij->i", o, n)) / size / cosine
    t = 8.0 * u * (reach + distance) / cosine
    p = t + 4.0 * u * (reach + distance)
    return np.concatenate([t[:, None], np.repeat(p[:, None], 3, 1), np.full((len(t), 3), 8.0 * u)], axis=1)


BUDGETS: dict[str, Callable[[Reals], Reals]] = {
    "reflect": lambda rows: np.full((len(rows), 1), 14.0 * u),
    "refract": _refract_budget,
    "fresnel": _fresnel_budget,
    "sphere": _sphere_budget,
    "plane": _plane_budget,
}
"""Absolute error that a float32 evaluation may make, by row and column; docs/peers.md derives them."""


def errors(stratum: Stratum, truth: Reals, answers: Reals) -> Errors:
    """The answers' distance from truth; a sphere's or plane's normal may be given on either side."""
    away = np.abs(answers - truth)
    if stratum.formula == "plane":
        away[:, 4:] = np.minimum(away[:, 4:], np.abs(answers[:, 4:] + truth[:, 4:]))
    shares = away / BUDGETS[stratum.formula](stratum.rows.astype(np.float64))
    outside = np.any(~(shares <= 1.0), axis=1)
    return Errors(float(away.max()), float(shares.max()), int(np.count_nonzero(outside)), len(away))
