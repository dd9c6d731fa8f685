"""Mitsuba in a process of its own: pictures asked for by task, problems told in the suite's words."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from oracles.verdict import Process
from raycheck import process
from raycheck.errors import StartError
from raycheck.subjects.child import Child, Reply
from raycheck.subjects.subject import Problem
from raycheck.workspace import workspace
from reference_tracer import llvm
from scenes.json_form import to_json
from scenes.model import Scene

VARIANTS = ("scalar_rgb", "llvm_ad_rgb")
TIMEOUT = 120.0
"""Seconds a picture; the slowest of the catalogue takes two, the first starts Mitsuba."""
HEADER = 2**12


@dataclass(frozen=True)
class Answer:
    """Values (height, width, k) in float32, or the word and message of what went wrong."""

    values: NDArray[np.float32] | None
    word: Problem | None
    message: str
    process: Process
    seconds: float


class MitsubaProcess:
    """Starts when first asked, serves until it dies, and is started again."""

    def __init__(self, variant: str) -> None:
        self.variant = variant
        self.child = Child("oracles.peers.mitsuba_worker", (variant,))

    def prepare(self) -> None:
        """See that Mitsuba is installed, and choose a libLLVM that will not abort it."""
        if find_spec("mitsuba") is None:
            raise StartError("Mitsuba is not installed", "pip install 'raycheck[peers]'")
        if self.variant.startswith("llvm"):
            path = llvm.find()
            if path is None:
                raise StartError(f"Mitsuba's {self.variant} needs a libLLVM that works", llvm.REMEDY)
            self.child.environment = {"DRJIT_LIBLLVM_PATH": path}

    def ask(self, task: str, scene: Scene, seed: int = 0, samples: int = 1) -> Answer:
        """One answer of the worker; see oracles.peers.mitsuba_worker for the tasks."""
        with workspace() as folder:
            scene_file, file = folder / f"{scene.name}.json", folder / f"{scene.name}.npy"
            scene_file.write_text(to_json(scene), "utf-8")
            reply = self.child.ask(f"{task}\t{scene_file}\t{file}\t{seed}\t{samples}", TIMEOUT)
            word, message = _judge(reply)
            values = None if word else _read(file, scene)
        if word is None and values is None:
            word, message = "invalid", "no picture of the right size was written"
        return Answer(values, word, message, self._evidence(reply, message), reply.seconds)

    def evaluate(self, formula: str, rows: NDArray[np.float32]) -> NDArray[np.float32]:
        """Rows of one formula through Mitsuba; raise StartError if it does not answer."""
        with workspace() as folder:
            given, file = folder / "given.npy", folder / "answers.npy"
            np.save(given, rows)
            reply = self.child.ask(f"formula-{formula}\t{given}\t{file}\t0\t1", TIMEOUT)
            word, message = _judge(reply)
            if word:
                raise StartError(f"Mitsuba's {formula}: {message}")
            answers: NDArray[np.float32] = np.load(file, allow_pickle=False)
        return answers

    def _evidence(self, reply: Reply, message: str) -> Process:
        ended = reply.ended
        tail, status = (ended.tail, ended.status) if ended else (message, "still runs")
        return Process(command=self.child.command, status=status, seconds=reply.seconds, output_tail=tail)

    def stop(self) -> None:
        """End the process."""
        self.child.stop()


def _read(file: Path, scene: Scene) -> NDArray[np.float32] | None:
    height, width = scene.image.height, scene.image.width
    try:
        values = np.load(file, allow_pickle=False)
    except (OSError, ValueError):
        return None
    right = values.dtype == np.float32 and values.ndim == 3 and values.shape[:2] == (height, width)
    return values if right else None


def _judge(reply: Reply) -> tuple[Problem | None, str]:
    """What an answer, or the end of the process instead, means."""
    ended = reply.ended
    if ended is None:
        word, _, rest = reply.line.partition(" ")
        match word:
            case "done":
                return None, ""
            case "unsupported":
                return "unsupported", f"a stock Mitsuba cannot say this scene: {rest[:200]}"
        return "error", rest[:200]
    last = ended.tail.splitlines()[-1][:200] if ended.tail else "it printed nothing"
    match ended.how:
        case "timeout":
            return "timeout", f"no picture within {TIMEOUT:g} s"
        case "signal":
            return "crash", f"Mitsuba's process was killed by {process.signal_name(ended.code)}: {last}"
    return "error", f"Mitsuba's process ended with status {ended.code}: {last}"
