"""A submission with a known fault: named, charged once, and told without a word of hidden scenes."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from raycheck.examples import examples
from raycheck.grading.mistakes import sought
from raycheck.grading.one import Asked, grade
from raycheck.grading.rubric import Rubric
from raycheck.grading.submissions import found
from raycheck.known import Known
from raycheck.sandbox import Jail
from raycheck.sandbox.jail import missing
from raycheck.subjects.fault import FaultSubject
from raycheck.suite import Hearing, Plan
from reports import results
from reports.grades import Record
from scenes.catalogue import rung

needs_a_sandbox = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")

RIGHT, PLUS_ONE = "std::pow(gloss, real(m.shininess))", "std::pow(gloss, real(m.shininess) + 1)"
STRANGE = "std::pow(gloss, real(m.shininess) * real(0.7))"
GROUPS = [
    {"name": "Light", "points": 4, "rungs": ["ambient-diffuse", "point-light"]},
    {"name": "Phong", "points": 6, "rungs": ["phong-10", "phong-100", "phong-terminator"]},
]


@pytest.fixture
def graded(tmp_path: Path) -> Callable[..., Record]:
    """Grade the C++ example with another power, by a rubric in which a mistake costs so much."""

    def run(power: str, points: float = 2.0) -> Record:
        folder = tmp_path / "class" / "alice"
        shutil.copytree(examples() / "cpp_lecture", folder, ignore=shutil.ignore_patterns("tracer", "raycheck-*"))
        source = folder / "tracer.cpp"
        text = source.read_text("utf-8")
        assert RIGHT in text
        source.write_text(text.replace(RIGHT, power), "utf-8")
        told = {"name": "r", "group": GROUPS, "mistakes": {"points": points}, "hidden": {"points": 5, "scenes": 2}}
        for name in ("records", "students"):
            (tmp_path / "out" / name).mkdir(parents=True)
        rubric = Rubric.model_validate(told)
        return grade(Asked(rubric, 3, tmp_path / "out", Jail(rubric.limits)), found(tmp_path / "class")[0])

    return run


@needs_a_sandbox
def test_a_known_fault_is_named_and_charged_once(graded: Callable[..., Record], tmp_path: Path) -> None:
    record = graded(PLUS_ONE)
    assert record.faults == ("exponent-plus-1",)
    light, phong, hidden, known = record.groups
    assert (light.earned, phong.earned, hidden.earned, known.earned) == (4.0, 6.0, 5.0, -2.0)
    assert {line.counts for line in phong.lines} == {"explained"}
    assert record.earned == 13.0
    diagnosis = results.read(tmp_path / "out" / "students" / "alice").diagnosis
    assert diagnosis
    assert (diagnosis.kind, diagnosis.check) == ("named", "image/phong-10")


@needs_a_sandbox
def test_a_fault_that_nobody_knows_is_charged_by_what_it_breaks(graded: Callable[..., Record]) -> None:
    record = graded(STRANGE)
    _, phong, _, known = record.groups
    assert (record.faults, known.earned, known.lines) == ((), 0.0, ())
    assert phong.earned == 0.0


def test_of_hidden_scenes_nothing_is_told(tmp_path: Path) -> None:
    subject = FaultSubject("fault/exponent-plus-1")
    plan = Plan([rung("phong-10")], (24, 18), 0, False, Known({}), "{scene}")
    hearings = [Hearing(subject, replace(plan, rungs=rungs), tmp_path) for rungs in ([], plan.rungs)]
    verdicts = [verdict for hearing in hearings for verdict in hearing.verdicts()]
    rubric = Rubric.model_validate({"name": "r", "group": GROUPS, "mistakes": {"points": 1}})
    told = sought(rubric, *hearings, verdicts, tmp_path)
    assert list(told.named) == ["exponent-plus-1"]
    assert set(told.covered) == {"image/phong-10"}
    assert told.diagnosis
    assert (told.diagnosis.check, told.diagnosis.pixel, told.diagnosis.picture, told.diagnosis.reproduce) == (
        "",
        None,
        None,
        "",
    )
    assert not (tmp_path / "images" / "diagnosis.png").exists()
