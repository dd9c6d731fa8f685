"""raycheck faults, raycheck power, and a fault as a subject."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from oracles.faults import fault
from oracles.faults.files import linear
from raycheck.commands import power as command
from raycheck.subjects import fault as subjects
from reports import power, results

Raycheck = Callable[..., Any]
Patch = pytest.MonkeyPatch


def test_the_list_and_one_entry(raycheck: Raycheck) -> None:
    assert "mirrored-by-2n-minus-i" in raycheck("faults").out
    told = raycheck("faults", "mirrored-by-2n-minus-i")
    assert told.code == 0
    assert "2*dot(i, n)*n - i" in told.out
    assert raycheck("faults", "--explain", "mirrored-by-2n-minus-i").out == told.out


@pytest.mark.parametrize("words", [("mirrored",), ("--explain", "mirrored"), ("upside-down", "--explain", "far-root")])
def test_a_fault_that_is_none_and_two_at_once_are_misuse(raycheck: Raycheck, words: tuple[str, ...]) -> None:
    told = raycheck("faults", *words)
    assert told.code == 2
    assert "fault" in told.err


def test_a_fault_is_a_subject_that_does_not_conform(raycheck: Raycheck, tmp_path: Path) -> None:
    subject = "builtin:fault/exponent-plus-1"
    told = raycheck(
        "check", subject, "--scenes", "phong-10,background", "--size", "24x18", "--no-block", "--out", tmp_path
    )
    assert told.code == 1
    words = {verdict.check: verdict.verdict for verdict in results.read(tmp_path).verdicts}
    assert words["image/phong-10"] == "fail"
    assert words["image/background"] == "pass"


def test_a_fault_answers_the_laws_of_formulas(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", "builtin:fault/light-mirrored-by-2n-minus-i/64", "--laws", "reflect", "--out", tmp_path)
    assert told.code == 1
    failed = [verdict for verdict in results.read(tmp_path).verdicts if verdict.verdict == "fail"]
    assert failed
    assert "light-mirrored-by-2n-minus-i" in str(failed[0].model_dump())


def test_a_fault_that_writes_nan_is_invalid(
    raycheck: Raycheck, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(subjects, "picture", lambda *_: linear([[[float("nan")] * 3]]))
    raycheck("check", "builtin:fault/far-root", "--scenes", "background", "--size", "1x1", "--out", tmp_path)
    assert results.read(tmp_path).verdicts[0].verdict == "invalid"


@pytest.mark.parametrize("spec", ["fault", "fault/none-such", "fault/far-root/16", "fault/far-root/32/1"])
def test_no_such_fault_is_misuse(raycheck: Raycheck, tmp_path: Path, spec: str) -> None:
    assert raycheck("check", f"builtin:{spec}", "--out", tmp_path).code == 2


@pytest.mark.parametrize("name", ["upside-down", "fresnel-without-total-reflection"])
def test_power_writes_what_it_found(raycheck: Raycheck, tmp_path: Path, monkeypatch: Patch, name: str) -> None:
    monkeypatch.setattr(command, "FAULTS", (fault("byte-rounded"), fault(name)))
    monkeypatch.setattr(command, "TWINS", command.TWINS[:1])
    told = raycheck("power", "--size", "16x12", "--out", tmp_path)
    found = power.Power.model_validate_json((tmp_path / power.DATA).read_text("utf-8"))
    assert [entry.name for entry in found.faults] == ["byte-rounded", name]
    assert told.code == (0 if found.holds else 1)
    assert not found.wronged
    assert not found.missed
    assert "correct tracers are failed" in told.out
