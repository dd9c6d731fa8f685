"""Who takes part in the arbitration on this machine."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np

from oracles.images import Picture
from oracles.peers.arbitration import Party
from oracles.peers.explain import FAR, OFFSET, TOTAL_REFLECTION, Habit
from raycheck.subjects import Attempt, Subject, attach
from reference_tracer import llvm
from reference_tracer.lanes import render as lanes
from scenes.model import Scene


@dataclass(frozen=True)
class Peer:
    """One way to a picture."""

    name: str
    precision: str
    render: Callable[[Scene], Attempt]
    habits: tuple[Habit, ...] = ()

    def party(self, scene: Scene) -> Party:
        """Its version of the scene."""
        attempt = self.render(scene)
        told = f"{attempt.word}: {attempt.message}" if attempt.word else ""
        return Party(self.name, self.precision, attempt.picture, attempt.seconds, told, self.habits)


def peers() -> Iterator[Peer]:
    """Ours in each number type, then others' renderers, as far as they are installed."""
    for kind in ("numpy", "drjit") if llvm.find() else ("numpy",):
        for bits in (32, 64):
            yield Peer(f"ours, {kind} float{bits}", f"float{bits}", _ours(kind, bits))
    if find_spec("mitsuba") is not None:
        yield _other("builtin:mitsuba/scalar_rgb", OFFSET)
        if llvm.find():
            yield _other("builtin:mitsuba/llvm_ad_rgb", OFFSET)
        yield _other("builtin:mitsuba/scalar_rgb/stock", OFFSET)
    if shutil.which("povray"):
        yield _other("builtin:povray", TOTAL_REFLECTION, FAR)


def _ours(kind: str, bits: int) -> Callable[[Scene], Attempt]:
    def render(scene: Scene) -> Attempt:
        begin = time.monotonic()
        pixels = lanes.render(scene, lanes.backend(kind, bits)).pixels.astype(np.float64)
        return Attempt(Picture(pixels, roundoff=2.0**-24 if bits == 32 else 0.0), seconds=time.monotonic() - begin)

    return render


def _other(spec: str, *habits: Habit) -> Peer:
    subject: Subject = attach(spec)
    subject.prepare()
    return Peer(subject.name, subject.precision, lambda scene: subject.render(scene, 0), habits)
