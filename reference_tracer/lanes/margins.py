"""How clear the decisions on a ray's path are: the smallest relative margin of any of them.

A decision's margin is what would have to change for it to fall the other way, as a plain number:

- a sphere met or missed: |D|/r², D the discriminant of the quadratic,
- a plane met or not: |n∘v|, n its unit normal,
- the nearest of two objects: the gap of their distances over the nearer one,
- total reflection: |1 - sin²θ2|, asked of transparent surfaces,
- a light in front of the surface or behind it: |i∘n|.

On NumPy lanes in float64, with the rulebook's own formulas watched while they run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer.lanes.floats import Floats, Nearest
from reference_tracer.lanes.wavefront import CRITICAL, SHADOW
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec, dot, length

Reals = NDArray[np.float64]


class Margins(Floats):
    """Floats whose doubts are the greatest 1/margin so far; 0 where nothing was decided."""

    def __init__(self, rules: Rulebook) -> None:
        self.watched = rules
        self.sharpest: Any = 0.0
        self.critical: Any = 0.0
        self.facing: Any = 0.0
        self.hit: Any = False

    def rules(self) -> Rulebook:
        """The rulebook, its decisions watched."""
        return replace(
            self.watched,
            sphere_hit=self._sphere_hit,
            plane_hit=self._plane_hit,
            refract=self._refract,
            lambert=self._lambert,
        )

    def none_yet(self, real: Any, integer: Any) -> Any:
        self.sharpest = np.zeros(np.shape(integer))
        return (*super().none_yet(real, integer), real + float("inf"))

    def consider(self, state: Any, rules: Rulebook, distance: Any, meets: Any, row: Any) -> Any:
        best, best_row, second = state
        after = super().consider((best, best_row), rules, distance, meets, row)
        beaten = np.where(after[1] == row, best, np.where(meets, distance, float("inf")))
        return (*after, np.minimum(second, beaten))

    def settle(self, state: Any) -> tuple[Nearest, Any]:
        best, row, second = state
        self.hit = row >= 0
        gap = _inverse((second - best) / best)
        return Nearest(best, row), np.maximum(self.sharpest, np.where(np.isfinite(second), gap, 0.0))

    def surely(self, condition: Any) -> Any:
        """Nowhere: a shadow ray asks all objects, so that a margin does not depend on its neighbours."""
        return np.zeros_like(condition)

    def matters(self, colour: Vec) -> Any:
        self.sharpest = 0.0  # a new shadow ray, asked of these lanes only
        return super().matters(colour)

    def doubt(self, doubts: Any, kind: int, condition: Any, matters: Any) -> Any:
        if kind == SHADOW:
            seen = np.where(matters, np.maximum(self.facing, self.sharpest), self.facing)
            return np.maximum(doubts, np.where(self.hit, seen, 0.0))
        return np.maximum(doubts, np.where(matters, self.critical, 0.0)) if kind == CRITICAL else doubts

    def join(self, doubts: Any, *others: Any) -> Any:
        for other in others:
            doubts = np.maximum(doubts, other)
        return doubts

    def _sphere_hit(
        self, distances: Callable[..., Any], o: Vec, v: Vec, c: Vec, r: Any, starts_here: Any, start: Any
    ) -> Any:
        def watched(b: Vec, bv: Any, v: Vec, r: Any) -> Any:
            near, far, D = distances(b, bv, v, r)
            asked = np.where(starts_here, 0.0, _inverse(np.abs(D) / (r * r)))
            self.sharpest = np.maximum(self.sharpest, asked)
            return near, far, D

        return self.watched.sphere_hit(watched, o, v, c, r, starts_here, start)

    def _plane_hit(self, o: Vec, v: Vec, normal: Vec, offset: Any, starts_elsewhere: Any, *ends: Any) -> Any:
        asked = _inverse(np.abs(dot(normal, v)) / length(normal))
        self.sharpest = np.maximum(self.sharpest, np.where(starts_elsewhere, asked, 0.0))
        return self.watched.plane_hit(o, v, normal, offset, starts_elsewhere, *ends)

    def _refract(self, v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
        along = dot(v, n)
        ratio = np.where(leaving, index, 1.0 / index)
        self.critical = _inverse(np.abs(1.0 - (1.0 - along * along) * (ratio * ratio)))
        return self.watched.refract(v, n, leaving, index)

    def _lambert(self, i: Vec, n: Vec) -> Any:
        self.facing = _inverse(np.abs(dot(i, n)))
        return self.watched.lambert(i, n)


def _inverse(margin: Any) -> Reals:
    """1/margin, without end for a tie."""
    found: Reals = np.where(margin > 0.0, 1.0 / np.where(margin > 0.0, margin, 1.0), float("inf"))
    return found
