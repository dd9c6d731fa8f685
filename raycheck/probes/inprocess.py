"""Tracers inside this process, asked formula by formula: trusted Python objects, and our own."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from oracles.faults import Fault
from oracles.laws import NoAnswerError
from oracles.laws.cases import Question
from raycheck.probes.prober import Reals
from reference_tracer.operations import ANSWERS, formulas
from reference_tracer.rulebook import LECTURE
from scenes.json_form import to_json
from scenes.model import Scene

PARTS = {
    "sphere": (3, 3, 3, 1),
    "plane": (3, 3, 3, 1),
    "normal": (3, 3, 1),
    "reflect": (3, 3),
    "refract": (3, 3, 1),
    "phong": (3, 3, 3, 1),
    "camera": (1, 1),
    "trace": (3, 3),
}
"""Widths of the arguments of a method, in order: 3 is an array (n, 3), 1 an array (n,)."""


class PythonProber:
    """An object whose methods answer a batch of questions at a time; NaN is `miss` or `tir`.

    Arrays are of the tracer's precision; those of `camera` and the exponents of `phong` hold integers.
    """

    def __init__(self, tracer: Callable[[], Any], module: str, attribute: str, precision: str) -> None:
        self.find, self.module, self.attribute = tracer, module, attribute
        self.dtype = np.dtype(precision)
        self.scene: Scene | None = None

    def open(self) -> frozenset[str]:
        """The operations that are methods of the object."""
        tracer = self.find()
        return frozenset(name for name in ANSWERS if callable(getattr(tracer, name, None)))

    def close(self) -> None:
        """Nothing was begun."""

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Call the method of that name."""
        try:
            if scene is not None and scene != self.scene:
                self._show(scene)
            answers = np.asarray(getattr(self.find(), operation)(*self._parts(operation, arguments)), dtype=np.float64)
        except (Exception, SystemExit) as error:  # a stranger's code: whatever it raises is its answer
            raise NoAnswerError("error", f"{operation}: {type(error).__name__}: {error}", operation) from None
        count = ANSWERS[operation]
        shapes = [(len(arguments), count)] + [(len(arguments),)] * (count == 1)
        if answers.shape not in shapes:
            raise NoAnswerError(
                "invalid", f"{operation} gives an array of shape {answers.shape}; expected {shapes[-1]}"
            )
        return answers.reshape(shapes[0])

    def _parts(self, operation: str, arguments: Reals) -> list[Any]:
        found, at = [], 0
        for width in PARTS[operation]:
            part = arguments[:, at] if width == 1 else arguments[:, at : at + width]
            whole = operation == "camera" or (operation == "phong" and width == 1)
            found.append(part.astype(np.int64 if whole else self.dtype))
            at += width
        return found

    def _show(self, scene: Scene) -> None:
        with tempfile.TemporaryDirectory(prefix="raycheck-") as folder:
            path = Path(folder) / f"{scene.name}.json"
            path.write_text(to_json(scene), "utf-8")
            self.find().scene(str(path))
        self.scene = scene

    def line(self, questions: tuple[Question, ...], scenes: Path) -> str:
        """A call of Python with the same arrays."""
        calls = "; ".join(f"print(t.{asked.operation}({self._literals(asked)}))" for asked in _without_scene(questions))
        return f'python -c "from numpy import array; from {self.module} import {self.attribute} as t; {calls}"'

    def _literals(self, asked: Question) -> str:
        parts = self._parts(asked.operation, np.array([asked.arguments]))
        return ", ".join(f"array({part.tolist()}, '{part.dtype}')" for part in parts)


class ReferenceProber:
    """The reference tracer by its rulebook, or by that of a fault, on plain floats or lanes."""

    def __init__(self, arithmetic: str, bits: int, fault: Fault | None = None) -> None:
        self.arithmetic, self.bits, self.fault = arithmetic, bits, fault
        self.ask = formulas(arithmetic, bits, fault.rules if fault else LECTURE)

    def open(self) -> frozenset[str]:
        """All operations."""
        return frozenset(ANSWERS)

    def close(self) -> None:
        """Nothing was begun."""

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """The formulas' answers."""
        return self.ask(operation, arguments, scene)

    def line(self, questions: tuple[Question, ...], scenes: Path) -> str:
        """A call of Python with the same numbers."""
        calls = "; ".join(f"print(f('{q.operation}', array([{list(q.arguments)}])))" for q in _without_scene(questions))
        start = "from numpy import array; from reference_tracer.operations import formulas"
        rules = ""
        if self.fault:
            start, rules = f"{start}; from oracles.faults import fault", f", fault('{self.fault.name}').rules"
        return f"python -c \"{start}; f = formulas('{self.arithmetic}', {self.bits}{rules}); {calls}\""


def _without_scene(questions: tuple[Question, ...]) -> list[Question]:
    """Questions that one line can hold; those about a scene are asked again by the law's own line."""
    return [asked for asked in questions if asked.scene is None]
