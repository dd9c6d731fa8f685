"""The arithmetics in which a method is run: how to time its inner loop, and how to ask it about single rays."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from oracles.chart.timing import Work
from oracles.stability.strata import Bends, Rays
from reference_tracer import exact
from reference_tracer.lanes.backend import Backend, leaves
from reference_tracer.lanes.ball import Ball, Precision
from reference_tracer.numbers import less, select
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec, unit

Reals = NDArray[Any]
SPHERES = 16
"""Tests a ray: the nearest of so many spheres, as in a tracer's inner loop."""
U = 2.0**-53
TINY = 1e-300


@dataclass(frozen=True)
class Answers:
    """About n inputs: values (n,) or (n, 3), NaN for none; bound: how far they may be off, where that is proved."""

    values: Reals
    bound: Reals | None = None


def scenery(rays: int) -> tuple[Reals, Reals, Reals]:
    """Origins and directions (n, 3) that look at SPHERES spheres (SPHERES, 4); the same every time."""
    rng = np.random.default_rng(16)
    v = rng.standard_normal((rays, 3)) * 0.3 + (0.0, 0.0, 1.0)
    v /= np.linalg.norm(v, axis=1, keepdims=True)
    spheres = np.column_stack(
        [rng.uniform(-3, 3, (SPHERES, 2)), rng.uniform(5, 15, SPHERES), rng.uniform(0.5, 2, SPHERES)]
    )
    return np.zeros((rays, 3)), v, spheres


@contextmanager
def one_core(lanes: str) -> Iterator[None]:
    """DrJit's kernels on one thread inside, as NumPy and Python run: formulas are compared, not cores."""
    if lanes != "drjit":
        yield
        return
    import drjit

    before = drjit.thread_count()
    drjit.set_thread_count(1)
    try:
        yield
    finally:
        drjit.set_thread_count(before)


class Lanes:
    """NumPy or DrJit."""

    def __init__(self, backend: Backend, name: str, rays: int) -> None:
        self.backend, self.name, self.rays = backend, name, rays
        self.precision = f"float{backend.precision}"

    def vec(self, rows: Reals) -> Vec:
        """Columns of (n, 3) as lanes."""
        return Vec(*(self.lanes(column) for column in rows.T))

    def lanes(self, values: Reals) -> Any:
        """One array of the backend, never a literal."""
        packed = self.backend.packets([(float(x), 0.0, 0.0, 0.0) for x in values])
        found = self.backend.packet(packed, self.backend.indices(0, len(values)))[0]
        self.backend.evaluate((found,))
        return found

    def loop(self) -> tuple[Vec, Vec, Any, Any, Any]:
        """What the inner loop goes over: rays, spheres, how many these are, and where each ray starts: on none."""
        o, v, spheres = scenery(self.rays)
        table = self.backend.packets([tuple(row) for row in spheres.tolist()])
        nowhere = self.backend.indices(0, self.rays) * 0 - 1
        return self.vec(o), self.vec(v), table, self.backend.count(SPHERES), nowhere

    def sphere_work(self, rules: Rulebook) -> Work:
        """The nearest of SPHERES spheres for many rays; a unit is one test."""
        origin, direction, table, count, nowhere = self.loop()

        def step(k: Any, state: Any) -> Any:
            cx, cy, cz, r = self.backend.packet(table, k)
            formula = rules.sphere_distances
            distance, meets = rules.sphere_hit(formula, origin, direction, Vec(cx, cy, cz), r, nowhere == k, 0.0)
            return (select(meets & (distance < state[0]), distance, state[0]),)

        def run() -> None:
            start = (self.backend.zeros(direction.x) + math.inf,)
            with np.errstate(all="ignore"):
                self._finish(self.backend.fold(count, step, start, lambda state: nowhere < 0))

        return Work(run, self.rays * SPHERES)

    def refract_work(self, rules: Rulebook) -> Work:
        """Refraction of many rays at one plane."""
        _, v, _ = scenery(self.rays)
        direction = self.vec(v)
        zero = self.lanes(np.zeros(self.rays))
        n, index, leaving = Vec(zero, zero, zero - 1.0), zero + 1.5, zero > 1.0
        self.backend.evaluate((n, index))

        def run() -> None:
            with np.errstate(all="ignore"):
                t, total = rules.refract(direction, n, leaving, index)
            self._finish((*t, total))

        return Work(run, self.rays)

    def _finish(self, state: Any) -> None:
        self.backend.evaluate(state)
        if self.backend.name == "drjit":
            import drjit

            drjit.sync_thread()

    def spheres(self, rules: Rulebook, rays: Rays) -> Answers:
        """λ of each ray and its own sphere."""
        with np.errstate(all="ignore"):
            distance, meets = self._hit(rules, rays)
        values = self.backend.numpy(distance).astype(np.float64)
        return Answers(np.where(self.backend.numpy(meets), values, np.nan))

    def _hit(self, rules: Rulebook, rays: Rays) -> Any:
        o, v, c, r = self.vec(rays.o), self.vec(rays.v), self.vec(rays.c), self.lanes(rays.r)
        return rules.sphere_hit(rules.sphere_distances, o, v, c, r, r < 0.0, 0.0)

    def refractions(self, rules: Rulebook, bends: Bends) -> Answers:
        """T of each ray."""
        v, n, index = self.vec(bends.v), self.vec(bends.n), self.lanes(bends.index)
        with np.errstate(all="ignore"):
            facing, leaving = rules.face(v, n)
            t, total = rules.refract(v, facing, leaving, index)
        values = np.stack([self.backend.numpy(part).astype(np.float64) for part in t], axis=-1)
        return Answers(np.where(self.backend.numpy(total)[:, None], np.nan, values))


