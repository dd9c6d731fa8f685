"""A tracer under test, whatever it is made of."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

from oracles.images import Picture
from oracles.verdict import Process
from reference_tracer.dialects import Dialect
from scenes.model import Scene

Problem = Literal["invalid", "crash", "timeout", "error", "unsupported"]


@dataclass(frozen=True)
class Attempt:
    """What came of asking for one picture: the picture, or the word and message of what went wrong."""

    picture: Picture | None
    word: Problem | None = None
    message: str = ""
    process: Process | None = None
    seconds: float = 0.0


class Subject(Protocol):
    """One tracer; `spec` is what attaches it again on the command line, `dialect` the conventions it declares.

    spp: samples a pixel of a stochastic tracer's render, None of others.
    """

    name: str
    spec: str
    precision: str
    scene_form: str
    image_form: str
    features: tuple[str, ...] | None
    in_process: bool
    dialect: Dialect
    spp: int | None

    def prepare(self) -> None:
        """Build or load it; raise StartError if that fails."""

    def render(self, scene: Scene, seed: int) -> Attempt:
        """One picture of the scene."""
