"""power.json and power.html: what holds, what does not, and that names are escaped."""

from __future__ import annotations

import json
from importlib import resources
from pathlib import Path

import jsonschema
import pytest

from raycheck.machine import machine
from reports import power
from reports.power import FaultPower, LawKill, Power, SceneKill, TwinPower

KILL = SceneKill(scene="a", pixels=3, excess=7.5)
BROKEN = LawKill(law="reflect/angle", excess=None)
BLACK = SceneKill(scene="b", pixels=1, excess=None)


@pytest.fixture
def found() -> Power:
    noticed = FaultPower(name="noticed", group="light", fate="killed", reason="", kills=(KILL, BLACK), laws=(BROKEN,))
    excused = FaultPower(name="excused", group="light", fate="survives", reason="<b>too small</b>", kills=(), laws=())
    return Power(
        suite="0",
        machine=machine(),
        started="2020-01-01T00:00:00+00:00",
        command="raycheck power",
        seconds=1.0,
        size="48x36",
        scenes=("a", "b"),
        laws=("reflect/angle",),
        faults=(noticed, excused),
        twins=(TwinPower(name="twin", how="in another order", kills=(), laws=()),),
    )


def test_noticed_and_excused_faults_and_untouched_twins_hold(found: Power) -> None:
    assert found.holds
    assert list(power.lines(found))[-1].startswith(
        "1 of 2 faults are noticed on 2 scenes (48x36), 1 by 1 laws; 0 of 1 correct"
    )


def test_a_fault_that_nothing_notices_does_not_hold(found: Power) -> None:
    missed = found.faults[0].model_copy(update={"kills": ()})
    wrong = found.model_copy(update={"faults": (missed,), "scenes": ()})
    assert not wrong.holds
    assert "MISSED: no scene notices noticed" in list(power.lines(wrong))


def test_an_equivalent_fault_that_is_noticed_does_not_hold(found: Power) -> None:
    refuted = found.faults[0].model_copy(update={"fate": "equivalent"})
    assert not found.model_copy(update={"faults": (refuted,)}).holds


def test_a_failed_twin_does_not_hold(found: Power) -> None:
    wrong = found.model_copy(update={"twins": (found.twins[0].model_copy(update={"kills": (KILL,)}),)})
    assert not wrong.holds
    assert "WRONGED: a fails twin, which is correct (in another order)" in list(power.lines(wrong))


def test_a_twin_that_a_law_fails_does_not_hold(found: Power) -> None:
    wrong = found.model_copy(update={"twins": (found.twins[0].model_copy(update={"laws": (BROKEN,)}),)})
    assert not wrong.holds
    assert "WRONGED: reflect/angle fails twin, which is correct (in another order)" in list(power.lines(wrong))


def test_an_equivalent_fault_that_a_law_notices_does_not_hold(found: Power) -> None:
    refuted = found.faults[0].model_copy(update={"fate": "equivalent", "kills": ()})
    wrong = found.model_copy(update={"faults": (refuted,), "scenes": ()})
    assert "REFUTED: reflect/angle notices noticed, said to be equivalent" in list(power.lines(wrong))
    assert not wrong.holds


def test_a_law_that_notices_nothing_does_not_hold(found: Power) -> None:
    wrong = found.model_copy(update={"laws": ("reflect/angle", "reflect/unit")})
    assert not wrong.holds
    assert "IDLE: reflect/unit notices no fault" in list(power.lines(wrong))


def test_a_scene_that_notices_nothing_does_not_hold(found: Power) -> None:
    wrong = found.model_copy(update={"scenes": ("a", "b", "c")})
    assert not wrong.holds
    assert "IDLE: c notices no fault" in list(power.lines(wrong))


def test_the_committed_schema_is_the_generated_one_and_accepts_the_file(found: Power, tmp_path: Path) -> None:
    power.write(found, tmp_path)
    committed = resources.files("reports.schema").joinpath("power-1.json").read_text("utf-8")
    assert committed == power.schema()
    data = (tmp_path / power.DATA).read_text("utf-8")
    jsonschema.Draft202012Validator(json.loads(committed)).validate(json.loads(data))
    assert Power.model_validate_json(data) == found


def test_the_page_is_escaped(found: Power, tmp_path: Path) -> None:
    text = power.write(found, tmp_path).read_text("utf-8")
    assert "&lt;b&gt;too small" in text
    assert "<b>" not in text
