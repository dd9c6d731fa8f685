"""Why a peer leaves the bound, pixel by pixel: the reference tracer with the peer's habit lands where it does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracles.faults.fault import instead
from oracles.faults.numbers import below
from oracles.images.picture import Picture
from oracles.peers import conventions
from oracles.peers.offset import OffsetTracer
from oracles.truth import truth
from reference_tracer.plain import PlainTracer
from scenes.model import Scene

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Habit:
    """What a peer does otherwise, the tracer that does so too, and how far a right one of that habit may be off."""

    reason: str
    tracer: Callable[[Scene], PlainTracer]
    tolerance: Callable[[Scene, str, str], Reals]


OFFSET = Habit(
    "secondary rays start off the surface along the normal",
    OffsetTracer,
    lambda scene, precision, lanes: truth(scene, precision, lanes).tolerance,
)
TOTAL_REFLECTION = Habit(
    "total reflection goes on as a mirrored ray of weight 1", conventions.TotalReflectionTracer, conventions.tolerance
)

FAR = Habit(
    "nothing is met beyond 1e7",
    lambda scene: PlainTracer(scene, instead("nothing is met beyond 1e7", **below(1e7))),
    lambda scene, precision, lanes: truth(scene, precision, lanes).tolerance,
)


def explained(
    scene: Scene, picture: Picture, outside: NDArray[np.bool_], habit: Habit, precision: str, lanes: str
) -> NDArray[np.bool_]:
    """Which of the pixels outside lie within the bound about that tracer's colours."""
    found = np.zeros_like(outside)
    places = np.argwhere(outside)
    if not places.size:
        return found
    tracer, tolerance = habit.tracer(scene), habit.tolerance(scene, precision, lanes)
    for j, i in places:
        colour = np.array(tracer.pixel(int(i), int(j)), dtype=np.float64)
        reach = tolerance[j, i] + np.abs(colour) * picture.roundoff
        found[j, i] = bool(np.all(np.abs(picture.values[j, i] - colour) <= reach))
    return found
