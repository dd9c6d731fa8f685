"""Where a ray meets a plane."""

from __future__ import annotations

from reference_tracer.numbers import Condition, Number, less, select
from reference_tracer.vector import Vec, dot, unit

NEVER = float("inf")


def plane_hit(
    o: Vec, v: Vec, normal: Vec, offset: Number, starts_elsewhere: Condition, start: Number, again: Number = NEVER
) -> tuple[Number, Condition]:
    """The λ at which the ray meets normal∘p = offset, and whether it does: where λ is beyond `start`.

    From normal∘(o + λv) = offset. A parallel ray never meets it, nor does one that starts on it: its only root
    is 0. A tracer that does not know where its ray starts finds a root as large as its start is off the plane,
    over normal∘v; it may meet its own plane beyond `again`.
    """
    toward = dot(normal, v)
    crosses = less(toward, 0.0) | less(0.0, toward)
    root = (offset - dot(normal, o)) / select(crosses, toward, 1.0)
    return root, crosses & less(select(starts_elsewhere, start, again), root)


def plane_normal(normal: Vec) -> Vec:
    """Unit normal of the plane, on the side its normal points to."""
    return unit(normal)
