"""The reference tracer asked formula by formula: one row of arguments a question, one row of numbers an answer.

The operations are those of the probe protocol (docs/attaching.md). Answers come from a rulebook's formulas on plain
floats or on lanes; NaN stands for `miss` and `tir`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer.lanes.backend import Backend
from reference_tracer.lanes.floats import Floats
from reference_tracer.lanes.render import backend
from reference_tracer.lanes.tables import Tables
from reference_tracer.lanes.wavefront import Rays, Wavefront
from reference_tracer.numbers import select
from reference_tracer.plain import PlainTracer
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec
from scenes.model import Scene

Reals = NDArray[np.float64]
NOTHING = float("nan")

ARGUMENTS = {"sphere": 10, "plane": 10, "normal": 7, "reflect": 6, "refract": 7, "phong": 10, "camera": 2, "trace": 6}
"""Numbers in a question."""
ANSWERS = {"sphere": 1, "plane": 1, "normal": 3, "reflect": 3, "refract": 3, "phong": 2, "camera": 3, "trace": 3}
"""Numbers in an answer."""


def _sphere(rules: Rulebook, a: list[Any]) -> tuple[Any, ...]:
    o, v, c = Vec(*a[0:3]), Vec(*a[3:6]), Vec(*a[6:9])
    distance, meets = rules.sphere_hit(rules.sphere_distances, o, v, c, a[9], False, 0.0)
    return (select(meets, distance, NOTHING),)


def _plane(rules: Rulebook, a: list[Any]) -> tuple[Any, ...]:
    distance, meets = rules.plane_hit(Vec(*a[0:3]), Vec(*a[3:6]), Vec(*a[6:9]), a[9], True, 0.0)
    return (select(meets, distance, NOTHING),)


def _normal(rules: Rulebook, a: list[Any]) -> tuple[Any, ...]:
    return rules.sphere_normal(Vec(*a[0:3]), Vec(*a[3:6]))


def _reflect(rules: Rulebook, a: list[Any]) -> tuple[Any, ...]:
    return rules.reflect(Vec(*a[0:3]), Vec(*a[3:6]))


def _refract(rules: Rulebook, a: list[Any]) -> tuple[Any, ...]:
    v, outward = Vec(*a[0:3]), Vec(*a[3:6])
    n, leaving = rules.face(v, outward)
    t, total = rules.refract(v, n, leaving, a[6])
    return tuple(select(total, NOTHING, part) for part in t)


def _phong(rules: Rulebook, a: list[Any], shininess: Any) -> tuple[Any, ...]:
    i, n, v = Vec(*a[0:3]), Vec(*a[3:6]), Vec(*a[6:9])
    return rules.lambert(i, n), rules.phong(i, n, v, shininess, rules.reflect(i, n))


_FORMULAS: dict[str, Callable[[Rulebook, list[Any]], tuple[Any, ...]]] = {
    "sphere": _sphere,
    "plane": _plane,
    "normal": _normal,
    "reflect": _reflect,
    "refract": _refract,
}


@dataclass(frozen=True)
class PlainFormulas:
    """A rulebook on Python floats, row by row."""

    rules: Rulebook = LECTURE

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Answers (n, m) to arguments (n, k)."""
        answer = self._scene_formula(operation, scene) if scene else lambda row: self._row(operation, row)
        found = [tuple(answer(row)) for row in arguments.tolist()]
        return np.array(found, dtype=np.float64).reshape(len(arguments), ANSWERS[operation])

    def _row(self, operation: str, row: list[float]) -> tuple[Any, ...]:
        if operation == "phong":
            return _phong(self.rules, row, int(row[9]))
        return _FORMULAS[operation](self.rules, row)

    def _scene_formula(self, operation: str, scene: Scene) -> Callable[[list[float]], tuple[Any, ...]]:
        tracer = PlainTracer(scene, self.rules)
        if operation == "camera":
            return lambda row: tracer.eye_ray(int(row[0]), int(row[1]))
        return lambda row: tracer.find_rgb(Vec(*row[0:3]), Vec(*row[3:6]), None, 0)


@dataclass(frozen=True)
class LaneFormulas:
    """A rulebook on lanes, a batch at a time; `reals` and `whole` make lanes of a NumPy array."""

    lanes: Backend
    reals: Callable[[Reals], Any]
    whole: Callable[[NDArray[np.int64]], Any]
    rules: Rulebook = LECTURE

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Answers (n, m) to arguments (n, k)."""
        with np.errstate(all="ignore"):  # lanes without a hit may divide by zero
            parts = self._about(scene, operation, arguments) if scene else self._plain(operation, arguments)
        columns = [np.asarray(self.lanes.numpy(part), dtype=np.float64) for part in parts]
        return np.stack([np.broadcast_to(column, len(arguments)) for column in columns], axis=1)

    def _plain(self, operation: str, arguments: Reals) -> tuple[Any, ...]:
        columns = [self.reals(column) for column in arguments.T]
        if operation == "phong":
            return _phong(self.rules, columns, self.whole(arguments[:, 9].astype(np.int64)))
        return _FORMULAS[operation](self.rules, columns)

    def _about(self, scene: Scene, operation: str, arguments: Reals) -> tuple[Any, ...]:
        front = Wavefront(scene, self.rules, self.lanes, Floats(), Tables(scene, self.lanes))
        if operation == "camera":
            pixel = arguments[:, 1] * scene.image.width + arguments[:, 0]
            return front.eye_rays(self.whole(pixel.astype(np.int64))).v
        columns = [self.reals(column) for column in arguments.T]
        nowhere = self.lanes.indices(0, len(arguments)) * 0 - 1
        colour, _ = front.trace(Rays(Vec(*columns[0:3]), Vec(*columns[3:6]), nowhere), 0)
        return colour


def formulas(arithmetic: str, precision: int, rules: Rulebook = LECTURE) -> PlainFormulas | LaneFormulas:
    """The rulebook on `plain` floats (64 bits) or on `numpy` or `drjit` lanes."""
    if arithmetic == "plain":
        return PlainFormulas(rules)
    lanes = backend(arithmetic, precision)
    if arithmetic == "numpy":
        dtype = np.float32 if precision == 32 else np.float64
        return LaneFormulas(lanes, lambda column: column.astype(dtype), lambda column: column, rules)
    from drjit import llvm

    real = llvm.Float if precision == 32 else llvm.Float64
    return LaneFormulas(lanes, lambda column: real(np.ascontiguousarray(column)), llvm.Int32, rules)
