"""The good example: it conforms, whatever it computes in and however far it steps off a surface."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from raycheck.cli import main
from raycheck.laws import all_laws
from reports import results
from scenes.catalogue import ladder


def checked(folder: Path, out: Path) -> results.Results:
    code = main(["check", str(folder), "--out", str(out)])
    found = results.read(out)
    assert code == (0 if found.conforms else 1)
    return found


def not_passed(found: results.Results) -> dict[str, str]:
    return {verdict.check: verdict.message for verdict in found.verdicts if verdict.verdict != "pass"}


def test_the_lecture_example_passes_every_rung_of_the_ladder(compiled: Callable[..., Path], tmp_path: Path) -> None:
    found = checked(compiled("cpp_lecture"), tmp_path / "out")
    assert not_passed(found) == {}
    assert len(found.verdicts) == len(ladder()) + 1 + len(all_laws())  # the probe's greeting is one


def test_the_lecture_example_in_double_passes_every_rung_at_float64(
    compiled: Callable[..., Path], tmp_path: Path
) -> None:
    # A PFM holds float32, whose rounding the comparison grants to whatever is stored in it
    found = checked(compiled("cpp_lecture", "-DREAL=double", float32="float64"), tmp_path / "out")
    assert found.subject.precision == "float64"
    assert not_passed(found) == {}


@pytest.mark.parametrize("step", ["7e-4", "1e-3", "2e-3"])
def test_the_lecture_example_passes_with_another_step_off_the_surface(
    compiled: Callable[..., Path], tmp_path: Path, step: str
) -> None:
    assert not_passed(checked(compiled("cpp_lecture", f"-DEPSILON={step}"), tmp_path / "out")) == {}


def test_the_lecture_example_in_double_passes_with_a_small_step(compiled: Callable[..., Path], tmp_path: Path) -> None:
    folder = compiled("cpp_lecture", "-DREAL=double -DEPSILON=1e-4", float32="float64")
    assert not_passed(checked(folder, tmp_path / "out")) == {}


def test_a_step_too_small_for_float32_makes_acne_that_is_seen(compiled: Callable[..., Path], tmp_path: Path) -> None:
    # docs/tolerance.md, "Where a ray starts": acne-free from about L·sqrt(8u) on, some 1e-3 in these scenes
    found = checked(compiled("cpp_lecture", "-DEPSILON=1e-4"), tmp_path / "out")
    assert {v.check for v in found.verdicts if v.verdict == "fail"} == {"image/shadow-hard"}


def test_a_step_beyond_what_float32_needs_leaks_light_where_a_wall_meets_the_floor(
    compiled: Callable[..., Path], tmp_path: Path
) -> None:
    # L·sqrt(8u) is 2.1e-3 in shadow-wall: a step of 2e-3 is lawful there, one of 5e-3 skips the wall,
    # and in lecture-final the foot of a ball
    found = checked(compiled("cpp_lecture", "-DEPSILON=5e-3"), tmp_path / "out")
    failing = {v.check for v in found.verdicts if v.verdict == "fail"}
    assert failing == {"image/shadow-wall", "image/lecture-final", "law/sphere/nearest-root"}


def test_the_lecture_example_in_float_fails_as_soon_as_it_claims_float64(
    compiled: Callable[..., Path], tmp_path: Path
) -> None:
    found = checked(compiled("cpp_lecture", float32="float64"), tmp_path / "out")
    assert "image/lecture-final" in {v.check for v in found.verdicts if v.verdict in ("fail", "blocked")}
    assert not found.conforms


def test_a_smoke_run_of_the_lecture_example_ends_in_a_pass(
    compiled: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["smoke", str(compiled("cpp_lecture"))]) == 0
    assert "# verdict: pass" in capsys.readouterr().out
