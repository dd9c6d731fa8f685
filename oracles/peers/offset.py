"""What moving the start of secondary rays does to a picture: the reference tracer, so moved.

Mitsuba starts a ray that leaves a surface at p + m n, m = ±(1 + max|p|)·ε with ε = 1500·2⁻²⁴ (`offset_p` and
`math::RayEpsilon` of Mitsuba 3.9), and looks for the light up to (1 - 10ε) of the way. Truth has no such offset.
A pixel that lies outside its bound but within it about *this* tracer's colour is explained: nothing but the
offset is wrong there.
"""

from __future__ import annotations

import math
from dataclasses import replace

from reference_tracer.plain import PlainTracer
from reference_tracer.rulebook import LECTURE
from reference_tracer.vector import Vec, dot
from scenes.model import Scene

RAY_EPSILON = 1500.0 * 2.0**-24
SHADOW_EPSILON = 10.0 * RAY_EPSILON


class OffsetTracer(PlainTracer):
    """The plain tracer, its secondary rays started off the surface; no surface is exempt from them."""

    def __init__(self, scene: Scene, epsilon: float = RAY_EPSILON) -> None:
        shy = replace(LECTURE, blocks=lambda distance, light, opaque: distance < light * (1.0 - SHADOW_EPSILON))
        super().__init__(scene, shy)
        self.epsilon = epsilon

    def find_rgb(self, o: Vec, v: Vec, start: int | None, generation: int) -> Vec:
        """As the plain tracer's, from the moved start."""
        if start is not None:
            o = self.moved(o, v, self.normal(self.objects[start], o))
        return super().find_rgb(o, v, None, generation)

    def shadowed(self, p: Vec, i: Vec, light_distance: float, start: int) -> bool:
        """As the plain tracer's; the start is moved, and the ray aims at the light from there."""
        moved = self.moved(p, i, self.normal(self.objects[start], p))
        if math.isfinite(light_distance):
            w = p + i * light_distance - moved
            light_distance = math.sqrt(dot(w, w))
            i = w * (1.0 / light_distance)
        return super().shadowed(moved, i, light_distance, -1)

    def moved(self, p: Vec, v: Vec, n: Vec) -> Vec:
        """The point p moved along n, to the side on which v leaves."""
        size = (1.0 + max(abs(x) for x in p)) * self.epsilon
        return p + n * math.copysign(size, dot(n, v))
