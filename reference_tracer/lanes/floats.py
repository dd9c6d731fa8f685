"""What the wavefront asks of its numbers, and the plain answer: every comparison is certain.

`Floats` and `reference_tracer.lanes.balls.Balls` are the two ways to read numbers, to keep the
nearest hit and to note what could not be decided.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

from reference_tracer.formulas.plane import NEVER
from reference_tracer.numbers import select
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec


class Nearest(NamedTuple):
    """The nearest hit: λ and the object's row (-1: none)."""

    distance: Any
    row: Any


class Numbers(Protocol):
    """What the wavefront asks of its numbers: how to read them, and what to make of a doubt."""

    def read(self, array: Any) -> Any:
        """A number of the scene."""

    def exact(self, array: Any) -> Any:
        """A number known exactly, such as a pixel index."""

    def start(self) -> Any:
        """How far from its start a ray may first meet something."""

    def again(self) -> Any:
        """How far from its start a ray that does not know where it starts may meet its own plane."""

    def fresh(self, o: Vec, v: Vec) -> tuple[Vec, Vec]:
        """Origin and direction of a generation's rays, as it begins."""

    def surely(self, condition: Any) -> Any:
        """Where the condition certainly holds."""

    def matters(self, colour: Vec) -> Any:
        """Where a colour is other than black."""

    def possible(self, weight: Vec) -> Any:
        """Where a weight may be other than 0."""

    def none_yet(self, real: Any, integer: Any) -> Any:
        """No hit so far; `real` and `integer` are lanes of zeros."""

    def consider(self, state: Any, rules: Rulebook, distance: Any, meets: Any, row: Any) -> Any:
        """Take the hit if it is nearer."""

    def settle(self, state: Any) -> tuple[Nearest, Any]:
        """The nearest hit, and the doubts about it."""

    def doubt(self, doubts: Any, kind: int, condition: Any, matters: Any) -> Any:
        """Note an uncertain condition."""

    def bounded(self, colour: Vec, doubts: Any, generation: int) -> Vec:
        """The colour of a ray, as far as it is known."""

    def join(self, doubts: Any, *others: Any) -> Any:
        """All doubts of a ray and its branches."""


class Floats:
    """Plain lanes: numbers as they are, no doubts."""

    def read(self, array: Any) -> Any:
        return array

    def exact(self, array: Any) -> Any:
        return array

    def start(self) -> Any:
        return 0.0

    def again(self) -> Any:
        return NEVER

    def fresh(self, o: Vec, v: Vec) -> tuple[Vec, Vec]:
        return o, v

    def surely(self, condition: Any) -> Any:
        return condition

    def matters(self, colour: Vec) -> Any:
        return (colour.x != 0.0) | (colour.y != 0.0) | (colour.z != 0.0)

    possible = matters

    def none_yet(self, real: Any, integer: Any) -> Any:
        return (real + float("inf"), integer - 1)

    def consider(self, state: Any, rules: Rulebook, distance: Any, meets: Any, row: Any) -> Any:
        best, best_row = state
        wins = meets & ((best_row < 0) | rules.nearer(distance, best, row, best_row))
        return (select(wins, distance, best), select(wins, row, best_row))

    def settle(self, state: Any) -> tuple[Nearest, Any]:
        return Nearest(*state), ()

    def doubt(self, doubts: Any, kind: int, condition: Any, matters: Any) -> Any:
        return doubts

    def bounded(self, colour: Vec, doubts: Any, generation: int) -> Vec:
        return colour

    def join(self, doubts: Any, *others: Any) -> Any:
        return doubts
