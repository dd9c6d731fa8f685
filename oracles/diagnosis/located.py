"""Where an error lives that no known fault explains: the term of the shading sum, and where it starts.

Every fault of the dictionary is a probe of the formula that it changes: it tells which pixels can depend on that
formula, and in which colour; so is every mutant, for mistakes that are not known. The term whose probes change the
same pixels as are wrong, of the same pictures, in the same direction of colour, is where the error is sought: fault
localisation by mutants (Papadakis, Le Traon, "Metallaxis-FL", Software Testing, Verification and Reliability 25,
2015), with Ochiai's similarity (Abreu et al., TAICPART 2007).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from oracles.diagnosis.evidence import Evidence, Witness
from oracles.diagnosis.mutants import GROUP, mutants
from oracles.faults import FAULTS, Fault

SAMPLE = 8
"""Wrong pictures, and as many right ones, by which all probes are tried."""
NEAR = 24
"""Probes that are then tried by all pictures."""
PLAIN = 1 / 4
"""What the likest mutant of a term counts beside its likest probe.

Of some formulas twenty mistakes are known, of others two; so that a term is not likelier for being better known, its
mutants, of which all have about as many, have a say. How large a one was found by hiding each known fault in turn, as
benchmarks/located.py does.
"""

Change = tuple[NDArray[np.float64], NDArray[np.bool_]]
"""How far each pixel is moved, (n, 3), and which pixels are moved out of their bounds."""


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
    _term(
        "specular",
        "phong reflect view_vector",
        "r = 2(i∘n)n - i; specular·max(r∘(-v), 0)^s",
        "Phong's effect Result",
        "phong",
    ),
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
    """A term and one of its probes: the sum of how alike error and probe are in each picture; wrong pictures; changed.

    like: the known fault or mutant that is the probe.
    """

    term: Term
    like: Fault
    alike: float
    wrong: int
    changed: int

    @property
    def likeness(self) -> float:
        """How much the error looks like the probe, 0 to 1: Ochiai's similarity of wrong and changed pictures."""
        return self.alike / sqrt(self.wrong * self.changed) if self.alike else 0.0

    def and_also(self, other: Place) -> Place:
        """By both of two sets of pictures."""
        return replace(
            self,
            alike=self.alike + other.alike,
            wrong=self.wrong + other.wrong,
            changed=self.changed + other.changed,
        )


def term_of(fault: Fault) -> Term:
    """The term that a fault changes."""
    return next((term for term in TERMS if fault.entries & term.entries), TERMS[-1])


def located(evidence: Evidence, known: Sequence[Fault] = FAULTS) -> list[Place]:
    """All terms, the likeliest first, each by the probe that looks most like the error.

    Every probe, known faults and mutants, is tried by a sample of the pictures; those that look most alike, and the
    best of each term, then by the others too.
    """
    probes = (*known, *mutants(evidence.base))
    sample = [*_spread(evidence.failing), *_spread(w for w in evidence.witnesses if not w.failing)]
    others = [witness for witness in evidence.witnesses if witness not in sample]
    likest = _likest_first(_compared(sample, probes))
    near = list(dict.fromkeys((*likest[:NEAR], *_best_of_terms(likest), *_best_of_terms(_of_mutants(likest)))))
    more = _compared(others, [found.like for found in near])
    found = _likest_first(before.and_also(after) for before, after in zip(near, more, strict=True))
    by_mutants = {place.term.name: place.likeness for place in _best_of_terms(_of_mutants(found))}

    def likelihood(place: Place) -> float:
        return (1.0 - PLAIN) * place.likeness + PLAIN * by_mutants.get(place.term.name, 0.0)

    return sorted(_best_of_terms(found), key=likelihood, reverse=True)


def _likest_first(places: Iterable[Place]) -> list[Place]:
    return sorted(places, key=lambda place: place.likeness, reverse=True)


def _best_of_terms(ordered: Iterable[Place]) -> list[Place]:
    """The first of each term."""
    best: dict[str, Place] = {}
    for place in ordered:
        best.setdefault(place.term.name, place)
    return list(best.values())


def _of_mutants(places: Iterable[Place]) -> list[Place]:
    return [place for place in places if place.like.group == GROUP]


def _spread(witnesses: Iterable[Witness]) -> list[Witness]:
    found = sorted(witnesses, key=lambda witness: witness.cost)
    return [found[k] for k in sorted({round(x) for x in np.linspace(0, len(found) - 1, SAMPLE)})] if found else []


def _compared(witnesses: Sequence[Witness], probes: Sequence[Fault]) -> list[Place]:
    """What these pictures say of each probe."""
    errors = [_error(witness) for witness in witnesses]
    wrong = sum(bool(outside.any()) for _, outside in errors)
    places = []
    for probe in probes:
        seen = [_alike(error, witness.change(probe)) for witness, error in zip(witnesses, errors, strict=True)]
        alike, changed = sum(found for found, _ in seen), sum(moved for _, moved in seen)
        places.append(Place(term_of(probe), probe, alike, wrong, changed))
    return places


def _error(witness: Witness) -> Change:
    """What is too much in each pixel, and which pixels are outside their bounds."""
    lawful = witness.lawful(())
    got = witness.got.values[0]
    outside = ((got < lawful.low[0]) | (got > lawful.high[0])).any(axis=-1)
    return got - lawful.middle[0], outside


def _alike(error: Change, change: Change) -> tuple[float, bool]:
    """How alike both are in one picture, pixels and colours, 0 to 1; whether the probe changes it at all."""
    outside, moved = error[1], change[1]
    both = outside & moved
    if not both.any():
        return 0.0, bool(moved.any())
    ochiai = np.count_nonzero(both) / sqrt(np.count_nonzero(outside) * np.count_nonzero(moved))
    return ochiai * _parallel(error[0][both], change[0][both]), True


def _parallel(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Mean |cosine| between colours."""
    with np.errstate(all="ignore"):
        lengths = np.linalg.norm(a, axis=-1) * np.linalg.norm(b, axis=-1)
        cosines = np.abs((a * b).sum(axis=-1)) / lengths
    return float(np.nan_to_num(cosines).mean())
