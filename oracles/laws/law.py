"""What a law is: one physical statement, asked of a tracer's formulas a batch of cases at a time.

A formula law is a pure function of a case and a tracer. The case is made from coordinates in [0, 1]
(`Dice`), so that the same function serves a seeded batch, one case under Hypothesis, and a failing
case that is being made simpler: towards coordinate 0 a case is plainer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from oracles.laws.dice import Dice
from scenes.model import Scene

Reals = NDArray[np.float64]


class Ask(Protocol):
    """A tracer's formulas: one row of arguments a question, one row of numbers an answer; NaN is `miss` or `tir`."""

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Answers (n, m) to arguments (n, k); `camera` and `trace` are asked about a scene."""


@dataclass(frozen=True)
class Reading:
    """What a law found: |got - expected| <= bound in every column of every case.

    quantity: what the numbers are, in words; got, expected, bound: (n,) or (n, columns). A case in which
    the law cannot tell at the tracer's precision has the bound infinity.
    """

    quantity: str
    got: Reals
    expected: Reals
    bound: Reals

    def ratios(self) -> Reals:
        """Error in tolerances, (n, columns): over 1 breaks the law; infinite where a number is missing."""
        got, expected, bound = np.broadcast_arrays(*(_columns(part) for part in (self.got, self.expected, self.bound)))
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            error = np.abs(got - expected)
            ratio = np.where(error == 0.0, 0.0, error / bound)
        missing = np.where(np.isnan(got) & np.isnan(expected), 0.0, np.inf)  # two answers may agree that there is none
        ratio = np.where(np.isnan(ratio), missing, ratio)
        return np.where(bound == np.inf, 0.0, ratio)

    def excess(self) -> Reals:
        """The largest ratio of each case, (n,)."""
        worst: Reals = self.ratios().max(axis=1)
        return worst

    def decided(self) -> NDArray[np.bool_]:
        """The cases in which the law can tell, (n,)."""
        bound = np.broadcast_to(_columns(self.bound), _columns(self.got).shape)
        some: NDArray[np.bool_] = np.any(np.isfinite(bound), axis=1)
        return some


def _columns(part: Reals) -> Reals:
    part = np.asarray(part, dtype=np.float64)
    return part[:, None] if part.ndim == 1 else part


@dataclass(frozen=True)
class Law:
    """One statement about a tracer's formulas.

    name: FORMULA/STATEMENT; statement: in one sentence; slide: of L11, by title; formula: in one line;
    asks: the operations it puts to the tracer. The physics, the assumptions and the reason of the
    tolerance are the docstring of `test`.
    """

    name: str
    statement: str
    slide: str
    formula: str
    asks: tuple[str, ...]
    test: Callable[[Dice, Ask], Reading]

    @property
    def reason(self) -> str:
        """The docstring of the law's function."""
        return (self.test.__doc__ or "").strip()


class NoAnswerError(Exception):
    """A tracer gave no usable answer.

    word: invalid, crash, timeout, error or unsupported; message: what happened; operation, arguments: the question.
    """

    def __init__(self, word: str, message: str, operation: str = "", arguments: tuple[float, ...] = ()) -> None:
        super().__init__(message)
        self.word, self.message = word, message
        self.operation, self.arguments = operation, arguments


_LAWS: dict[str, Law] = {}


def law(
    name: str, statement: str, slide: str, formula: str, *asks: str
) -> Callable[[Callable[[Dice, Ask], Reading]], Callable[[Dice, Ask], Reading]]:
    """Enter the function into the book of laws."""

    def enter(test: Callable[[Dice, Ask], Reading]) -> Callable[[Dice, Ask], Reading]:
        _LAWS[name] = Law(name, statement, slide, formula, asks or (name.split("/")[0],), test)
        return test

    return enter


def entered() -> tuple[Law, ...]:
    """All laws entered so far, in order."""
    return tuple(_LAWS.values())
