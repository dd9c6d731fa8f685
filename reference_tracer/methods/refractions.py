"""Other ways to bend a ray: each gives t for travelling unit v, n facing it, and whether it is totally reflected.

u is the unit roundoff, θ1 and θ2 the angles of incidence and refraction, c2 = cosθ2, η = sinθ2/sinθ1
(1/index entering, index leaving). Near the critical angle every form loses u/c2: that is the question's own
conditioning. Measured by `raycheck stability`.
"""

from __future__ import annotations

from reference_tracer.numbers import Condition, Number, at_least, less, select, sqrt0
from reference_tracer.vector import Vec, dot

NAN = float("nan")


def slide(v: Vec, n: Vec, leaving: Condition, index: Number) -> tuple[Vec, Condition]:
    """L11 "Refraction Vector Calculation" as written: p = (i∘n)n - i, t = sinθ2 p/|p| - cosθ2 n, i = -v.

    With sinθ1 = sqrt(1 - (i∘n)²), and the ratio inverted on leaving, which the slide's code forgets. Error
    6u/(η sinθ1), so O(sqrt u) near normal incidence; at normal incidence 0/0, or the root of a negative number
    where i∘n rounds above 1. There t is NaN in every number type and the ray counts as totally reflected, so that
    no NaN is traced: the transmitted light is missing, visibly. Balls and exact numbers call it undecided.
    """
    d = -dot(v, n)
    p = n * d + v
    size = sqrt0(dot(p, p))
    s1 = select(less(0.0, size), _root(1.0 - d * d), NAN)
    s2 = select(leaving, s1 * index, s1 / index)
    t = (p / select(less(0.0, size), size, 1.0)) * s2 - n * sqrt0(1.0 - s2 * s2)
    return t, at_least(select(less(s2, 1.0), s2, 1.0), 1.0)


def vector(v: Vec, n: Vec, leaving: Condition, index: Number) -> tuple[Vec, Condition]:
    """The vector form: t = ηv + (η cosθ1 - cosθ2) n.

    Whitted, "An improved illumination model for shaded display" (CACM 23, 1980), in the form of Glassner, An
    Introduction to Ray Tracing (1989). Error 3u(1 + 1/c2)(1 + η): no 0/0 and no division by sinθ1.
    """
    d = -dot(v, n)
    eta = select(leaving, index, 1.0 / index)
    sin2 = (eta * eta) * (1.0 - d * d)
    t = v * eta + n * (eta * d - sqrt0(1.0 - sin2))
    return t, at_least(sin2, 1.0)


def _root(x: Number) -> Number:
    """The root of x, NaN where x is negative, as the mathematical library has it."""
    return select(at_least(x, 0.0), sqrt0(x), NAN)
