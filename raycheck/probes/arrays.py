"""A prober as measurements ask it: arrays in, arrays out, and what is no number is no hit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.laws import NoAnswerError
from oracles.measurement import Precision
from raycheck.errors import StartError
from raycheck.probes.prober import Prober, Reals
from reference_tracer.operations import ANSWERS


@dataclass
class UnansweredError(StartError):
    """A tracer gave no usable answer; word: that of its verdict."""

    word: str = "error"


@dataclass(frozen=True)
class ArrayProbe:
    """A tracer's answers about spheres and refraction, of its precision."""

    name: str
    precision: Precision
    prober: Prober

    def sphere(self, o: NDArray[Any], v: NDArray[Any], c: NDArray[Any], r: NDArray[Any]) -> Reals:
        """λ > 0 of the nearest hit, (n,); NaN for a miss."""
        return self._asked("sphere", np.column_stack([o, v, c, r]))[:, 0]

    def refract(self, v: NDArray[Any], n: NDArray[Any], index: NDArray[Any]) -> Reals:
        """Direction t, (n, 3); NaN under total reflection."""
        return self._asked("refract", np.column_stack([v, n, index]))

    def _asked(self, operation: str, rows: NDArray[Any]) -> Reals:
        try:
            return self._answers(operation, rows.astype(np.float64))
        except NoAnswerError as error:
            raise UnansweredError(f"{self.name}: {error}", word=error.word) from None

    def _answers(self, operation: str, rows: Reals) -> Reals:
        """All answers; where formulas fail, tracers print `nan` or `inf`, which must not end the measurement."""
        try:
            return self.prober(operation, rows)
        except NoAnswerError as error:
            if error.word != "invalid" or not error.arguments:
                raise
        if len(rows) == 1:
            return np.full((1, ANSWERS[operation]), np.nan)
        half = len(rows) // 2
        return np.concatenate([self._answers(operation, rows[:half]), self._answers(operation, rows[half:])])
