"""Rows over the regimes in which a formula is easy, or ill-conditioned."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator, default_rng
from numpy.typing import NDArray

from oracles.peers.formulas import Stratum

Reals = NDArray[np.float64]
INDICES = (1.0 / 1.5, 1.1, 1.33, 1.5, 2.4)
ANGLES = {"ordinary": (0.05, 1.4), "near normal": (1e-6, 1e-3), "grazing": (1.5697, 1.5707)}
"""Angles of incidence in radians."""


def strata(seed: int, cases: int) -> list[Stratum]:
    """All strata of all formulas, `cases` rows each."""
    rng = default_rng(seed)
    found = []
    for formula in ("reflect", "refract", "fresnel"):
        found += [Stratum(formula, name, _optics(rng, cases, *ends)) for name, ends in ANGLES.items()]
        if formula != "reflect":
            found.append(Stratum(formula, "near critical", _critical(rng, cases)))
    for name, distance, impact in (
        ("ordinary", 5.0, (0.0, 0.9)),
        ("far", 1000.0, (0.0, 0.9)),
        ("grazing", 5.0, (0.999, 0.99999)),
        ("inside", 0.5, (0.0, 0.4)),
    ):
        found.append(Stratum("sphere", name, _sphere(rng, cases, distance, impact, (0.0, 0.0, 0.0, 1.0))))
    found.append(Stratum("sphere", "off origin", _sphere(rng, cases, 5.0, (0.0, 0.9), (300.0, -400.0, 500.0, 1.0))))
    for name, cosines in (("ordinary", (0.2, 1.0)), ("grazing", (1e-3, 1e-2))):
        found.append(Stratum("plane", name, _plane(rng, cases, cosines)))
    return found


def _unit(rng: Generator, cases: int) -> Reals:
    v = rng.normal(size=(cases, 3))
    return np.asarray(v / np.linalg.norm(v, axis=1)[:, None])


def _across(rng: Generator, n: Reals) -> Reals:
    """A unit vector at right angles to each n."""
    w = np.cross(n, _unit(rng, len(n)))
    return np.asarray(w / np.linalg.norm(w, axis=1)[:, None])


def _rows(*columns: Reals) -> NDArray[np.float32]:
    return np.concatenate(columns, axis=1).astype(np.float32)


def _optics(rng: Generator, cases: int, low: float, high: float) -> NDArray[np.float32]:
    n = _unit(rng, cases)
    angle = rng.uniform(low, high, (cases, 1))
    i = np.cos(angle) * n + np.sin(angle) * _across(rng, n)
    return _rows(i, n, rng.choice(INDICES[1:], (cases, 1)))


def _critical(rng: Generator, cases: int) -> NDArray[np.float32]:
    """From inside, 1e-4 to 1e-2 radians this side of the critical angle: the decision itself is certain."""
    n = _unit(rng, cases)
    index = rng.choice(INDICES[1:], (cases, 1))
    angle = np.arcsin(1.0 / index) - 10.0 ** rng.uniform(-4.0, -2.0, (cases, 1))
    return _rows(-np.cos(angle) * n + np.sin(angle) * _across(rng, n), n, index)


def _sphere(
    rng: Generator, cases: int, distance: float, impact: tuple[float, float], shape: tuple[float, ...]
) -> NDArray[np.float32]:
    """Rays whose line passes the centre at `impact` radii, from `distance` radii away."""
    v = _unit(rng, cases)
    centre, r = np.asarray(shape[:3]), shape[3]
    b = rng.uniform(*impact, (cases, 1))
    along = np.sqrt(np.maximum(distance**2 - b * b, 0.0))
    o = centre + r * (b * _across(rng, v) - along * v)
    return _rows(o, v, np.tile(shape, (cases, 1)))


def _plane(rng: Generator, cases: int, cosines: tuple[float, float]) -> NDArray[np.float32]:
    """Rays toward the plane 0.48 x + 0.6 y + 0.64 z = 2 from up to 5 away."""
    normal = np.tile([0.48, 0.6, 0.64], (cases, 1))
    c = rng.uniform(*cosines, (cases, 1))
    v = -c * normal + np.sqrt(1.0 - c * c) * _across(rng, normal)
    o = normal * rng.uniform(3.0, 5.0, (cases, 1)) + _across(rng, normal)
    return _rows(o, v, normal, np.full((cases, 1), 2.0))