class BallLanes(Lanes):
    """Balls at u = 2^-53 over float64 lanes: each answer with a bound that is proved."""

    def __init__(self, backend: Backend, name: str, rays: int) -> None:
        super().__init__(backend, name, rays)
        self.ball = Precision(backend.scalar(U), backend.scalar(TINY))

    def lanes(self, values: Reals) -> Ball:
        found = super().lanes(values)
        return Ball(found, found - found, self.ball)

    def sphere_work(self, rules: Rulebook) -> Work:
        origin, direction, table, count, nowhere = self.loop()

        def step(k: Any, state: Any) -> Any:
            cx, cy, cz, r = (self._exact(x) for x in self.backend.packet(table, k))
            formula = rules.sphere_distances
            distance, meets = rules.sphere_hit(formula, origin, direction, Vec(cx, cy, cz), r, nowhere == k, 0.0)
            return (select(meets.value & (distance.mid < state[0].mid), distance, state[0]),)

        def run() -> None:
            zero = self.backend.zeros(direction.x.mid)
            with np.errstate(all="ignore"):
                start = (Ball(zero + math.inf, zero, self.ball),)
                self._finish(tuple(leaves(self.backend.fold(count, step, start, lambda state: nowhere < 0))))

        return Work(run, self.rays * SPHERES)

    def _exact(self, x: Any) -> Ball:
        return Ball(x, x - x, self.ball)

    def spheres(self, rules: Rulebook, rays: Rays) -> Answers:
        with np.errstate(all="ignore"):
            o, c, r = self.vec(rays.o), self.vec(rays.c), self.lanes(rays.r)
            v = unit(self.vec(rays.v))  # a float v is not unit: a proof for it would be of another ray
            distance, meets = rules.sphere_hit(rules.sphere_distances, o, v, c, r, r.mid < 0.0, 0.0)
        hit, sure = self.backend.numpy(meets.value), self.backend.numpy(meets.sure)
        mid, rad = (self.backend.numpy(part).astype(np.float64) for part in distance.parts)
        return Answers(np.where(hit, mid, np.nan), np.where(sure, rad, np.nan))


class Scalars:
    """Python floats, or arb at some precision: one ray after the other."""

    def __init__(self, name: str, precision: str, rays: int, bits: int | None = None) -> None:
        self.name, self.precision, self.rays, self.bits = name, precision, rays, bits
        self.number: Callable[[float], Any] = arb if bits else float

    def sphere_work(self, rules: Rulebook) -> Work:
        """The nearest of SPHERES spheres for a few rays."""
        o, v, spheres = scenery(self.rays)
        balls = [(self.vec(row[:3]), self.number(row[3])) for row in spheres.tolist()]
        rays = [(self.vec(a), self.vec(b)) for a, b in zip(o.tolist(), v.tolist(), strict=True)]

        def run() -> None:
            for origin, direction in rays:
                best = self.number(math.inf)
                for c, r in balls:
                    formula = rules.sphere_distances
                    distance, meets = rules.sphere_hit(formula, origin, direction, c, r, False, 0.0)
                    if meets and less(distance, best):
                        best = distance

        return Work(self._at_precision(run), self.rays * SPHERES)

    def refract_work(self, rules: Rulebook) -> Work:
        """Refraction of a few rays at one plane."""
        _, v, _ = scenery(self.rays)
        n, index = self.vec((0.0, 0.0, -1.0)), self.number(1.5)
        rays = [self.vec(row) for row in v.tolist()]

        def run() -> None:
            for direction in rays:
                rules.refract(direction, n, False, index)

        return Work(self._at_precision(run), self.rays)

    def vec(self, parts: Sequence[float]) -> Vec:
        """Three numbers of this arithmetic."""
        return Vec(*(self.number(part) for part in parts))

    def spheres(self, rules: Rulebook, rays: Rays) -> Answers:
        """λ of each ray and its own sphere."""
        rows = zip(rays.o.tolist(), rays.v.tolist(), rays.c.tolist(), rays.r.tolist(), strict=True)
        found: list[Any] = []

        def run() -> None:
            for o, v, c, r in rows:
                formula = rules.sphere_distances
                centre, direction = self.vec(c), self.vec(v)
                if self.bits:
                    direction = unit(direction)  # as in BallLanes
                try:
                    distance, meets = rules.sphere_hit(
                        formula, self.vec(o), direction, centre, self.number(r), False, 0.0
                    )
                except exact.UndecidedError:
                    distance, meets = arb("nan"), True
                found.append(distance if meets else self.number(math.nan))

        self._at_precision(run)()
        return self._answers(found)

    def refractions(self, rules: Rulebook, bends: Bends) -> Answers:
        """T of each ray."""
        found: list[Any] = []
        for v, n, index in zip(bends.v.tolist(), bends.n.tolist(), bends.index.tolist(), strict=True):
            direction = self.vec(v)
            facing, leaving = rules.face(direction, self.vec(n))
            t, total = rules.refract(direction, facing, leaving, self.number(index))
            found += [math.nan] * 3 if total else list(t)
        return Answers(np.array(found, dtype=np.float64).reshape(-1, 3))

    def _answers(self, found: list[Any]) -> Answers:
        if not self.bits:
            return Answers(np.array(found, dtype=np.float64))
        values = np.array([float(x.mid()) for x in found])
        return Answers(values, np.array([float(x.rad()) for x in found]))

    def _at_precision(self, run: Callable[[], None]) -> Callable[[], None]:
        """The run with arb's precision set, and put back."""
        bits = self.bits
        if bits is None:
            return run

        def within() -> None:
            before = ctx.prec
            ctx.prec = bits
            try:
                run()
            finally:
                ctx.prec = before

        return within


Arithmetic = Lanes | Scalars
