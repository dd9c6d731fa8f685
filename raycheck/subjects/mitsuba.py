"""builtin:mitsuba[/VARIANT]: Mitsuba 3 as a tracer under test, in a process of its own."""

from __future__ import annotations

from importlib.util import find_spec

from oracles.images import ImageError, read
from oracles.verdict import Process
from raycheck import process
from raycheck.errors import StartError, UsageError
from raycheck.subjects.child import Child, Reply
from raycheck.subjects.subject import Attempt, Problem
from raycheck.workspace import workspace
from reference_tracer import llvm
from scenes.json_form import to_json
from scenes.model import Scene

VARIANTS = ("scalar_rgb", "llvm_ad_rgb")
TIMEOUT = 120.0
"""Seconds a picture; the slowest of the catalogue takes two, the first starts Mitsuba."""
WORKER = "oracles.peers.mitsuba_worker"


class MitsubaSubject:
    """The lecture's model on Mitsuba's primitives; one process serves all scenes until it dies."""

    in_process = False
    scene_form = "json"
    image_form = "npy"
    precision = "float32"
    features: tuple[str, ...] | None = None

    def __init__(self, rest: str) -> None:
        _, *options = rest.split("/")
        self.variant = options[0] if options else VARIANTS[0]
        self.spec = f"builtin:{rest}"
        if self.variant not in VARIANTS or len(options) > 1:
            raise UsageError(f"{self.spec}: no such variant", "builtin:mitsuba/" + "|".join(VARIANTS))
        self.name = f"Mitsuba 3 ({self.variant})"
        self.child = Child(WORKER, (self.variant,))

    def prepare(self) -> None:
        """See that Mitsuba is installed, and choose a libLLVM that will not abort it."""
        if find_spec("mitsuba") is None:
            raise StartError("Mitsuba is not installed", "pip install 'raycheck[peers]'")
        if self.variant.startswith("llvm"):
            path = llvm.find()
            if path is None:
                raise StartError(f"{self.spec} needs a libLLVM that works", llvm.REMEDY)
            self.child.environment = {"DRJIT_LIBLLVM_PATH": path}

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Write the scene, ask for its picture, read it; nothing in it is random."""
        with workspace() as folder:
            scene_file, image_file = folder / f"{scene.name}.json", folder / f"{scene.name}.npy"
            scene_file.write_text(to_json(scene), "utf-8")
            reply = self.child.ask(f"image\t{scene_file}\t{image_file}", TIMEOUT)
            word, message = _judge(reply)
            evidence = self._evidence(reply, message)
            if word is None:
                try:
                    picture = read(image_file, scene.image.width, scene.image.height)
                    return Attempt(picture, process=evidence, seconds=reply.seconds)
                except ImageError as error:
                    word, message = "invalid", str(error)
        return Attempt(None, word, message, evidence, reply.seconds)

    def _evidence(self, reply: Reply, message: str) -> Process:
        if reply.ended is None:
            return Process(command=self.child.command, status="still runs", seconds=reply.seconds, output_tail=message)
        tail, status = reply.ended.tail, reply.ended.status
        return Process(command=self.child.command, status=status, seconds=reply.seconds, output_tail=tail)


def _judge(reply: Reply) -> tuple[Problem | None, str]:
    """What an answer, or the end of the process instead, means."""
    ended = reply.ended
    if ended is None:
        word, _, rest = reply.line.partition(" ")
        return (None, "") if word == "done" else ("error", rest[:200])
    last = ended.tail.splitlines()[-1][:200] if ended.tail else "it printed nothing"
    match ended.how:
        case "timeout":
            return "timeout", f"no picture within {TIMEOUT:g} s"
        case "signal":
            return "crash", f"Mitsuba's process was killed by {process.signal_name(ended.code)}: {last}"
    return "error", f"Mitsuba's process ended with status {ended.code}: {last}"
