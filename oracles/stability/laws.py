"""The error laws of the methods, as text and as the frontier that each predicts.

u is the unit roundoff of the precision. The laws are stated in the docstrings of `reference_tracer.methods`; here each
is solved for the value at which the error reaches what a frontier allows (impact 0.9: cos = 0.436).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from oracles.measurement import Precision
from oracles.stability.probe import ROUNDOFF

S = 0.9
COS = math.sqrt(1.0 - S * S)
ETA = 1.0 / 1.5


@dataclass(frozen=True)
class Law:
    """What bounds the error, in words, and the frontier for (u, allowed error)."""

    text: str
    solved: Callable[[float, float], float]


# 4u(D + D²/cos) = e
_QUADRATIC = Law("|Δλ|/r ≤ 4u(D + D²/cos)", lambda u, e: COS * (math.sqrt(1.0 + e / (u * COS)) - 1.0) / 2.0)
_LINEAR = Law("|Δλ|/r ≤ 4uD(1 + s/cos)", lambda u, e: e / (4.0 * u * (1.0 + S / COS)))
_CANCELS = Law("relative u/h, a few", lambda u, e: 3.0 * u / e)
_FLAT = Law("relative 3u at every h", lambda u, e: 0.0)

_LAWS: dict[tuple[str, str], Law] = {
    ("distance", "lecture"): _QUADRATIC,
    ("distance", "geometric"): _QUADRATIC,
    ("distance", "perpendicular"): _LINEAR,
    ("distance", "haines"): _LINEAR,
    ("distance", "compensated"): _LINEAR,
    ("distance", "double-word"): Law("|Δλ|/r ≤ uD, the output's rounding", lambda u, e: e / u),
    # float64 inside: what is left is the rounding of λ, and that v is unit to u of the narrow type
    ("distance", "wide"): Law("|Δλ|/r ≤ uD + 2uD, v's length and the output", lambda u, e: e / (3.0 * u)),
    ("decision", "lecture"): Law("wrong only where |s - 1| ≤ 3uD²", lambda u, e: math.sqrt(e / (3.0 * u))),
    ("decision", "geometric"): Law("wrong only where |s - 1| ≤ 3uD²", lambda u, e: math.sqrt(e / (3.0 * u))),
    ("decision", "perpendicular"): Law("wrong only where |s - 1| ≤ 1.1uD", lambda u, e: e / (1.1 * u)),
    ("decision", "haines"): Law("wrong only where |s - 1| ≤ 1.1uD", lambda u, e: e / (1.1 * u)),
    ("decision", "compensated"): Law("wrong only where |s - 1| ≤ 1.1uD", lambda u, e: e / (1.1 * u)),
    # |v|² = 1 + 2ε leaves 2ε(b∘v) along the ray in the residual: its square 4ε²D² against 2|s - 1|, |ε| ≤ 1.2u
    ("decision", "wide"): Law("wrong only where |s - 1| ≤ 3u²D²: v's length", lambda u, e: math.sqrt(e / 3.0) / u),
    ("height", "lecture"): _CANCELS,
    ("height", "geometric"): _CANCELS,
    ("height", "perpendicular"): _CANCELS,
    ("height", "haines"): _CANCELS,
    ("height", "compensated"): _FLAT,
    ("height", "wide"): _FLAT,
    ("height", "double-word"): _FLAT,
    # 6u/(η s1) = e η s1, and 2u(1 + 1/c2)(1 + 1/η') ≈ 7u = e η s1 near the normal
    ("bending", "slide"): Law("|Δt| ≤ 6u/(η sinθ1)", lambda u, e: math.asin(min(1.0, math.sqrt(6.0 * u / e) / ETA))),
    ("bending", "division-free"): Law("|Δt| ≤ 2u(1 + 1/c2)(1 + η)", lambda u, e: 4.0 * (1.0 + ETA) * u / (e * ETA)),
    ("bending", "vector"): Law("|Δt| ≤ 3u(1 + 1/c2)(1 + η)", lambda u, e: 6.0 * (1.0 + ETA) * u / (e * ETA)),
}


def predicted(question: str, method: str, precision: Precision, allowed: float) -> float | None:
    """Where the law allows the first failure; None without a law, or where it allows none."""
    law = _LAWS.get((question, method))
    return (law.solved(ROUNDOFF[precision], allowed) or None) if law else None


def text(question: str, method: str) -> str:
    """The law in words; empty without one."""
    law = _LAWS.get((question, method))
    return law.text if law else ""
