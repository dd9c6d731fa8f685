"""Containment: what a tracer may compute inside every bound, over millions of random rays.

Balls of u = 2^-53 against exact values at 320 bits; affine forms of u = 2^-23 against lanes that err by up to 2^-24 in
every operation, from inputs anywhere in the forms; whole pixels of random scenes in random dialects likewise.
Strata: distance/radius log-uniform to 10^5, grazing |1 - s| log-uniform to 10^-12, refraction and reflection near
normal incidence, near the critical angle, and anywhere. Prints violations (there must be none) and sure
decisions that were wrong (likewise), what happens when the widening is taken out, and how wide certified bounds are.
"""

from __future__ import annotations

import functools
import random
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from oracles.truth import truth
from raycheck.machine import machine
from reference_tracer import certified, dialects, exact, llvm
from reference_tracer.formulas import optics, sphere
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes import sloppy
from reference_tracer.lanes.affine import Affine
from reference_tracer.lanes.ball import UNDERFLOW_32, UNDERFLOW_64, Ball, Doubtful, Precision
from reference_tracer.vector import Vec, unit
from scenes.catalogue import rung
from scenes.random_scenes import random_scene

DOUBLE = Precision(2.0**-53, UNDERFLOW_64)
SINGLE = Precision(2.0**-23, UNDERFLOW_32)
SYMBOLS = 6
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
    if isinstance(like, sloppy.Sloppy):
        return like.value < -1.0
    return like.mid < -1.0 if isinstance(like, Ball | Affine) else False


def far_and_grazing(rng: np.random.Generator, n: int, far: float = 5.0, graze: float = -12.0) -> tuple[Reals, ...]:
    """Rays that pass a sphere 10^0.2 to 10^far radii away, at impact parameter s, |1 - s| from 1 down to 10^graze."""
    D = 10.0 ** rng.uniform(0.2, far, n)
    s = 1.0 - 10.0 ** rng.uniform(graze, 0.0, n) * rng.choice([-1.0, 1.0], n)
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


def check_affine(case: Callable[..., Any], rays: tuple[Reals, ...], seed: int, tally: Tally) -> None:
    """Compare affine forms with lanes that err in every operation."""
    rng = np.random.default_rng(seed)
    n = rays[-1].size
    share = np.clip(rng.uniform(-2.0, 2.0, (SYMBOLS, n)), -1.0, 1.0)
    size = 10.0 ** rng.uniform(-10.0, -4.0, n)
    error = sloppy.Error(2.0**-24, seed)

    def drawn(x: Reals) -> tuple[Affine, sloppy.Sloppy]:
        dev = size * np.abs(x) * rng.uniform(-1.0, 1.0, (SYMBOLS, n))
        rest = size * np.abs(x) * rng.choice([0.0, 0.1], n)
        # The drawn value is itself computed in float64: the form is that much wider
        form = Affine(x, rest + 2.0**-50 * np.abs(x), SINGLE, dev)
        return form, sloppy.Sloppy(x + (dev * share).sum(axis=0) + rest * rng.uniform(-1.0, 1.0, n), error)

    *vectors, scalar = [[drawn(x) for x in vector] if np.ndim(vector) > 1 else drawn(vector) for vector in rays]
    with np.errstate(all="ignore"):
        forms, decision = case(*(Vec(*(pair[0] for pair in v)) for v in vectors), scalar[0])
        values, answer = case(*(Vec(*(pair[1] for pair in v)) for v in vectors), scalar[1])
    sure = np.broadcast_to(decision.sure, n)
    tally.rays += n
    tally.undecided += int(np.count_nonzero(~sure))
    tally.decisions += int(np.count_nonzero(sure))
    tally.wrong += int(np.count_nonzero(sure & (decision.value != answer)))
    for form, value in zip(forms, values, strict=True):
        known = sure & np.isfinite(form.rad) & np.isfinite(form.mid)
        tally.values += int(np.count_nonzero(known))
        tally.outside += int(np.count_nonzero(known & ~(np.abs(value.value - form.mid) <= form.rad)))


