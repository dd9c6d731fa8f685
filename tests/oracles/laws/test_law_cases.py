"""A broken law is shown by the plainest case: by bits taken away from a batch's case, and by Hypothesis."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from oracles.laws import Law, Reading, formula_laws
from oracles.laws.cases import examine, simplest
from oracles.laws.dice import Dice
from oracles.laws.exploring import explore
from reference_tracer.operations import formulas
from reference_tracer.rulebook import LECTURE
from reference_tracer.vector import unit
from scenes.model import Scene

SLIP = formulas("numpy", 64, replace(LECTURE, reflect=lambda i, n: unit(n * 2.0 - i)))
RIGHT = formulas("numpy", 64)


def law(name: str) -> Law:
    return next(entry for entry in formula_laws() if entry.name == name)


def nothing(operation: str, arguments: Any, scene: Scene | None = None) -> Any:
    raise AssertionError("not asked")


def above(limit: float) -> Law:
    """Broken where the first coordinate exceeds the limit."""

    def test(dice: Dice, ask: Any) -> Reading:
        x, y = dice.roll(), dice.roll()
        return Reading("x", x + 0.0 * y, np.zeros(dice.count), np.full(dice.count, limit))

    return Law("sphere/test", "", "", "", ("sphere",), test)


def test_a_law_that_holds_has_no_example_and_says_how_many_cases_could_tell() -> None:
    found = examine(law("reflect/angle"), RIGHT, "float64", 0)
    assert found.example is None
    assert found.cases == found.decided == 2000
    assert found.worst <= 1.0


def test_the_example_holds_what_was_asked_and_what_came_back() -> None:
    example = examine(law("reflect/angle"), SLIP, "float64", 0).example
    assert example is not None
    (question,) = example.questions
    assert question.operation == "reflect"
    answer = SLIP("reflect", np.array([question.arguments]))[0]
    assert example.got == pytest.approx(
        float(np.dot(answer, question.arguments[3:])), abs=6 * 2.0**-53
    )  # three products, two sums
    assert abs(example.got - example.expected) / example.bound == example.excess


def test_a_case_is_cut_to_the_fewest_bits_that_still_break_the_law() -> None:
    plain = simplest(above(0.6), nothing, "float64", np.array([0.734375, 0.123]))
    assert plain.tolist() == [0.6875, 0.0]
    assert simplest(above(0.2), nothing, "float64", np.array([0.734375, 0.123])).tolist() == [0.5, 0.0]


def test_of_a_law_that_asks_twice_both_questions_are_told() -> None:
    example = examine(law("reflect/involution"), SLIP, "float64", 0).example
    assert example is not None
    assert [q.operation for q in example.questions] == ["reflect", "reflect"]


def test_hypothesis_finds_and_shrinks_a_broken_law() -> None:
    found = explore(law("reflect/either-normal"), SLIP, "float64", 0, 50)
    assert found.example is not None
    assert found.example.questions[0].arguments == (0.0, 0.0, 1.0, -0.0, -0.0, -1.0)


def test_hypothesis_finds_nothing_wrong_with_a_right_formula() -> None:
    found = explore(law("sphere/nearest-root"), RIGHT, "float64", 0, 60)
    assert found.example is None
    assert found.cases >= 60
    assert found.worst <= 1.0


def test_a_tracer_that_answers_otherwise_each_time_is_told_all_the_same() -> None:
    asked = [0]

    def moody(operation: str, arguments: Any, scene: Scene | None = None) -> Any:
        asked[0] += 1
        return (SLIP if asked[0] % 2 else RIGHT)(operation, arguments)

    assert explore(law("reflect/either-normal"), moody, "float64", 0, 50).example is not None


@pytest.mark.parametrize("seed", [0, 1])
def test_exploring_the_same_seed_asks_the_same_cases(seed: int) -> None:
    def asked() -> list[Any]:
        seen: list[Any] = []

        def ask(operation: str, arguments: Any, scene: Scene | None = None) -> Any:
            seen.append(arguments.tolist())
            return RIGHT(operation, arguments)

        explore(law("plane/meets"), ask, "float64", seed, 20)
        return seen

    assert asked() == asked()


class TestReading:
    def ratio(self, got: float, expected: float, bound: float) -> float:
        parts = (np.array([x]) for x in (got, expected, bound))
        return float(Reading("x", *parts).excess()[0])

    def test_the_excess_is_the_error_in_bounds(self) -> None:
        assert self.ratio(3.0, 1.0, 4.0) == 0.5

    def test_an_exact_answer_needs_no_tolerance(self) -> None:
        assert self.ratio(1.0, 1.0, 0.0) == 0.0
        assert self.ratio(1.0, 1.5, 0.0) == np.inf

    def test_a_missing_number_breaks_the_law_unless_it_cannot_tell(self) -> None:
        assert self.ratio(np.nan, 1.0, 1.0) == np.inf
        assert self.ratio(np.nan, 1.0, np.inf) == 0.0
        assert self.ratio(np.inf, 1.0, 1.0) == np.inf

    def test_two_missing_numbers_agree(self) -> None:
        assert self.ratio(np.nan, np.nan, 1.0) == 0.0
