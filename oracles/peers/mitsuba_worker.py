"""The process Mitsuba runs in: a line per picture in, a line per picture out.

`python -m oracles.peers.mitsuba_worker VARIANT` reads lines `TASK<tab>SCENE<tab>FILE<tab>SEED<tab>SAMPLES` from stdin
and answers each with `done SECONDS`, `unsupported REASON` or `error MESSAGE` on what was stdout; whatever else is
printed goes to stderr. It ends with stdin. The task `formula-NAME` reads rows (.npy) in place of a scene.
"""

from __future__ import annotations

import importlib
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

import numpy as np
from numpy.typing import NDArray

from oracles.peers.cannot import CannotSayError
from oracles.peers.mitsuba_formulas import evaluate
from oracles.peers.mitsuba_start import start
from scenes.files import load
from scenes.model import Scene

Task = Callable[[Any, Scene, int, int], "NDArray[np.float32]"]
TASKS = {"lecture": "mitsuba_whitted", "stock": "mitsuba_stock", "path": "mitsuba_path", "aov": "mitsuba_aov"}
"""Module of oracles.peers whose `render(mi, scene, seed, samples)` does each task."""


def main() -> None:
    """Answer until stdin ends."""
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    mi = start(sys.argv[1])
    for line in sys.stdin:
        reply(replies, *_answer(mi, *line.rstrip("\n").split("\t")))


def reply(replies: TextIO, word: str, rest: str) -> None:
    """One line, sent at once."""
    print(word, " ".join(rest.split()), file=replies, flush=True)


def _answer(mi: Any, task: str, scene: str, file: str, seed: str, samples: str) -> tuple[str, str]:
    try:
        if task.startswith("formula-"):
            np.save(file, evaluate(mi, task.removeprefix("formula-"), np.load(scene)))
            return "done", "0.0"
        render: Task = importlib.import_module(f"oracles.peers.{TASKS[task]}").render
        read = load(Path(scene))
        begin = time.monotonic()
        values = render(mi, read, int(seed), int(samples))
        seconds = time.monotonic() - begin
        np.save(file, values)
    except CannotSayError as error:
        return "unsupported", str(error)
    except Exception as error:  # whatever the peer raises is its answer
        return "error", f"{type(error).__name__}: {error}"[:2000]
    return "done", repr(seconds)


if __name__ == "__main__":
    main()
