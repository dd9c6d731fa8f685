"""Every law notices a fault of the dictionary, and none fails a correct tracer."""

from __future__ import annotations

import numpy as np
import pytest

from oracles.faults import FAULTS, TWINS, Fault, Twin, fault
from oracles.faults.files import linear
from oracles.faults.law_power import ENTRIES, FaultyStudio, LawBench, asks, formula_excess
from oracles.laws import Law, formula_laws
from oracles.laws.pictures import PictureLaw, picture_laws
from reference_tracer.operations import ANSWERS

BENCH = LawBench()
STUDIOS: dict[str, FaultyStudio] = {}


def name_of(entry: Law | PictureLaw | Twin) -> str:
    return entry.name


def studio_of(entry: Fault) -> FaultyStudio:
    """One studio a fault, so that no test draws its pictures again."""
    return STUDIOS.setdefault(entry.name, FaultyStudio(entry, BENCH))


@pytest.mark.parametrize("law", formula_laws(), ids=name_of)
def test_a_law_of_formulas_notices_a_fault(law: Law) -> None:
    assert any(formula_excess(law, entry) > 1.0 for entry in FAULTS)


@pytest.mark.parametrize("law", picture_laws(), ids=name_of)
def test_a_law_of_pictures_notices_a_fault(law: PictureLaw) -> None:
    assert any(studio_of(entry).excess(law) > 1.0 for entry in FAULTS)


@pytest.mark.parametrize("entry", TWINS, ids=name_of)
def test_no_law_fails_a_correct_tracer(entry: Twin) -> None:
    assert list(BENCH.kills(entry)) == []


def test_the_kills_of_a_fault_are_laws_of_its_formula_and_of_pictures() -> None:
    kills = {kill.law: kill.excess for kill in BENCH.kills(fault("light-mirrored-by-2n-minus-i"))}
    assert kills["reflect/angle"] > 1e5
    assert "phong/lobe" in kills
    assert not any(law.startswith(("sphere/", "plane/", "refract/")) for law in kills)
    assert set(kills) <= set(BENCH.names)


def test_a_fault_in_the_file_breaks_laws_of_pictures_only() -> None:
    kills = [kill.law for kill in BENCH.kills(fault("upside-down"))]
    assert kills
    assert all(law.startswith("image/") for law in kills)


def test_a_picture_of_nan_breaks_every_law_that_looks_at_it() -> None:
    nowhere = Fault("nowhere", "", "", "", "", "", "", picture=lambda pixels, scene: linear(pixels * np.nan))
    assert {kill.excess for kill in BENCH.kills(nowhere)} == {np.inf}


def test_every_operation_of_the_probe_is_told_the_entries_that_it_asks() -> None:
    assert set(ENTRIES) | {"trace"} == set(ANSWERS)
    for law in formula_laws():
        assert asks(law, frozenset({"camera_ray"})) == (law.asks[0] in ("camera", "trace"))
        assert not asks(law, frozenset())
