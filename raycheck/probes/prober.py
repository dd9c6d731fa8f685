"""What a tracer that answers formula by formula looks like, whatever it is made of."""

from __future__ import annotations

from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from oracles.laws.cases import Question
from scenes.model import Scene

Reals = NDArray[np.float64]


class Prober(Protocol):
    """An `Ask` of the laws with a beginning and an end."""

    def open(self) -> frozenset[str]:
        """The operations it answers; raise NoAnswerError where it cannot say so."""

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Answers (n, m) to arguments (n, k); NaN for `miss` and `tir`; raise NoAnswerError where there is none."""

    def line(self, questions: tuple[Question, ...], scenes: Path) -> str:
        """One command that asks these questions again; files of scenes go into the folder `scenes`."""

    def close(self) -> None:
        """End what was begun."""
