"""raycheck stability from the command line: our methods, a stranger's, and wrong calls."""

from __future__ import annotations

import sys
from collections.abc import Callable
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
        (f"images:{Path(__file__).parent}", 2, "neither sphere nor refract"),
        ("python:student_tracer:nothing", 3, "can neither render nor trace"),
        ("python:student_tracer:shapeless", 3, "shape"),
        ("python:student_tracer:raising", 3, "ZeroDivisionError"),
    ],
)
def test_what_cannot_be_asked_is_told(
    subject: str, code: int, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["stability", subject, "--out", str(tmp_path)]) == code
    assert said in capsys.readouterr().err


PROBE = """
import sys
print_ = lambda *words: print(*words, flush=True)
for line in sys.stdin:
    word, *rest = line.split()
    n = [float(x) for x in rest]
    b = [p - q for p, q in zip(n[0:3], n[6:9])]
    if word == "hello":
        print_("raycheck 1 team float64 sphere")
        continue
    bv = sum(p * q for p, q in zip(b, n[3:6]))
    D = bv * bv - (sum(p * p for p in b) - n[9] * n[9])
    print_(ANSWER)
"""
RIGHT = "-bv - D ** 0.5 if D >= 0 else 'miss'"


def with_probe(manifest: Callable[..., Path], answer: str) -> Path:
    """A tracer in float64 that answers about spheres, and draws nothing."""
    probe = f'probe = ["{sys.executable}", "-S", "probe.py"]'
    render = 'render = ["true", "{scene}", "{image}"]'
    folder = manifest(f'[tracer]\nname = "Team 7"\nprecision = "float64"\n{render}\n{probe}\n')
    (folder / "probe.py").write_text(PROBE.replace("ANSWER", answer), "utf-8")
    return folder


def reach(found: stability.Stability, question: str) -> dict[str, float | None]:
    own = (f for f in found.frontiers if f.question == question and f.precision == "float64")
    return {f.method: f.reach for f in own}


@pytest.mark.usefixtures("quick")
def test_a_folder_with_a_probe_is_asked_and_reaches_as_far_as_its_formula(
    manifest: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = with_probe(manifest, RIGHT)
    assert main(["stability", str(folder), "--out", str(tmp_path / "out")]) == 0
    told = capsys.readouterr().out
    assert f"{folder} in float64: hit points good to r/1000 up to D = " in told
    reached = reach(stability.read(tmp_path / "out"), "distance")
    # the lecture's formula, summed in another order
    low, high = reached["lecture"], reached["perpendicular"]
    assert low is not None
    assert high is not None
    assert low / 10 < (reached[str(folder)] or 0.0) < low * 10 < high


@pytest.mark.usefixtures("quick")
def test_a_probe_that_prints_no_number_far_away_fails_there_only(manifest: Callable[..., Path], tmp_path: Path) -> None:
    folder = with_probe(manifest, f"({RIGHT}) if bv > -1000 else 'nan'")
    assert main(["stability", str(folder), "--out", str(tmp_path / "out")]) == 0
    steps = reach(stability.read(tmp_path / "out"), "distance")
    assert 700 < (steps[str(folder)] or 0.0) < 1000  # an eighth of a decade before 1000


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(("answer", "said"), [("1 / 0", "exit status 1"), ("'unsupported'", "does not answer sphere")])
def test_a_probe_that_ends_or_refuses_ends_the_measurement(
    answer: str, said: str, manifest: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = with_probe(manifest, answer)
    assert main(["stability", str(folder), "--out", str(tmp_path / "out")]) == 3
    assert said in capsys.readouterr().err


def test_the_precision_of_a_folder_is_not_the_callers_to_say(
    manifest: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = with_probe(manifest, RIGHT)
    assert main(["stability", str(folder), "--precision", "float32", "--out", str(tmp_path / "out")]) == 2
    assert "raycheck.toml says it" in capsys.readouterr().err


@pytest.mark.usefixtures("quick")
def test_our_own_tracer_is_a_subject_like_others(tmp_path: Path) -> None:
    assert main(["stability", "builtin:reference/numpy/64", "--out", str(tmp_path)]) == 0
    reached = reach(stability.read(tmp_path), "bending")
    assert reached["builtin:reference/numpy/64"] == reached["division-free"]
