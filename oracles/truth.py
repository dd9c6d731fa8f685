"""What an image must be, and how far a correct tracer of a given precision may lie from it.

Truth is the float64 reference. The tolerance of a pixel is not set by anyone: it is the radius of
the same computation on balls at the tracer's unit roundoff (see docs/tolerance.md), so it holds
for every tracer that evaluates the lecture's formulas with that relative error an operation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.wavefront import CRITICAL, HIT, SHADOW
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Plane, Scene, Sphere

ROUNDOFF = {"float32": 2.0**-24, "float64": 2.0**-53}
"""Unit roundoff u of the precisions a tracer may declare (IEEE 754-2019, round to nearest)."""

SAFETY = {"float32": 2.0, "float64": 3.0}
"""Balls are computed at SAFETY·u: room for x·(1/y) instead of x/y and for library functions good to 1 ulp, and in
float64 for the rounding of our own midpoint."""

DOUBTS = {HIT: "silhouette or depth order", SHADOW: "shadow edge", CRITICAL: "critical angle"}
"""Kinds of decisions, as the report names them."""


@dataclass(frozen=True)
class Truth:
    """A scene's image with its tolerance.

    pixels: (height, width, 3) linear; tolerance: the same shape, absolute, before the output's
    quantisation; doubts: (height, width), bits of the decisions the precision cannot make; transfer: what linear
    values went through before they were stored, None: nothing, or what the scene asks for.
    """

    scene: Scene
    precision: str
    pixels: NDArray[np.float64]
    tolerance: NDArray[np.float64]
    doubts: NDArray[np.int64]
    transfer: Callable[[NDArray[np.float64]], NDArray[np.float64]] | None = None

    def doubtful(self) -> dict[str, int]:
        """Number of pixels in doubt, by kind of decision."""
        counts = {words: int(np.count_nonzero(self.doubts & bit)) for bit, words in DOUBTS.items()}
        return {words: count for words, count in counts.items() if count}


def truth(scene: Scene, precision: str, backend: str = "numpy", rules: Rulebook = LECTURE) -> Truth:
    """Truth and tolerance of a scene for a tracer of that precision ("float32" or "float64")."""
    u = SAFETY[precision] * ROUNDOFF[precision]
    offset = lawful_offset(scene)
    found = lanes.enclose(scene, lanes.backend(backend, 64), u, offset, rules)
    if u > lanes.SINGLE:
        found = lanes.narrow(scene, found, u, offset, rules)
    return Truth(scene, precision, found.pixels, found.radius, found.doubts)


def lawful_offset(scene: Scene) -> float:
    """How far from its start a ray may miss a surface: the largest start offset a float32 tracer needs.

    A float32 hit point lies off its surface by up to 4u·L (L: the scene's extent; facts of the
    sphere formula, docs/tolerance.md). A ray leaving at a grazing angle meets the sphere of radius
    R again within the chord sqrt(2·4uL·R), and R <= L. A tracer must skip that much to be free of
    acne, whatever precision it goes on in, so what begins nearer is undecided.
    """
    return extent(scene) * math.sqrt(8.0 * ROUNDOFF["float32"])


def extent(scene: Scene) -> float:
    """The largest distance from the origin of the eye, a sphere, or a plane's nearest point."""
    reach = [math.hypot(*scene.camera.eye)]
    for thing in scene.objects:
        if isinstance(thing, Sphere):
            reach.append(math.hypot(*thing.center) + thing.radius)
        elif isinstance(thing, Plane):
            reach.append(abs(thing.offset) / math.hypot(*thing.normal))
    return max(reach)