def pixels(scenes: int) -> tuple[int, int]:
    """Pixels of random scenes, every second in a random dialect, and how many lie outside a float32 tracer's bound."""
    looked, outside = 0, 0
    for seed in range(10_000, 10_000 + scenes):
        chance = random.Random(seed)  # noqa: S311 - scenes, not secrets
        choices = {key: chance.choice(words) for key, words in dialects.CHOICES.items()} if seed % 2 else {}
        rules = dialects.rules(dialects.Dialect(**choices))
        scene = random_scene(seed)
        expected = truth(scene, "float32", rules=rules)
        for k in range(2):
            got = sloppy.render(scene, 2.0**-24, 2 * seed + k, rules).pixels
            wrong = ~(np.abs(got - expected.pixels) <= expected.tolerance)
            looked += wrong[..., 0].size
            outside += int(np.count_nonzero(wrong.any(axis=-1)))
    return looked, outside


def certified_bounds() -> None:
    """How wide the bounds of the lecture's final picture are at u = 2^-53, before and after exact numbers."""
    scene = rung("lecture-final").scene().resized(640, 480)
    backend = lanes.backend("drjit" if llvm.find() else "numpy", 64)
    before = lanes.enclose(scene, backend, 2.0**-53, 0.0)
    doubt = before.doubts != 0
    begin = time.perf_counter()
    after = certified.render(scene, backend)
    spent = time.perf_counter() - begin
    print(f"lecture-final 640x480 at u = 2^-53: {doubt.sum()} pixels undecided ({doubt.mean():.4%}) before exact,")
    print(f"  {np.count_nonzero(~after.decided)} after; {spent:.1f} s in all; bits {np.unique(after.bits).tolist()}")
    for words, bound in (("before", before.radius), ("after", after.bound)):
        found = np.quantile(bound.max(axis=-1), [0.5, 0.9, 0.99, 0.999, 1.0], method="higher")
        print(f"  bound {words}: median, 90 %, 99 %, 99.9 %, worst " + ", ".join(f"{x:.2g}" for x in found))
    tracer = exact.ExactTracer(scene)
    places = [(i, j) for i in range(7, 640, 20) for j in range(5, 480, 20)]
    begin = time.perf_counter()
    for i, j in places:
        tracer.pixel(i, j)
    print(f"  exact: {(time.perf_counter() - begin) / len(places) * 1e6:.0f} us a pixel over {len(places)} pixels")


CASES = {"sphere": (sphere_case, far_and_grazing), "reflect and refract": (snell_case, refractions)}


def balls(total: int) -> None:
    """Balls against exact numbers, and without their widening."""
    ctx.prec = BITS
    for widened, precision in (("as proved", DOUBLE), ("widening removed", Precision(0.0, 0.0))):
        for name, (case, rays) in CASES.items():
            rng = np.random.default_rng(2026)
            tally = Tally()
            begin = time.perf_counter()
            count = total // 2 if precision is DOUBLE else 20_000
            while tally.rays < count:
                check(case, rays(rng, min(CHUNK, count - tally.rays)), precision, tally)
            spent = (time.perf_counter() - begin) / tally.rays * 1e6
            print(f"balls, {name}, {widened}: {tally}, {spent:.0f} us a ray", flush=True)


def affine(total: int) -> None:
    """Affine forms against lanes that err."""
    near = {**CASES, "sphere": (sphere_case, functools.partial(far_and_grazing, far=2.0, graze=-5.0))}
    for name, (case, rays) in near.items():
        rng = np.random.default_rng(2027)
        tally = Tally()
        while tally.rays < total // 2:
            check_affine(case, rays(rng, CHUNK), tally.rays, tally)
        print(f"affine, {name}: {tally}", flush=True)


def main() -> None:
    """Run all strata; the number of rays is the first argument, the number of random scenes the second."""
    total = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    scenes = int(sys.argv[2]) if len(sys.argv) > 2 else 400
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}", flush=True)
    affine(total)
    looked, outside = pixels(scenes)
    print(f"pixels of {scenes} random scenes: {looked} traced, {outside} outside", flush=True)
    certified_bounds()
    balls(total)


if __name__ == "__main__":
    main()
