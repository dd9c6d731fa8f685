"""Where a ray meets a plane."""

from __future__ import annotations

from reference_tracer.numbers import Condition, Number, less, select
from reference_tracer.vector import Vec, dot, unit


def plane_hit(
    o: Vec, v: Vec, normal: Vec, offset: Number, starts_elsewhere: Condition, start: Number
) -> tuple[Number, Condition]:
    """The λ at which the ray meets normal∘p = offset, and whether it does.

    From normal∘(o + λv) = offset. A parallel ray never meets it, nor does one that starts on it
    (its only root is 0).
    """
    toward = dot(normal, v)
    crosses = less(toward, 0.0) | less(0.0, toward)
    root = (offset - dot(normal, o)) / select(crosses, toward, 1.0)
    distance = select(starts_elsewhere, root, -1.0)
    return distance, crosses & less(start, distance)


def plane_normal(normal: Vec) -> Vec:
    """Unit normal of the plane, on the side its normal points to."""
    return unit(normal)
