"""builtin:fault/NAME: our own tracer with one entry of the dictionary of faults."""

from __future__ import annotations

import time

from oracles.faults import fault
from oracles.faults.power import picture
from oracles.images import ImageError
from oracles.images.picture import check
from raycheck.errors import UsageError
from raycheck.subjects.subject import Attempt
from reference_tracer.dialects import SCENE_MODEL
from scenes.model import Scene


class FaultSubject:
    """builtin:fault/NAME[/32|64]: the reference on NumPy lanes of that precision, by the fault's rules."""

    in_process = True
    scene_form = ""
    image_form = ""
    features: tuple[str, ...] | None = None
    spp: int | None = None
    dialect = SCENE_MODEL

    def __init__(self, spec: str) -> None:
        self.spec = f"builtin:{spec}"
        _, *options = spec.split("/")
        bits = options[1] if len(options) > 1 else "32"
        if not options or len(options) > 2 or bits not in ("32", "64"):
            raise UsageError(f"{self.spec}: no such fault", "builtin:fault/NAME or builtin:fault/NAME/64")
        try:
            self.fault = fault(options[0])
        except KeyError as error:
            raise UsageError(f"no fault is called {options[0]!r}", f"for example {error.args[0]}") from None
        self.bits = int(bits)
        self.precision = f"float{bits}"
        self.name = f"reference tracer with {self.fault.name} ({self.precision})"

    def prepare(self) -> None:
        """Nothing to build."""

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Render by the faulty rules, and write the picture as the fault has it."""
        begin = time.monotonic()
        found = picture(scene, self.fault, self.bits)
        seconds = time.monotonic() - begin
        try:
            return Attempt(check(found), seconds=seconds)
        except ImageError as error:
            return Attempt(None, "invalid", str(error), seconds=seconds)
