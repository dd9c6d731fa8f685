"""Where a peer's model is another than the scene format's: the reference tracer under the peer's convention.

POV-Ray loses no light at total reflection: the ray goes on mirrored, with weight 1 in place of the material's
`transmit`. The scene format's term is 0 there (L11 "Get Refraction Vector": `s2>=1 → (0,0,0)`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from oracles.truth import truth
from reference_tracer.formulas import optics
from reference_tracer.numbers import Condition, Number, less
from reference_tracer.plain import PlainTracer
from reference_tracer.rulebook import LECTURE
from reference_tracer.vector import Vec, dot, select_vec
from scenes.model import Scene


def _refract_or_reflect(v: Vec, n: Vec, leaving: Condition, index: Number) -> tuple[Vec, Condition]:
    """As `refract`, but a totally reflected ray goes on mirrored, with the transmitted ray's weight."""
    t, total = optics.refract(v, n, leaving, index)
    return select_vec(total, optics.reflect(-v, n), t), less(dot(v, v), 0.0)


REFLECTS = replace(LECTURE, name="total reflection reflects", refract=_refract_or_reflect)


class TotalReflectionTracer(PlainTracer):
    """The plain tracer, adding at total reflection the mirrored ray with weight 1."""

    def find_rgb(self, o: Vec, v: Vec, start: int | None, generation: int) -> Vec:
        """As the plain tracer's, and what it leaves out."""
        colour = super().find_rgb(o, v, start, generation)
        hit = self.nearest(o, v, start)
        if hit is None or generation == self.scene.depth:
            return colour
        material = self.scene.materials[hit.thing.material]
        n, leaving = self.rules.face(v, hit.n)
        _, total = self.rules.refract(v, n, leaving, self.number(material.index))
        if any(material.transmit) and total:
            colour = colour + self.find_rgb(hit.p, self.rules.mirror(-v, n), hit.order, generation + 1)
        return colour


def tolerance(scene: Scene, precision: str, lanes: str) -> NDArray[np.float64]:
    """Tolerance of that tracer's picture.

    The same rays with weights w <= 1 are enclosed by balls under REFLECTS. Radii are sums of products that are linear
    in each generation's weight, so weight 1 in place of w makes a radius at most 1/w times as large a generation.
    """
    used = [scene.materials[thing.material].transmit for thing in scene.objects]
    least = min((part for colour in used for part in colour if part > 0.0), default=1.0)
    return truth(scene, precision, lanes, REFLECTS).tolerance / min(least, 1.0) ** scene.depth
