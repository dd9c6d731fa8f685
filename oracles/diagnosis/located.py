"""Where an error lives that no known fault explains: the term of the shading sum, and where it starts.

Every fault of the dictionary is a probe of the formula that it changes: it tells which pixels can depend on that
formula, and in which colour. The term whose faults change the same pixels as are wrong, of the same pictures, in the
same direction of colour, is where the error is sought: fault localisation by mutants (Papadakis, Le Traon,
"Metallaxis-FL", Software Testing, Verification and Reliability 25, 2015), with Ochiai's similarity (Abreu et al.,
TAICPART 2007).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from oracles.diagnosis.evidence import Evidence, Witness
from oracles.faults import FAULTS, Fault

SAMPLE = 8
"""Wrong pictures, and as many right ones, by which a term is located."""


@dataclass(frozen=True)
class Term:
    """A term of the shading sum.

    entries: of the rulebook, that make it; formula and slide: of L11; probes: the operations that ask for it.
    """

    name: str
    entries: frozenset[str]
    formula: str
    slide: str
    probes: tuple[str, ...] = ()


def _term(name: str, entries: str, formula: str, slide: str, *probes: str) -> Term:
    return Term(name, frozenset(entries.split()), formula, slide, probes)


TERMS = (
    _term("camera", "plane_point camera_ray", "v = unit(forward + X·right + Y·up)", "Ray Vector Calculation", "camera"),
    _term(
        "hit",
        "sphere_distances sphere_hit plane_hit nearer",
        "λ = -b∘v ± sqrt((b∘v)² - (|b|² - r²)), the smallest λ > 0",
        "Ray Tracing with a Sphere",
        "sphere",
        "plane",
    ),
    _term(
        "normal",
        "sphere_normal plane_normal face shading_normal",
        "n = (p - c)/|p - c|, turned to the viewer",
        "Ray Tracing with a Sphere",
        "normal",
    ),
    _term(
        "light",
        "light_vector attenuation add_light direct_light",
        "i = unit(k - p); α = func(distance); α·light·(diffuse + specular)",
        "Light Position",
    ),
    _term("ambient", "ambient_light", "RGB = ambient + diffuse·cosθ", "uRT-10-RT5-Colors-Ambient_diffuse"),
    _term("diffuse", "lambert", "cosθ = max(i∘n, 0)", "Ex) Bad and Good Case", "phong"),
    _term("specular", "phong reflect view_vector", "r = 2(i∘n)n - i; specular·max(r∘(-v), 0)^s", "Phong's effect Result", "phong"),
    _term(
        "visibility",
        "blocks shaded_light",
        "a light counts unless something stands strictly between p and it",
        "Example of Ray Tracing",
    ),
    _term("reflected", "mirror", "r = 2(-v∘n)n + v", "Mirror with No Transparency", "reflect"),
    _term("refracted", "refract", "t = sinθ2 p_u - cosθ2 n", "Various Types of Transparency", "refract"),
    _term(
        "branches",
        "weights fresnel mix",
        "RGB = local + reflect·colour(p, r) + transmit·colour(p, t)",
        "Refraction with geo.tr vector",
    ),
    _term("generation", "generations last stray", "generation < depth", "Ray Tracing has three features"),
    _term("picture", "seen encode", "linear values, R, G, B, the top row first", "Basic Buffering"),
)
"""In the order of a ray's life."""


@dataclass(frozen=True)
class Place:
    """A term and how much the error looks like one of its faults, 0 to 1; which one."""

    term: Term
    likeness: float
    like: Fault


def term_of(fault: Fault) -> Term:
    """The term that a fault changes."""
    return next((term for term in TERMS if fault.entries & term.entries), TERMS[-1])


def located(evidence: Evidence) -> list[Place]:
    """All terms, the likeliest first."""
    witnesses = [*_spread(evidence.failing), *_spread(w for w in evidence.witnesses if not w.failing)]
    readings = [(witness, _errors(witness)) for witness in witnesses]
    best: dict[str, Place] = {}
    for fault in FAULTS:
        place = Place(term_of(fault), _likeness(readings, fault), fault)
        if place.term.name not in best or place.likeness > best[place.term.name].likeness:
            best[place.term.name] = place
    return sorted(best.values(), key=lambda place: place.likeness, reverse=True)


def _spread(witnesses: Iterable[Witness]) -> list[Witness]:
    found = sorted(witnesses, key=lambda witness: witness.cost)
    return [found[k] for k in sorted({round(x) for x in np.linspace(0, len(found) - 1, SAMPLE)})] if found else []


def _errors(witness: Witness) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """What is too much in each pixel, (n, 3), and which pixels are outside their bounds."""
    lawful = witness.lawful(())
    got = witness.got.values[0]
    outside = ((got < lawful.low[0]) | (got > lawful.high[0])).any(axis=-1)
    return got - lawful.middle[0], outside


def _likeness(readings: Sequence[tuple[Witness, tuple[NDArray[np.float64], NDArray[np.bool_]]]], fault: Fault) -> float:
    """Ochiai's similarity of wrong and changed pictures, each pair weighed by that of their pixels and colours."""
    alike, wrong, changed = 0.0, 0, 0
    for witness, (error, outside) in readings:
        change, moved = witness.change(fault)
        wrong += bool(outside.any())
        changed += bool(moved.any())
        both = outside & moved
        if both.any():
            ochiai = np.count_nonzero(both) / sqrt(np.count_nonzero(outside) * np.count_nonzero(moved))
            alike += ochiai * _parallel(error[both], change[both])
    return alike / sqrt(wrong * changed) if alike else 0.0


def _parallel(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Mean |cosine| between colours."""
    lengths = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosines = np.abs((a * b).sum(axis=-1)) / lengths
    return float(np.nan_to_num(cosines).mean())
