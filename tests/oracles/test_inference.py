"""Conventions found from pictures alone: each choice, slips, both at once; and nothing found where there is nothing."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from oracles.compare import compare
from oracles.conventions import SLIPS, Convention, Slip, transfer_of
from oracles.images.picture import Picture
from oracles.inference import Exhibit, infer, worth_saying
from oracles.truth import Truth, truth
from reference_tracer.dialects import CHOICES, SCENE_MODEL, Dialect
from reference_tracer.lanes import render as lanes
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.catalogue import ladder
from scenes.model import Scene

NAMES = (
    "headlight-plane", "headlight-sphere", "inside-sphere", "pixel-corner", "pixel-centre", "two-lights", "phong-10",
    "phong-terminator", "plane-both-sides", "shadow-glass", "mirror-perfect", "under-water", "glass-sphere", "strays",
    "lecture-final",
)  # fmt: skip
"""One scene at least tells each convention from the scene model's."""
SIZE = (32, 24)
ONE_CHOICE = [(key, value) for key, values in CHOICES.items() for value in values[1:]]
ONE_SLIP = [(name, word) for name, words in SLIPS.items() for word in words[1:]]


@pytest.fixture(scope="module")
def scenes() -> list[Scene]:
    return [rung.scene().resized(*SIZE) for rung in ladder() if rung.name in NAMES]


@pytest.fixture(scope="module")
def lawful(scenes: list[Scene]) -> dict[str, np.ndarray]:
    return {scene.name: picture(scene, Convention()).values for scene in scenes}


def picture(scene: Scene, convention: Convention, rules: Rulebook | None = None) -> Picture:
    """What a float32 tracer that follows the convention writes."""
    values = lanes.render(scene, lanes.backend("numpy", 32), rules or convention.rules()).pixels.astype(np.float64)
    transfer = transfer_of(convention.slip)
    if transfer is not None:
        values = transfer(values).astype(np.float32).astype(np.float64)
    return convention.slip.undone(Picture(values, roundoff=2.0**-24))  # each flip undoes itself


@cache
def as_declared(name: str) -> Truth:
    return truth(next(rung.scene().resized(*SIZE) for rung in ladder() if rung.name == name), "float32")


def exhibits(scenes: list[Scene], convention: Convention, rules: Rulebook | None = None) -> list[Exhibit]:
    shown = []
    for scene in scenes:
        drawn = picture(scene, convention, rules)
        declared = as_declared(scene.name)
        shown.append(Exhibit(drawn, declared, compare(drawn, declared).outside))
    return shown


def right(scenes: list[Scene], convention: Convention, shown: list[Exhibit]) -> int:
    """Pictures that the rigorous comparison passes under the convention."""
    count = sum(not exhibit.wrong.any() for exhibit in shown)
    for exhibit in (exhibit for exhibit in shown if exhibit.wrong.any()):
        expected = truth(exhibit.scene, "float32", rules=convention.rules())
        expected = replace(expected, transfer=transfer_of(convention.slip))
        count += compare(convention.slip.undone(exhibit.picture), expected).word != "fail"
    return count


@pytest.mark.parametrize(("key", "value"), ONE_CHOICE, ids=lambda word: str(word))
def test_a_dialect_is_inferred_and_its_pictures_conform_under_it(scenes: list[Scene], key: str, value: object) -> None:
    convention = Convention(Dialect(**{key: value}))  # type: ignore[arg-type]
    shown = exhibits(scenes, convention)
    assert infer(shown, "float32", SCENE_MODEL) == convention
    assert right(scenes, convention, shown) == len(scenes)


@pytest.mark.parametrize(("name", "word"), ONE_SLIP, ids=lambda word: str(word))
def test_a_slip_is_found_and_the_pictures_are_right_but_for_it(scenes: list[Scene], name: str, word: str) -> None:
    convention = Convention(slip=Slip(**{name: word}))
    shown = exhibits(scenes, convention)
    assert infer(shown, "float32", SCENE_MODEL) == convention
    assert right(scenes, convention, shown) == len(scenes)


@pytest.mark.parametrize(
    "convention",
    [
        Convention(Dialect(specular="blinn", lambert="1/pi"), Slip(flip="upside down")),
        Convention(Dialect(ambient="per_light", mix="lerp"), Slip(channels="BGR")),
        Convention(Dialect(sample="centre", tir="reflect", fresnel="schlick")),
        Convention(Dialect(limit="background"), Slip(flip="mirrored", pixel="w-1")),
    ],
    ids=lambda convention: "+".join(convention.dialect.lines() + convention.slip.words())[:60],
)
def test_several_at_once_are_all_found(scenes: list[Scene], convention: Convention) -> None:
    assert infer(exhibits(scenes, convention), "float32", SCENE_MODEL) == convention


def test_a_declared_dialect_that_is_wrong_is_corrected(scenes: list[Scene]) -> None:
    shown = exhibits(scenes, Convention())
    assert infer(shown, "float32", Dialect(specular="blinn", tir="reflect")) == Convention()


def test_right_pictures_follow_what_was_declared(scenes: list[Scene]) -> None:
    assert infer(exhibits(scenes, Convention()), "float32", SCENE_MODEL) == Convention()


def test_a_wrong_formula_is_no_convention(scenes: list[Scene]) -> None:
    inverted = replace(LECTURE, refract=lambda v, n, leaving, index: LECTURE.refract(v, n, leaving, 1.0 / index))
    shown = exhibits(scenes, Convention(), inverted)
    found = infer(shown, "float32", SCENE_MODEL)
    before = {e.scene.name: not e.wrong.any() for e in shown}
    assert not all(before.values())
    after = dict(before)
    for exhibit in shown:
        expected = truth(exhibit.scene, "float32", rules=found.rules())
        after[exhibit.scene.name] = compare(found.slip.undone(exhibit.picture), expected).word != "fail"
    assert found == Convention() or not worth_saying(before, after)


def test_a_convention_is_worth_saying_only_if_it_makes_most_right_and_none_wrong() -> None:
    before = {"a": True, "b": False, "c": False}
    assert worth_saying(before, {"a": True, "b": True, "c": False})
    assert not worth_saying(before, {"a": True, "b": False, "c": False})
    assert not worth_saying(before, {"a": False, "b": True, "c": True})
    assert not worth_saying({"a": False, "b": False, "c": False}, {"a": True, "b": False, "c": False})


@pytest.mark.parametrize("maximum", [255, 65535])
@pytest.mark.parametrize("word", ["sRGB", "gamma 2.2"])
def test_an_encoding_that_was_not_asked_for_is_known_from_codes_too(
    lawful: dict[str, np.ndarray], word: str, maximum: int
) -> None:
    scene = next(rung.scene().resized(*SIZE) for rung in ladder() if rung.name == "two-lights")
    transfer = transfer_of(Slip(transfer=word))
    assert transfer is not None
    codes = np.floor(np.clip(transfer(lawful["two-lights"]), 0.0, 1.0) * maximum)
    drawn = Picture(codes, maximum)
    expected = truth(scene, "float32")
    assert compare(drawn, expected).word == "fail"
    assert compare(drawn, replace(expected, transfer=transfer)).word == "pass"
    assert (
        compare(Picture(np.clip(codes + 3, 0, maximum), maximum), replace(expected, transfer=transfer)).word == "fail"
    )
