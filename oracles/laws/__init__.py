"""Laws: what holds for every ray tracer, whatever its shading model and its precision."""

from __future__ import annotations

from oracles.laws import camera, normal, phong, plane, reflect, refract, sphere
from oracles.laws.law import Ask, Law, NoAnswerError, Reading, entered

FILES = (sphere, plane, normal, reflect, refract, phong, camera)
"""Importing a file enters its laws."""

ORDER = ("sphere", "plane", "normal", "reflect", "refract", "phong", "camera", "trace")
"""Of the formulas, as the lecture has them."""


def formula_laws() -> tuple[Law, ...]:
    """All laws of formulas, in the lecture's order."""
    return tuple(sorted(entered(), key=lambda law: ORDER.index(law.name.split("/")[0])))


__all__ = ["FILES", "ORDER", "Ask", "Law", "NoAnswerError", "Reading", "formula_laws"]
