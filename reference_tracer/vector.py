"""Three components on a generic number, with the lecture's two products."""

from __future__ import annotations

from typing import NamedTuple

from reference_tracer.numbers import Condition, Number, select, sqrt0, sum3, unit3


class Vec(NamedTuple):
    """A vector or a colour; + - * work component by component, a number scales."""

    x: Number
    y: Number
    z: Number

    def __add__(self, other: Vec) -> Vec:  # type: ignore[override]
        return Vec(self.x + other.x, self.y + other.y, self.z + other.z)

    def __sub__(self, other: Vec) -> Vec:
        return Vec(self.x - other.x, self.y - other.y, self.z - other.z)

    def __neg__(self) -> Vec:
        return Vec(-self.x, -self.y, -self.z)

    def __mul__(self, factor: Number) -> Vec:
        """Scale by a number, or multiply two colours component by component."""
        if isinstance(factor, Vec):
            return Vec(self.x * factor.x, self.y * factor.y, self.z * factor.z)
        return Vec(self.x * factor, self.y * factor, self.z * factor)

    def __truediv__(self, divisor: Number) -> Vec:
        return Vec(self.x / divisor, self.y / divisor, self.z / divisor)


def dot(a: Vec, b: Vec) -> Number:
    """The inner product a∘b."""
    return sum3(a.x * b.x, a.y * b.y, a.z * b.z)


def length(a: Vec) -> Number:
    """|a|."""
    return sqrt0(dot(a, a))


def unit(a: Vec) -> Vec:
    """a/|a|; the zero vector stays zero, so the function is total."""
    return Vec(*unit3(*a))


def select_vec(condition: Condition, a: Vec, b: Vec) -> Vec:
    """A where the condition holds, b elsewhere."""
    return Vec(select(condition, a.x, b.x), select(condition, a.y, b.y), select(condition, a.z, b.z))
