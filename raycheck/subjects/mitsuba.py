"""builtin:mitsuba[/VARIANT[/stock|path]]: Mitsuba 3 as a tracer under test."""

from __future__ import annotations

import numpy as np

from oracles.images import ImageError, Picture
from oracles.images.picture import check
from oracles.peers.cannot import CannotSayError
from oracles.peers.mitsuba_xml import is_stochastic, to_mitsuba
from raycheck.errors import UsageError
from raycheck.subjects.mitsuba_process import VARIANTS, MitsubaProcess
from raycheck.subjects.subject import Attempt
from reference_tracer.dialects import SCENE_MODEL
from scenes.model import Scene

SPP = 64
"""Samples a pixel of a render of the path tracer."""


class MitsubaSubject:
    """The lecture's model on Mitsuba's primitives; /stock: what a stock Mitsuba can say; /path: that, by chance."""

    in_process = False
    scene_form = ""
    image_form = ""
    precision = "float32"
    features: tuple[str, ...] | None = None
    dialect = SCENE_MODEL

    def __init__(self, rest: str) -> None:
        _, *options = rest.split("/")
        self.variant = options[0] if options else VARIANTS[0]
        self.spec = f"builtin:{rest}"
        if self.variant not in VARIANTS or options[1:] not in ([], ["stock"], ["path"]):
            raise UsageError(f"{self.spec}: no such Mitsuba", f"builtin:mitsuba/{'|'.join(VARIANTS)}[/stock|/path]")
        self.task = options[1] if options[1:] else "lecture"
        self.spp = SPP if self.task == "path" else None
        self.name = f"Mitsuba 3 ({', '.join([self.variant, *options[1:]])})"
        self.process = MitsubaProcess(self.variant)

    def prepare(self) -> None:
        """See that it can run."""
        self.process.prepare()

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Ask for the picture."""
        if self.task == "stock" and _by_chance(scene):
            return Attempt(None, "unsupported", "a stock Mitsuba follows one branch of glass by chance")
        answer = self.process.ask(self.task, scene, seed, SPP)
        if answer.values is None:
            return Attempt(None, answer.word, answer.message, answer.process, answer.seconds)
        try:
            picture = check(Picture(answer.values.astype(np.float64), roundoff=2.0**-24))
        except ImageError as error:
            return Attempt(None, "invalid", str(error), answer.process, answer.seconds)
        return Attempt(picture, process=answer.process, seconds=answer.seconds)


def _by_chance(scene: Scene) -> bool:
    try:
        return is_stochastic(scene) and bool(to_mitsuba(scene))
    except CannotSayError:
        return False
