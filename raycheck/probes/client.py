"""A tracer's probe command as an `Ask`: greeted, asked in batches, started again after a failure, up to a limit."""

from __future__ import annotations

import math
import os
import shlex
import time
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from oracles.laws import NoAnswerError
from oracles.laws.cases import Question
from raycheck.probes import wire
from raycheck.probes.channel import SPENT, BrokenOffError, Channel
from raycheck.probes.prober import Reals
from raycheck.sandbox.room import OPEN, Room
from raycheck.workspace import workspace
from reference_tracer.operations import ANSWERS
from scenes.model import Scene
from scenes.text import to_text

RESTARTS = 8
"""A tracer that fails more often is not started again."""
PATIENCE = 5.0
"""Seconds for one answer: a formula takes less than a microsecond, a traced ray some milliseconds."""


class ProbeClient:
    """One probe command in its tracer's folder."""

    def __init__(
        self,
        command: tuple[str, ...],
        folder: Path,
        shown: str,
        precision: str,
        patience: float = PATIENCE,
        room: Room = OPEN,
        budget: float = math.inf,
    ) -> None:
        """Shown: the folder as the user named it; precision: what the manifest says; room: where it runs.

        budget: seconds that all its answers together may take.
        """
        self.command, self.folder, self.shown = command, folder, shown
        self.precision, self.patience = precision, patience
        self.starts = 0
        self.channel: Channel | None = None
        self.scene: Scene | None = None
        self.operations: frozenset[str] = frozenset()
        self.room, self.budget = room, budget
        self.held = ExitStack()
        self.files = ExitStack()
        self.papers: Path | None = None

    def open(self) -> frozenset[str]:
        """Start and greet it, if it is not running; the operations it answers."""
        if self.channel is None:
            if self.budget <= 0.0:
                raise NoAnswerError("timeout", f"not asked: {SPENT}")
            if self.starts > RESTARTS:
                raise NoAnswerError("error", f"the probe failed {self.starts} times and is not started again")
            self.starts += 1
            if self.papers is None:
                self.papers = self.files.enter_context(workspace())
                self.papers.chmod(0o755)  # a jail's user is another
            try:
                hold = self.held.enter_context(self.room.hold(read=(self.folder, self.papers), write=()))
                self.channel = Channel(self.command, self.folder, self.patience, hold)
            except OSError as error:
                raise NoAnswerError(
                    "error",
                    f"probe {self.command[0]!r} cannot be started: {error.strerror}; check the path in raycheck.toml",
                ) from None
            self.operations = wire.hello(self._say(f"{wire.HELLO}\n".encode(), 1)[0], self.precision)
        return self.operations

    def close(self) -> None:
        """End the process and remove the files made for it."""
        self._drop()
        self.files.close()
        self.papers = None

    def __call__(self, operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        """Answers (n, m) to arguments (n, k), as the tracer's precision holds them."""
        if operation not in self.open():
            raise NoAnswerError("unsupported", f"the tracer does not answer {operation}")
        if scene is not None and scene != self.scene:
            self._show(scene)
        form = wire.template(operation, arguments.shape[1])
        rows = [tuple(row) for row in arguments.tolist()]
        try:
            lines = self._say("".join(form % row for row in rows).encode(), len(rows))
        except BrokenOffError as error:
            row = rows[min(error.answered, len(rows) - 1)]
            raise NoAnswerError(error.word, error.message, operation, row) from None
        return self._rounded(self._parsed(operation, rows, lines))

    def _parsed(self, operation: str, rows: list[tuple[float, ...]], lines: list[bytes]) -> Reals:
        found = []
        for row, line in zip(rows, lines, strict=True):
            try:
                found.append(wire.answer(operation, line))
            except NoAnswerError as error:
                raise NoAnswerError(error.word, error.message, operation, row) from None
        return np.array(found, dtype=np.float64).reshape(len(rows), ANSWERS[operation])

    def _rounded(self, answers: Reals) -> Reals:
        """A float32 tracer that prints nine digits means the float32 they name."""
        if self.precision == "float64":
            return answers
        with np.errstate(over="ignore"):
            return answers.astype(np.float32).astype(np.float64)

    def _say(self, requests: bytes, count: int) -> list[bytes]:
        """One exchange; after a failure the process is gone."""
        begin = time.monotonic()
        try:
            return self._running().exchange(requests, count, begin + self.budget)
        except BaseException:
            self._drop()
            raise
        finally:
            self.budget -= time.monotonic() - begin

    def _show(self, scene: Scene) -> None:
        """Hand over the scene that the next questions are about."""
        if self.papers is None:
            raise NoAnswerError("error", "the probe was not opened")
        path = self.papers / f"{scene.name}.txt"
        path.write_text(to_text(scene), "utf-8")
        line = self._say(f"scene {path}\n".encode(), 1)[0]
        if line.strip() == b"unsupported":
            raise NoAnswerError("unsupported", "the tracer does not take a scene")
        if line.strip() != b"ok":
            self._drop()
            raise NoAnswerError("invalid", f"{wire.shown(line)} does not answer a scene; expected ok")
        self.scene = scene

    def _running(self) -> Channel:
        if self.channel is None:
            raise NoAnswerError("error", "the probe was not opened")
        return self.channel

    def _drop(self) -> None:
        if self.channel is not None:
            self.channel.close()
        self.held.close()
        self.channel, self.scene = None, None

    def line(self, questions: tuple[Question, ...], scenes: Path) -> str:
        """`printf 'hello 1 ...' | ./tracer --probe`, in the tracer's folder."""
        lines, files = [wire.HELLO], []
        shown: Scene | None = None
        for asked in questions:
            if asked.scene is not None and asked.scene != shown:
                shown = asked.scene
                path = scenes / f"{shown.name}.txt"
                scenes.mkdir(parents=True, exist_ok=True)
                path.write_text(to_text(shown), "utf-8")
                lines.append("scene %s")
                files.append(_from_here(path))
            lines.append(wire.question(asked.operation, asked.arguments))
        said = shlex.quote("\\n".join(lines) + "\\n")
        return " ".join(["printf", said, *files, "|", _inside(self.shown, shlex.join(self.command))])


def _from_here(path: Path) -> str:
    """A shell word for the path, whole although the reader changes its folder."""
    return shlex.quote(str(path)) if path.is_absolute() else f'"$PWD"/{shlex.quote(os.fspath(path))}'


def _inside(folder: str, command: str) -> str:
    return f"(cd {shlex.quote(folder)} && {command})" if folder else command
