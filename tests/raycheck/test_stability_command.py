"""raycheck stability from the command line: our methods, a stranger's, and wrong calls."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from oracles.stability import depths, frontiers, maps, starts
from raycheck.cli import main
from reports import stability


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """The same measurement on few inputs."""
    monkeypatch.setattr(maps, "RAYS", 8)
    monkeypatch.setattr(frontiers, "RAYS", 8)
    monkeypatch.setattr(starts, "RAYS", 50)
    monkeypatch.setattr(depths, "SIZE", (8, 6))
    monkeypatch.setattr(depths, "DEEPEST", 1)


class Tracer:
    """The lecture's formula as a student writes it on arrays."""

    @staticmethod
    def sphere(o, v, c, r):
        b = o - c
        bv = (b * v).sum(axis=1)
        with np.errstate(invalid="ignore"):
            root = np.sqrt(bv * bv - ((b * b).sum(axis=1) - r * r))
        near = np.where(-bv - root > 0, -bv - root, -bv + root)
        return np.where(near > 0, near, np.nan)


@pytest.fixture
def student(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    module = ModuleType("student_tracer")
    module.good = Tracer()
    module.nothing = object()
    module.shapeless = type("T", (), {"trace": None, "sphere": staticmethod(lambda *a: 1.0)})()
    module.raising = type("T", (), {"trace": None, "sphere": staticmethod(lambda *a: 1 / 0)})()
    module.deaf = type("T", (), {"trace": None})()
    module.good.trace = None
    monkeypatch.setitem(sys.modules, "student_tracer", module)
    return module


@pytest.mark.usefixtures("quick")
def test_our_methods_are_measured_and_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["stability", "--out", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    assert "The lecture in float32" in told
    assert f"report: {tmp_path / 'index.html'}" in told
    found = stability.read(tmp_path)
    assert len(found.experiments) == 10
    assert {case.number for case in found.cases} == set(range(1, 22))
    (tmp_path / "index.html").unlink()
    assert main(["report", str(tmp_path)]) == 0
    assert (tmp_path / "index.html").is_file()


@pytest.mark.usefixtures("quick", "student")
def test_a_strangers_sphere_stands_beside_ours(tmp_path: Path) -> None:
    assert main(["stability", "python:student_tracer:good", "--precision", "float64", "--out", str(tmp_path)]) == 0
    found = stability.read(tmp_path)
    spec = "python:student_tracer:good"
    reach = {f.method: f.reach for f in found.frontiers if f.question == "distance" and f.precision == "float64"}
    assert reach[spec] == reach["lecture"]  # the same formula, the same bits
    assert {m.precision for e in found.experiments for m in e.maps if m.method == spec} == {"float64"}
    assert "python:student_tracer:good in float64" in (tmp_path / "index.html").read_text("utf-8")


@pytest.mark.usefixtures("quick", "student")
@pytest.mark.parametrize(
    ("subject", "code", "said"),
    [
        ("python:student_tracer:deaf", 2, "neither sphere nor refract"),
        ("python:student_tracer:nothing", 3, "can neither render nor trace"),
        ("python:student_tracer:shapeless", 3, "shape"),
        ("python:student_tracer:raising", 3, "ZeroDivisionError"),
        ("builtin:reference", 2, "python:module:attr"),
    ],
)
def test_what_cannot_be_asked_is_told(
    subject: str, code: int, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["stability", subject, "--out", str(tmp_path)]) == code
    assert said in capsys.readouterr().err
