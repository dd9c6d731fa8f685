"""What every law says of itself."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from oracles.laws import ORDER, Law, formula_laws
from oracles.laws.pictures import PictureLaw, picture_laws
from oracles.laws.rays import EXTENT
from oracles.truth import extent
from raycheck.formulas import FORMULAS
from reference_tracer.operations import ANSWERS
from scenes.catalogue import ladder

LAWS = (*formula_laws(), *picture_laws())
SLIDES = {*FORMULAS, "Math of Reflection Vector"}
"""Those of the catalogue, and one that it has no scene for."""
PAGE = Path(__file__).resolve().parents[3] / "docs" / "laws.md"


def name_of(law: Law | PictureLaw) -> str:
    return law.name


def test_there_are_at_least_forty_laws_of_different_names() -> None:
    assert len({law.name for law in LAWS}) == len(LAWS) >= 40


@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_a_law_tells_its_reason_its_slide_and_its_formula(law: Law | PictureLaw) -> None:
    assert len(law.reason) > 40
    assert law.slide in SLIDES
    assert law.statement
    assert law.formula


@pytest.mark.parametrize("law", formula_laws(), ids=name_of)
def test_a_law_asks_operations_of_the_protocol(law: Law) -> None:
    assert law.name.split("/")[0] in ORDER
    assert set(law.asks) <= set(ANSWERS)


def test_every_law_is_in_the_manual_with_its_statement() -> None:
    rows = dict(re.findall(r"^\| `([a-z]+/[a-z-]+)` \| ([^|]+) \|", PAGE.read_text("utf-8"), re.MULTILINE))
    assert {name: told.strip() for name, told in rows.items()} == {law.name: law.statement for law in LAWS}


def test_no_scene_whose_rays_start_on_surfaces_is_larger_than_the_laws_take_it_to_be() -> None:
    scenes = [rung.scene() for rung in ladder()]
    assert max(extent(scene) for scene in scenes if scene.features & {"shadow", "reflect", "refract"}) <= EXTENT
