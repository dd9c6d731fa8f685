"""Errors that no known fault explains are sought in the right term, by known faults and by mutants of every formula."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from oracles.compare import compare
from oracles.diagnosis.evidence import Evidence
from oracles.diagnosis.located import TERMS, Place, located, term_of
from oracles.diagnosis.mutants import GROUP, WAYS, mutants
from oracles.faults import FAULTS
from oracles.faults.fault import instead
from oracles.images.picture import Picture
from oracles.inference import Exhibit
from oracles.truth import Truth, truth
from reference_tracer.dialects import Dialect, rules
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from reference_tracer.numbers import sqrt0
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec, unit
from scenes.catalogue import ladder

NAMES = (
    "depth-order", "inside-sphere", "ambient-diffuse", "point-light", "two-lights", "phong-10", "attenuation-inverse",
    "plane-both-sides", "shadow-hard", "shadow-behind-light", "mirror-imperfect", "mirror-perfect", "facing-mirrors-3",
    "glass-sphere", "inside-glass", "off-centre-camera", "lecture-final", "glass-fresnel",
)  # fmt: skip
"""For every mutant there is one that it changes."""
SIZE = (24, 18)
MUTANTS = tuple(mutants(LECTURE))


@pytest.fixture(scope="module")
def truths() -> list[Truth]:
    return [truth(rung.scene().resized(*SIZE), "float32") for rung in ladder() if rung.name in NAMES]


def evidence(truths: list[Truth], rules: Rulebook, bits: int = 32) -> Evidence:
    """What a tracer that runs by these rules is judged by."""
    shown = []
    for right in truths:
        pixels = render(right.scene, NumPyBackend(bits), rules).pixels.astype(np.float64)
        picture = Picture(pixels, roundoff=2.0**-24)
        shown.append(Exhibit(picture, right, compare(picture, right).outside))
    return Evidence(shown)


def _diffuse(i: Vec, n: Vec) -> Any:
    return sqrt0(LECTURE.lambert(i, n))


def _specular(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Any:
    return sqrt0(LECTURE.phong(i, n, v, s, mirrored))


def _grey(ambient: Vec) -> Vec:
    return Vec(ambient.x, ambient.x, ambient.x)


def _half_way(i: Vec, n: Vec) -> Vec:
    return unit(LECTURE.mirror(i, n) + n)


def _squared(*asked: Any) -> tuple[Vec, Vec]:
    reflect, transmit = LECTURE.weights(*asked)
    return reflect * reflect, transmit


STRANGE: dict[str, dict[str, Any]] = {
    "diffuse": {"lambert": _diffuse},
    "specular": {"phong": _specular},
    "ambient": {"ambient_light": _grey},
    "reflected": {"mirror": _half_way},
    "branches": {"weights": _squared},
    "visibility": {"blocks": lambda distance, light, opaque: (distance < light) & (distance > 1.0)},
}
"""Mistakes that no dictionary lists, by the term they live in."""


@pytest.mark.parametrize("term", STRANGE)
def test_a_mistake_of_no_dictionary_is_sought_in_its_term(truths: list[Truth], term: str) -> None:
    assert located(evidence(truths, instead(term, **STRANGE[term])))[0].term.name == term


def test_the_strange_mistakes_are_no_known_ones() -> None:
    known = {getattr(fault.rules, entry) for fault in FAULTS for entry in fault.entries}
    assert not known & {formula for entries in STRANGE.values() for formula in entries.values()}


def test_a_known_fault_looks_most_like_itself(truths: list[Truth]) -> None:
    fault = next(fault for fault in FAULTS if fault.name == "no-highlight")
    place = located(evidence(truths, fault.rules, 64))[0]
    assert (place.term.name, place.like) == ("specular", fault)
    # Twice the same float64 pictures: what is wrong and what is changed are equal, and cosines but for some roundings
    assert place.likeness == pytest.approx(1.0, abs=32 * 2.0**-53)


def test_a_hidden_fault_is_found_by_the_mutants(truths: list[Truth]) -> None:
    fault = next(fault for fault in FAULTS if fault.name == "no-highlight")
    place = located(evidence(truths, fault.rules), [f for f in FAULTS if not f.entries & fault.entries])[0]
    assert (place.term.name, place.like.group) == ("specular", GROUP)


@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_every_mutant_changes_a_picture(truths: list[Truth], mutant: Any) -> None:
    lanes = NumPyBackend(64)
    assert any(
        not np.array_equal(render(right.scene, lanes, mutant.rules).pixels, render(right.scene, lanes).pixels)
        for right in truths
    )


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.name)
def test_every_term_has_mutants(term: Any) -> None:
    assert any(term_of(mutant) is term for mutant in MUTANTS)


def test_mutants_change_one_entry_each_and_are_told_apart() -> None:
    assert [mutant.entries for mutant in MUTANTS] == [frozenset({e}) for e, (_, ways) in WAYS.items() for _ in ways]
    assert len({mutant.name for mutant in MUTANTS}) == len(MUTANTS)


def test_mutants_of_a_dialect_keep_its_other_formulas() -> None:
    base = rules(Dialect(specular="blinn"))
    changed = next(mutant for mutant in mutants(base) if mutant.entries == {"phong"})
    asked = Vec(0.0, 1.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.6, -0.8, 0.0), 3, Vec(0.0, 1.0, 0.0)
    assert changed.rules.phong(*asked) == base.phong(*asked) / 2


def test_both_parts_of_the_evidence_count() -> None:
    one = Place(TERMS[0], FAULTS[0], alike=1.0, wrong=1, changed=1)
    other = Place(TERMS[0], FAULTS[0], alike=0.0, wrong=1, changed=1)
    assert (one.likeness, other.likeness, one.and_also(other).likeness) == (1.0, 0.0, 0.5)
