"""A picture of which every value is proved: ball lanes where they decide, exact numbers where they do not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer import exact
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.backend import Backend
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

BALL_BITS = 53
ROUNDOFF = 2.0**-53


@dataclass(frozen=True)
class Certified:
    """An image and its proof.

    value, bound: (height, width, 3), |truth - value| <= bound; bits: (height, width), the precision that was needed, 53
    for the ball lanes; decided: (height, width), False where no precision up to the cap decides the path
    and the bound holds the hull of all its branches; margin: (height, width), the smallest relative margin of
    any decision on the path (lanes.margins).
    """

    value: NDArray[np.float64]
    bound: NDArray[np.float64]
    bits: NDArray[np.int64]
    decided: NDArray[np.bool_]
    margin: NDArray[np.float64]


def render(
    scene: Scene, backend: Backend, rules: Rulebook = LECTURE, progress: Callable[[float], Any] = lambda share: None
) -> Certified:
    """Balls at u = 2^-53 for all pixels, then arb for those in doubt."""
    found = lanes.enclose(scene, backend, ROUNDOFF, 0.0, rules)
    value, bound = found.pixels.copy(), found.radius.copy()
    bits = np.full(found.doubts.shape, BALL_BITS)
    decided = np.ones(found.doubts.shape, dtype=bool)
    open_pixels = np.argwhere(found.doubts != 0)
    tracer = exact.ExactTracer(scene, rules)
    for k, (j, i) in enumerate(open_pixels):
        pixel = tracer.pixel(int(i), int(j))
        value[j, i], bound[j, i] = pixel.value, pixel.bound
        bits[j, i], decided[j, i] = pixel.bits, pixel.decided
        progress((k + 1) / len(open_pixels))
    return Certified(value, bound, bits, decided, lanes.margins(scene, rules))


def render_exact(
    scene: Scene, rules: Rulebook = LECTURE, progress: Callable[[float], Any] = lambda share: None
) -> Certified:
    """Every pixel on arb."""
    tracer = exact.ExactTracer(scene, rules)
    height, width = scene.image.height, scene.image.width
    value, bound = np.empty((2, height, width, 3))
    bits = np.empty((height, width), dtype=np.int64)
    decided = np.empty((height, width), dtype=bool)
    for j in range(height):
        for i in range(width):
            pixel = tracer.pixel(i, j)
            value[j, i], bound[j, i] = pixel.value, pixel.bound
            bits[j, i], decided[j, i] = pixel.bits, pixel.decided
        progress((j + 1) / height)
    return Certified(value, bound, bits, decided, lanes.margins(scene, rules))
