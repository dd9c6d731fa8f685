"""Containment: exact values at 320 bits inside the balls of u = 2^-53, over a million random rays.

Strata: distance/radius log-uniform to 10^5, grazing |1 - s| log-uniform to 10^-12, refraction and reflection near
normal incidence, near the critical angle, and anywhere. Prints violations (there must be none) and sure
decisions that were wrong (likewise), and what happens when the widening is taken out.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from raycheck.machine import machine
from reference_tracer import exact
from reference_tracer.formulas import optics, sphere
from reference_tracer.lanes.ball import UNDERFLOW_64, Ball, Doubtful, Precision
from reference_tracer.vector import Vec, unit

DOUBLE = Precision(2.0**-53, UNDERFLOW_64)
CHUNK = 20_000
BITS = 320
Reals = NDArray[np.float64]


@dataclass
class Tally:
    """What was found in one stratum."""

    rays: int = 0
    values: int = 0
    outside: int = 0
    decisions: int = 0
    wrong: int = 0
    undecided: int = 0


def sphere_case(o: Vec, w: Vec, c: Vec, r: Any) -> tuple[list[Any], Any]:
    """Root, hit and normal of a sphere."""
    v = unit(w)
    distance, meets = sphere.sphere_hit(sphere.sphere_distances, o, v, c, r, _false(r), 0.0)
    return [distance, *sphere.sphere_normal(o + v * distance, c)], meets


def snell_case(o: Vec, w: Vec, c: Vec, index: Any) -> tuple[list[Any], Any]:
    """Mirror and refracted direction at the surface whose outward normal is c."""
    v, n = unit(w), unit(c)
    facing, leaving = optics.face(v, n)
    t, total = optics.refract(v, facing, leaving, index)
    return [*optics.reflect(-v, facing), *t], total


def _false(like: Any) -> Any:
    return like.mid < -1.0 if isinstance(like, Ball) else False


def far_and_grazing(rng: np.random.Generator, n: int) -> tuple[Reals, ...]:
    """Rays that pass a sphere at impact parameter s, 1 - s from 1 down to 1e-12 on both sides."""
    D = 10.0 ** rng.uniform(0.2, 5.0, n)
    s = 1.0 - 10.0 ** rng.uniform(-12.0, 0.0, n) * rng.choice([-1.0, 1.0], n)
    r = 10.0 ** rng.uniform(-1.0, 1.0, n)
    u, side = _directions(rng, n), _directions(rng, n)
    side -= u * (u * side).sum(0)
    side /= np.linalg.norm(side, axis=0)
    o = rng.uniform(-3.0, 3.0, (3, n))
    c = o + u * (D * r) + side * (s * r)
    return o, u * rng.uniform(0.5, 2.0, n), c, r


def refractions(rng: np.random.Generator, n: int) -> tuple[Reals, ...]:
    """Directions at angles near 0, near the critical angle, and anywhere."""
    index = rng.choice([1.0 / 1.5, 0.75, 1.0, 1.33, 1.5, 2.4], n)
    critical = np.arcsin(np.minimum(index, 1.0 / index))
    near = 10.0 ** rng.uniform(-12.0, -1.0, n)
    theta = np.choose(rng.integers(0, 3, n), [near, np.clip(critical - near, 0.0, 1.5), rng.uniform(0.0, 1.57, n)])
    normal, side = _directions(rng, n), _directions(rng, n)
    side -= normal * (normal * side).sum(0)
    side /= np.linalg.norm(side, axis=0)
    w = side * np.sin(theta) + normal * np.cos(theta) * rng.choice([-1.0, 1.0], n)
    return np.zeros((3, n)), w * rng.uniform(0.5, 2.0, n), normal * rng.uniform(0.5, 2.0, n), index


def _directions(rng: np.random.Generator, n: int) -> Reals:
    a = rng.standard_normal((3, n))
    return a / np.linalg.norm(a, axis=0)


def check(case: Callable[..., Any], rays: tuple[Reals, ...], precision: Precision, tally: Tally) -> None:
    """Compare balls and exact numbers ray by ray."""

    def ball(x: Reals) -> Ball:
        return Ball(x, np.zeros_like(x), precision)

    *vectors, scalar = rays
    with np.errstate(all="ignore"):
        balls, decision = case(*(Vec(*map(ball, vector)) for vector in vectors), ball(scalar))
    n = scalar.size
    values = [(np.broadcast_to(b.mid, n), np.broadcast_to(b.rad, n)) for b in balls]
    assert isinstance(decision, Doubtful)
    for k in range(n):
        tally.rays += 1
        try:
            truth, answer = case(*(Vec(*(arb(float(x[k])) for x in v)) for v in vectors), arb(float(scalar[k])))
        except exact.UndecidedError:
            tally.undecided += 1
            continue
        if not decision.sure[k]:
            tally.undecided += 1
            continue
        tally.decisions += 1
        tally.wrong += bool(decision.value[k]) != answer
        for (mid, rad), value in zip(values, truth, strict=True):
            if np.isfinite(mid[k]) and np.isfinite(rad[k]):
                tally.values += 1
                tally.outside += not bool(abs(value - arb(float(mid[k]))) <= arb(float(rad[k])))


def main() -> None:
    """Run both strata; the number of rays is the first argument."""
    total = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}")
    ctx.prec = BITS
    cases = {"sphere": (sphere_case, far_and_grazing), "reflect and refract": (snell_case, refractions)}
    for widened, precision in (("as proved", DOUBLE), ("widening removed", Precision(0.0, 0.0))):
        for name, (case, rays) in cases.items():
            rng = np.random.default_rng(2026)
            tally = Tally()
            begin = time.perf_counter()
            count = total // 2 if precision is DOUBLE else 20_000
            while tally.rays < count:
                check(case, rays(rng, min(CHUNK, count - tally.rays)), precision, tally)
            spent = (time.perf_counter() - begin) / tally.rays * 1e6
            print(f"{name}, {widened}: {tally}, {spent:.0f} us a ray")


if __name__ == "__main__":
    main()
