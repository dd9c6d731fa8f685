"""What is asked about: anything that answers where rays meet spheres and how they bend, a batch at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from oracles.measurement import Precision
from reference_tracer.methods import REFRACT, SPHERE
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec

Reals = NDArray[Any]
DTYPES: dict[Precision, Any] = {"float32": np.float32, "float64": np.float64}
ROUNDOFF: dict[Precision, float] = {"float32": 2.0**-24, "float64": 2.0**-53}


class SphereProbe(Protocol):
    """Answers about spheres. Arrays o, v, c of shape (n, 3) and r of (n,) are of its precision; v is unit to it."""

    @property
    def name(self) -> str:
        """What it is called in tables."""

    @property
    def precision(self) -> Precision:
        """What it computes in, and is asked in."""

    def sphere(self, o: Reals, v: Reals, c: Reals, r: Reals) -> Reals:
        """λ > 0 of the nearest hit, (n,); NaN for a miss."""


class RefractProbe(Protocol):
    """Answers about refraction."""

    @property
    def name(self) -> str:
        """What it is called in tables."""

    @property
    def precision(self) -> Precision:
        """What it computes in, and is asked in."""

    def refract(self, v: Reals, n: Reals, index: Reals) -> Reals:
        """Direction t, (n, 3), of the travelling v at the outward normal n; NaN under total reflection."""


@dataclass(frozen=True)
class MethodProbe:
    """A rulebook on NumPy lanes; in float64 its answers are those of every other arithmetic, bit for bit."""

    name: str
    precision: Precision
    rules: Rulebook

    def sphere(self, o: Reals, v: Reals, c: Reals, r: Reals) -> Reals:
        with np.errstate(all="ignore"):  # what overflows or has no value is the answer
            elsewhere = np.zeros(len(r), dtype=bool)
            formula = self.rules.sphere_distances
            distance, meets = self.rules.sphere_hit(formula, Vec(*o.T), Vec(*v.T), Vec(*c.T), r, elsewhere, 0.0)
        return np.where(meets, distance, np.nan)

    def refract(self, v: Reals, n: Reals, index: Reals) -> Reals:
        with np.errstate(all="ignore"):
            travelling = Vec(*v.T)
            facing, leaving = self.rules.face(travelling, Vec(*n.T))
            t, total = self.rules.refract(travelling, facing, leaving, index)
        return np.where(np.asarray(total)[:, None], np.nan, np.stack(t, axis=-1))


def sphere_methods(precision: Precision) -> list[MethodProbe]:
    """Our ways to meet a sphere; those that only differ in float32 are left out of float64."""
    return [
        MethodProbe(name, precision, rules)
        for name, rules in SPHERE.items()
        if precision == "float32" or name != "wide"
    ]


def refract_methods(precision: Precision) -> list[MethodProbe]:
    """Our ways to refract."""
    return [MethodProbe(name, precision, rules) for name, rules in REFRACT.items()]
