"""Methods: rulebooks that compute the same geometry another way.

Each is the lecture's rulebook with one entry replaced, so every tracer of this house runs it: plain,
lanes, balls, exact. Which is good where: docs/stability.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType

from reference_tracer.formulas import optics
from reference_tracer.methods import refractions, spheres
from reference_tracer.methods.double_word import doubled, single
from reference_tracer.methods.words import narrow, widen
from reference_tracer.rulebook import LECTURE, Rulebook

SPHERE: Mapping[str, Rulebook] = MappingProxyType(
    {
        "lecture": replace(LECTURE, name="lecture"),
        "geometric": replace(LECTURE, name="geometric", sphere_distances=spheres.geometric),
        "perpendicular": replace(LECTURE, name="perpendicular", sphere_distances=spheres.perpendicular),
        "haines": replace(LECTURE, name="haines", sphere_distances=spheres.haines),
        "compensated": replace(LECTURE, name="compensated", sphere_distances=spheres.haines_compensated),
        "wide": replace(
            LECTURE,
            name="wide",
            sphere_hit=spheres.sphere_hit_in(widen, narrow),
            sphere_distances=spheres.haines,
        ),
        "double-word": replace(
            LECTURE,
            name="double-word",
            sphere_hit=spheres.sphere_hit_in(doubled, single),
            sphere_distances=spheres.general,
        ),
    }
)
"""Ray and sphere, by method. "wide" computes float32 numbers in float64; in float64 it is "haines"."""

REFRACT: Mapping[str, Rulebook] = MappingProxyType(
    {
        "slide": replace(LECTURE, name="slide", refract=refractions.slide),
        "division-free": replace(LECTURE, name="division-free", refract=optics.refract),
        "vector": replace(LECTURE, name="vector", refract=refractions.vector),
    }
)
"""Refraction, by method; "division-free" is the lecture's formula without its 0/0, and what our tracer uses."""
