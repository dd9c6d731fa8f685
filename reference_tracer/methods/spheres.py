"""Other ways to meet a sphere: each solves |b + λv| = r for the near and the far root.

Error laws: u is the unit roundoff, D = |b|/r the distance in radii, s the impact parameter in radii,
cos = sqrt(1 - s²), |Δλ| the error of a root for a v that is unit but for its own rounding. All hold in
float32 and float64 alike, with o - c, b∘v and the rest computed in that type. A wrong hit or miss
needs |s - 1| below what is called the band. Measured by `raycheck stability`.
"""

from __future__ import annotations

from collections.abc import Callable

from reference_tracer.formulas.sphere import sphere_hit
from reference_tracer.methods.pairs import power_of_point
from reference_tracer.numbers import Condition, Number, less, select, sqrt0
from reference_tracer.vector import Vec, dot

Roots = tuple[Number, Number, Number]


def geometric(b: Vec, bv: Number, v: Vec, r: Number) -> Roots:
    """L11 "Alternative Solution by Geometry": d² = |b|² - (b∘v)², no hit if d > r.

    λ = -b∘v ± sqrt(r² - d²). The subtraction cancels as the quadratic's does: |Δλ|/r <= 4u(D + D²/cos), band
    3uD². Geometry does not help, only where the square is taken does.
    """
    d2 = dot(b, b) - bv * bv
    D = r * r - d2
    root = sqrt0(D)
    return -bv - root, -bv + root, D


def perpendicular(b: Vec, bv: Number, v: Vec, r: Number) -> Roots:
    """D = r² - |b - (b∘v)v|²: the part of b across the ray is formed before it is squared.

    Haines, Günther & Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection" (Ray Tracing Gems, 2019,
    ch. 7). |Δλ|/r <= 4uD(1 + s/cos), band 1.1uD. Near the surface (D = 1 + h) the near root is still a difference:
    relative error u/h.
    """
    D = _residual(b, bv, v, r)
    root = sqrt0(D)
    return -bv - root, -bv + root, D


def haines(b: Vec, bv: Number, v: Vec, r: Number) -> Roots:
    """The perpendicular residual, and the root that cancels taken from the product of both: c/q, c = |b|² - r².

    Haines, Günther & Akenine-Möller 2019. Errors as `perpendicular`; λ itself right to 3u far from the sphere. Near
    it c cancels: u/h.
    """
    D = _residual(b, bv, v, r)
    near, far = _without_cancellation(bv, sqrt0(D), dot(b, b) - r * r)
    return near, far, D


def haines_compensated(b: Vec, bv: Number, v: Vec, r: Number) -> Roots:
    """`haines` with c to one rounding (`pairs.power_of_point`): good far from the sphere and near it.

    |Δλ|/r <= 4uD(1 + s/cos), and relative error 3u at any height h above the surface for rays that meet it steeply.
    """
    D = _residual(b, bv, v, r)
    near, far = _without_cancellation(bv, sqrt0(D), power_of_point(b, r))
    return near, far, D


def general(b: Vec, bv: Number, v: Vec, r: Number) -> Roots:
    """Distances along v of any length: (-b∘v ± sqrt((b∘v)² - v∘v(|b|² - r²)))/|v|.

    With D in its residual form, r²|v|⁴ - | |v|²b - (b∘v)v |², and the product of the roots c. In double words the
    relative error is that of the output's rounding: |v| = 1 is not assumed, which is half of the other forms' error.
    """
    a = dot(v, v)
    across = b * a - v * bv
    D = (a * r) * (a * r) - dot(across, across)
    near, far = _without_cancellation(bv / sqrt0(a), sqrt0(D) / a, dot(b, b) - r * r)
    return near, far, D


def _residual(b: Vec, bv: Number, v: Vec, r: Number) -> Number:
    """r² - |b - (b∘v)v|², negative where the ray passes by."""
    across = b - v * bv
    return r * r - dot(across, across)


def _without_cancellation(bv: Number, root: Number, c: Number) -> tuple[Number, Number]:
    """Near and far root from their sum -2 b∘v and their product c.

    q = -b∘v - sign(b∘v)·root is a sum of like signs; the other root is c/q (Press et al., Numerical Recipes, 5.6).
    Where q = 0 both are 0.
    """
    away = less(0.0, bv)
    size = select(away, bv, -bv) + root
    rest = c / select(less(0.0, size), size, size + 1.0)
    return select(away, -size, rest), select(away, -rest, size)


def sphere_hit_in(
    into: Callable[[Number], Number], back: Callable[[Number, Number], Number]
) -> Callable[..., tuple[Number, Condition]]:
    """`sphere_hit` computed in another number type: from o, v, c, r on, and the distance brought back."""

    def hit(
        distances: Callable[[Vec, Number, Vec, Number], Roots],
        o: Vec,
        v: Vec,
        c: Vec,
        r: Number,
        starts_here: Condition,
        start: Number,
    ) -> tuple[Number, Condition]:
        o_in, v_in, c_in = (Vec(*(into(part) for part in vector)) for vector in (o, v, c))
        distance, meets = sphere_hit(distances, o_in, v_in, c_in, into(r), starts_here, start)
        return back(distance, v.x), meets

    return hit
