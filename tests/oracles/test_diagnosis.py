"""Diagnosis: the fault that a picture was made with is named, alone and in pairs; what is unknown is not named."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from oracles.compare import compare
from oracles.diagnosis import Answers, diagnose
from oracles.diagnosis.evidence import Evidence, composable, composed
from oracles.diagnosis.located import TERMS, term_of
from oracles.diagnosis.search import standing
from oracles.faults import FAULTS, Fault, fault
from oracles.faults.fault import instead
from oracles.faults.files import linear
from oracles.images import Picture
from oracles.images.picture import check
from oracles.inference import Exhibit
from oracles.truth import Truth, truth
from oracles.verdict import Diagnosis
from reference_tracer import dialects
from reference_tracer.dialects import Dialect
from reference_tracer.formulas import optics, shading
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.catalogue import ladder
from scenes.model import Scene

NAMES = (
    "background", "headlight-sphere", "depth-order", "inside-sphere", "ambient-diffuse", "point-light", "two-lights",
    "phong-10", "phong-terminator", "attenuation-inverse-square", "plane-both-sides", "shadow-hard", "mirror-imperfect",
    "facing-mirrors-3", "glass-sphere", "air-bubble", "reflect-and-refract", "off-centre-camera", "lecture-final",
)  # fmt: skip
SIZE = (40, 30)
ALONE = (
    "last-pixel-at-the-edge", "far-root", "farthest-wins", "normal-inward", "lamp-as-a-sun", "cosine-squared",
    "shadow-hides-the-highlight-only", "exponent-plus-1", "not-bent", "mirrored-straight-back", "weights-swapped",
    "one-generation-too-few", "bytes-in-a-linear-file", "half-precision-rays",
)  # fmt: skip
"""One of each formula."""
TOGETHER = (("cosine-half", "not-bent"), ("last-light-only", "values-up-to-255"), ("up-for-right", "weights-swapped"))


@cache
def scenes() -> tuple[Scene, ...]:
    found = {rung.name: rung.scene().resized(*SIZE) for rung in ladder()}
    return tuple(found[name] for name in NAMES)


@cache
def right(name: str, dialect: Dialect = dialects.SCENE_MODEL) -> Truth:
    scene = next(scene for scene in scenes() if scene.name == name)
    return truth(scene, "float32", "numpy", dialects.rules(dialect))


def exhibits(
    rules: Rulebook, faults: Sequence[Fault] = (), bits: int = 32, dialect: Dialect = dialects.SCENE_MODEL
) -> list[Exhibit]:
    """What a tracer with these rules and faults writes."""
    write = next((f.picture for f in faults if f.picture), None)
    shown = []
    for scene in scenes():
        with np.errstate(all="ignore"):
            pixels = render(scene, NumPyBackend(bits), composed(rules, faults)).pixels
        picture = check(write(pixels, scene) if write else linear(pixels, 2.0**-24 if bits == 32 else 0.0))
        expected = right(scene.name, dialect)
        shown.append(Exhibit(picture, expected, compare(picture, expected).outside))
    return shown


def named(found: Diagnosis | None) -> set[str]:
    assert found
    return {suspect.name for suspect in found.faults}


@pytest.mark.parametrize("name", ALONE)
def test_a_fault_is_named_from_its_pictures(name: str) -> None:
    found = diagnose(exhibits(LECTURE, [fault(name)]))
    assert found
    assert (found.kind, named(found)) == ("named", {name})
    assert found.explained == found.failing
    assert name in found.sentence


@pytest.mark.parametrize("names", TOGETHER, ids="+".join)
def test_two_faults_are_named_together(names: tuple[str, str]) -> None:
    found = diagnose(exhibits(LECTURE, [fault(name) for name in names]))
    assert found
    assert (found.kind, named(found)) == ("named", set(names))
    assert all(suspect.share < 1.0 for suspect in found.faults)


@pytest.mark.parametrize("bits", [32, 64])
def test_a_right_tracer_has_no_diagnosis(bits: int) -> None:
    assert diagnose(exhibits(LECTURE, bits=bits)) is None


def test_a_fault_is_named_in_codes_too() -> None:
    shown = []
    for exhibit in exhibits(LECTURE, [fault("cosine-half")]):
        codes = np.floor(255.0 * np.clip(exhibit.picture.values, 0.0, 1.0))
        picture = Picture(codes, 255)
        shown.append(Exhibit(picture, exhibit.declared, compare(picture, exhibit.declared).outside))
    assert named(diagnose(shown)) == {"cosine-half"}


def test_a_fault_is_named_under_another_dialect() -> None:
    dialect = Dialect(lambert="1/pi")
    base = dialects.rules(dialect)
    found = diagnose(exhibits(base, [fault("not-bent")], dialect=dialect), base)
    assert (found and found.kind, named(found)) == ("named", {"not-bent"})


def _cubed(i, n):
    cosine = shading.lambert(i, n)
    return cosine * cosine * cosine


def _half_bent(v, n, leaving, index):
    return optics.refract(v, n, leaving, (index + 1.0) * 0.5)


@pytest.mark.parametrize(
    ("entry", "wrong", "term"),
    [("lambert", _cubed, "diffuse"), ("refract", _half_bent, "refracted")],
)
def test_a_fault_that_is_not_known_is_not_named_but_located(entry: str, wrong, term: str) -> None:
    assert not any(getattr(f.rules, entry) is wrong for f in FAULTS)
    found = diagnose(exhibits(instead("unknown", **{entry: wrong})))
    assert found
    assert found.kind != "named"
    assert found.located
    assert found.located.term == term
    assert found.check
    assert found.pixel


def test_a_further_cause_makes_the_known_one_only_likely() -> None:
    rules = instead("both", lambert=_cubed, refract=fault("not-bent").rules.refract)
    found = diagnose(exhibits(rules))
    assert found
    assert found.kind != "named"


def test_answers_speak_where_no_picture_does() -> None:
    found = diagnose(exhibits(LECTURE), answers=Answers({"refract": ("law/refract/snell",)}, frozenset({"sphere"})))
    assert found
    assert found.kind == "unknown"
    assert found.located
    assert (found.located.term, found.located.laws) == ("refracted", ("law/refract/snell",))


def test_a_formula_that_answers_wrongly_is_where_the_error_is_sought() -> None:
    shown = exhibits(instead("unknown", refract=_half_bent))
    found = diagnose(shown, answers=Answers({"reflect": ("law/reflect/angle",)}, frozenset()))
    assert found
    assert found.located
    assert found.located.term == "reflected"


def test_a_formula_that_answers_rightly_stands_back_among_equals() -> None:
    shown = exhibits(LECTURE, [fault("mirror-direction-reversed")])
    for cleared, expected in (("phong", "mirror-direction-reversed"), ("reflect", "view-with-the-wrong-sign")):
        evidence = Evidence(shown, LECTURE, frozenset({cleared}))
        both = [standing(evidence, (fault(n),)) for n in ("mirror-direction-reversed", "view-with-the-wrong-sign")]
        assert max(both, key=lambda found: found.key).faults[0].name == expected


def test_pictures_that_are_known_wrong_elsewhere_do_not_mislead() -> None:
    shown = exhibits(LECTURE, [fault("no-shadows")])
    spoilt = replace(shown[0], wrong=np.zeros_like(shown[0].wrong))
    assert named(diagnose([spoilt, *shown[1:]])) == {"no-shadows"}


def test_every_entry_of_the_rulebook_belongs_to_one_term() -> None:
    entries = [entry for term in TERMS for entry in term.entries]
    assert len(entries) == len(set(entries))
    fields = set(Rulebook.__dataclass_fields__) - {"name"}
    assert set(entries) == fields


def test_every_fault_has_a_term() -> None:
    for known in FAULTS:
        assert known.picture is None or term_of(known).name == "picture"
        assert not known.entries or known.entries & term_of(known).entries


def test_faults_of_one_formula_cannot_be_together() -> None:
    assert not composable(fault("cosine-half"), fault("cosine-squared"))
    assert not composable(fault("upside-down"), fault("blue-for-red"))
    assert composable(fault("upside-down"), fault("cosine-squared"))
