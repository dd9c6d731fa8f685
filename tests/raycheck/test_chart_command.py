"""raycheck chart from the command line: subjects among ours, wrong ones kept off the frontier."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

import pytest

from oracles.chart import depth, panels
from raycheck import lanes, race
from raycheck.cli import main
from raycheck.commands import chart as command
from reference_tracer import plain
from reports import chart
from scenes.files import load


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same measurement, small, on NumPy."""
    for module, settings in (
        (panels, {"ROUNDS": 1, "RAYS": 16, "NUMPY_RAYS": 64, "SCALAR_RAYS": 1}),
        (depth, {"ROUNDS": 1, "JUDGED": (8, 6), "TIMED": (8, 6), "DEEPEST": 3}),
        (race, {"ROUNDS": 1, "SIZE": (16, 12), "best_lanes": lambda: "numpy"}),
        (command, {"best_lanes": lambda: "numpy"}),
        (lanes, {"best_lanes": lambda: "numpy"}),
    ):
        for name, value in settings.items():
            monkeypatch.setattr(module, name, value)


@pytest.fixture
def students(monkeypatch: pytest.MonkeyPatch) -> None:
    def right(path: str) -> object:
        return plain.render(load(Path(path))).pixels

    def object_with(render: object) -> object:
        return type("T", (), {"render": staticmethod(render)})()

    module = ModuleType("student_tracers")
    module.right = object_with(right)
    module.wrong = object_with(lambda path: right(path) * 1.1)
    module.silent = object_with(lambda path: 1 / 0)
    monkeypatch.setitem(sys.modules, "student_tracers", module)


@pytest.mark.usefixtures("quick", "students")
def test_subjects_stand_among_ours_and_a_wrong_one_is_never_on_the_frontier(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [f"python:student_tracers:{name}" for name in ("right", "wrong", "silent")]
    assert main(["chart", *names, "--precision", "float64", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "no dot: python:student_tracers:silent: error: ZeroDivisionError" in told
    found = chart.read(tmp_path)
    tracers = {p.name: p for p in found.points if p.panel == "tracers"}
    assert "reference tracer (plain, float64)" in tracers
    assert tracers[names[0]].wrong == 0.0
    assert tracers[names[0]].error == tracers["reference tracer (plain, float64)"].error
    assert tracers[names[1]].wrong > 0.0
    assert not tracers[names[1]].frontier
    assert names[2] not in tracers
    (tmp_path / "index.html").unlink()
    assert main(["report", str(tmp_path)]) == 0
    assert "Whole tracers" in (tmp_path / "index.html").read_text("utf-8")


def test_a_subject_that_is_none_is_refused_before_anything_is_measured(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["chart", str(tmp_path / "nowhere"), "--out", str(tmp_path)]) == 2
    assert "no such folder" in capsys.readouterr().err


def test_pictures_that_are_there_already_take_no_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["chart", f"images:{tmp_path}", "--out", str(tmp_path / "out")]) == 2
    assert "takes no time" in capsys.readouterr().err


@pytest.mark.usefixtures("quick")
def test_a_tracer_that_lacks_a_feature_is_not_raced(monkeypatch: pytest.MonkeyPatch) -> None:
    subject = race.ours()[0]
    monkeypatch.setattr(subject, "features", ("plane",), raising=False)
    points, remarks = race.points([subject], 0, lambda what: None)
    assert points == []
    assert "unsupported: lecture-final needs" in remarks[0]
