"""The ladder: complete, in order, and every rung with its slide and formula."""

from __future__ import annotations

from importlib import resources

import pytest

from raycheck.formulas import FORMULAS, formula_of
from scenes.catalogue import catalogue_hash, ladder, rung
from scenes.errors import SceneError

NAMES = [entry.name for entry in ladder()]


def test_the_ladder_has_at_least_30_rungs_of_different_names() -> None:
    assert len(NAMES) >= 30
    assert len(set(NAMES)) == len(NAMES)


def test_the_ladder_and_the_files_are_the_same_scenes() -> None:
    files = {entry.name for entry in resources.files("scenes.catalogue").iterdir() if entry.name.endswith(".json")}
    assert files == {f"{name}.json" for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_is_named_as_its_file(name: str) -> None:
    assert rung(name).scene().name == name


@pytest.mark.parametrize("name", NAMES)
def test_a_rung_requires_only_earlier_rungs_each_once(name: str) -> None:
    required = rung(name).requires
    assert set(required) <= set(NAMES[: NAMES.index(name)])
    assert len(set(required)) == len(required)


@pytest.mark.parametrize("name", NAMES)
def test_a_rung_teaches_one_idea_from_a_slide_with_a_formula(name: str) -> None:
    assert rung(name).teaches
    assert formula_of(rung(name).slide)


@pytest.mark.parametrize("name", NAMES)
def test_the_source_in_the_scene_is_the_slide_of_its_rung(name: str) -> None:
    assert rung(name).scene().source == f"L11: {rung(name).slide}"


def test_every_formula_belongs_to_a_slide_of_the_ladder() -> None:
    assert set(FORMULAS) == {entry.slide for entry in ladder()}


@pytest.mark.parametrize("name", NAMES)
def test_every_material_of_a_scene_is_used(name: str) -> None:
    scene = rung(name).scene()
    assert set(scene.materials) == {thing.material for thing in scene.objects}


def test_an_unknown_name_is_refused_with_the_nearest_ones() -> None:
    with pytest.raises(SceneError, match=r"got 'phong-1000'\); expected for example phong-100") as caught:
        rung("phong-1000")
    assert caught.value.place == "catalogue"


def test_a_name_like_no_other_is_refused_with_the_first_ones() -> None:
    with pytest.raises(SceneError, match="for example background, "):
        rung("????")


def test_the_catalogue_hash_is_16_hexadecimal_digits() -> None:
    assert len(catalogue_hash()) == 16
    assert int(catalogue_hash(), 16) >= 0
