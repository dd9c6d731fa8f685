"""builtin:povray: POV-Ray as a tracer under test, one process a scene."""

from __future__ import annotations

import shutil

import numpy as np

from oracles.images import ImageError, Picture, read
from oracles.peers.cannot import CannotSayError
from oracles.peers.povray_scene import channels, to_povray
from oracles.verdict import Process
from raycheck import process
from raycheck.errors import StartError, UsageError
from raycheck.subjects.subject import Attempt
from raycheck.workspace import workspace
from reference_tracer.dialects import SCENE_MODEL
from scenes.model import Scene

TIMEOUT = 120.0
"""Seconds a picture."""
COMMAND = ("povray", "+Iscene.pov", "+Oscene.exr", "+FE", "-A", "-D", "-GA")
"""EXR, no antialiasing, no window, no statistics; sizes are added."""


class PovraySubject:
    """POV-Ray 3.7 on our scenes; pictures of coloured glass are put together from three grey ones."""

    in_process = False
    scene_form = ""
    image_form = "exr"
    precision = "float32"
    features: tuple[str, ...] | None = None
    dialect = SCENE_MODEL
    spp: int | None = None

    def __init__(self, rest: str) -> None:
        if rest != "povray":
            raise UsageError(f"builtin:{rest}: no such tracer is built in", "builtin:povray")
        self.spec = f"builtin:{rest}"
        self.name = "POV-Ray"

    def prepare(self) -> None:
        """See that it is installed."""
        if shutil.which("povray") is None:
            raise StartError("POV-Ray is not installed", "apt-get install povray")

    def render(self, scene: Scene, seed: int) -> Attempt:
        """One picture, or three of a channel each."""
        attempts = []
        for part in channels(scene):
            attempts.append(_render(part))
            if attempts[-1].picture is None:
                return attempts[-1]
        seconds = sum(attempt.seconds for attempt in attempts)
        if len(attempts) == 1:
            return attempts[0]
        grey = [attempt.picture.values[..., :1] for attempt in attempts if attempt.picture]
        first = attempts[0]
        picture = Picture(np.concatenate(grey, axis=-1), roundoff=first.picture.roundoff if first.picture else 0.0)
        return Attempt(picture, process=first.process, seconds=seconds)


def _render(scene: Scene) -> Attempt:
    try:
        text = to_povray(scene)
    except CannotSayError as error:
        return Attempt(None, "unsupported", f"POV-Ray cannot say this scene: {error}")
    width, height = scene.image.width, scene.image.height
    command = [*COMMAND, f"+W{width}", f"+H{height}"]
    with workspace() as folder:
        (folder / "scene.pov").write_text(text, "utf-8")
        ended = process.run(command, folder, TIMEOUT, 2**24 + 64 * width * height)
        evidence = Process(command=COMMAND, status=ended.status, seconds=ended.seconds, output_tail=ended.tail[-400:])
        if ended.how == "timeout":
            return Attempt(None, "timeout", f"no picture within {TIMEOUT:g} s", evidence, ended.seconds)
        if ended.how == "signal":
            killed = f"killed by {process.signal_name(ended.code)}"
            return Attempt(None, "crash", killed, evidence, ended.seconds)
        if ended.code != 0:
            return Attempt(None, "error", f"exit status {ended.code}: {_reason(ended.tail)}", evidence, ended.seconds)
        try:
            picture = read(folder / "scene.exr", width, height)
        except ImageError as error:
            return Attempt(None, "invalid", str(error), evidence, ended.seconds)
        return Attempt(picture, process=evidence, seconds=ended.seconds)


def _reason(tail: str) -> str:
    """POV-Ray's own words about what is wrong."""
    lines = [line for line in tail.splitlines() if "rror" in line]
    return (lines or tail.splitlines() or ["it printed nothing"])[-1][:200]
