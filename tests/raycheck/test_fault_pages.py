"""raycheck faults --out: pages of the dictionary with their pictures."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from oracles.faults import FAULTS, fault
from oracles.faults.words import in_groups
from raycheck.commands import faults as command
from reports import lessons
from scenes.catalogue import rung

Raycheck = Callable[..., Any]
Patch = pytest.MonkeyPatch


@pytest.fixture(autouse=True)
def few_scenes(monkeypatch: Patch) -> None:
    monkeypatch.setattr(command, "ladder", lambda: tuple(rung(name) for name in ("background", "phong-10")))
    monkeypatch.setattr(command, "SIZE", (24, 18))


def test_one_fault_gets_one_page(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("faults", "--explain", "no-highlight", "--out", tmp_path / "pages")
    assert told.code == 0
    assert told.out.strip() == str(tmp_path / "pages" / "no-highlight.html")
    assert [path.name for path in (tmp_path / "pages").iterdir()] == ["no-highlight.html"]
    text = (tmp_path / "pages" / "no-highlight.html").read_text("utf-8")
    assert "phong-10 (shown above)" in text
    assert "1 of 2 scenes at 24x18" in text
    assert "raycheck check builtin:fault/no-highlight --scenes phong-10 --no-block" in text


def test_all_get_a_page_and_an_index(raycheck: Raycheck, tmp_path: Path, monkeypatch: Patch) -> None:
    chosen = [fault(name) for name in ("upside-down", "exponent-plus-1", "infinity-is-1e10")]
    monkeypatch.setattr(command, "in_groups", lambda: chosen)
    told = raycheck("faults", "--out", tmp_path)
    assert told.code == 0
    assert told.out.strip() == str(tmp_path / "index.html")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        ["index.html", *(f"{f.name}.html" for f in chosen)]
    )
    assert "No scene of the catalogue notices it" in (tmp_path / "infinity-is-1e10.html").read_text("utf-8")
    assert "the object of the smallest" in (tmp_path / "infinity-is-1e10.html").read_text("utf-8")


def test_all_entries_are_there_once_those_of_a_group_together() -> None:
    found = in_groups()
    assert sorted(f.name for f in found) == sorted(f.name for f in FAULTS)
    changes = sum(a.group != b.group for a, b in pairwise(found))
    assert changes + 1 == len({f.group for f in FAULTS})


def test_no_name_is_a_file_elsewhere_or_the_index() -> None:
    assert all(f.name.replace("-", "").isalnum() and f.name != "index" for f in FAULTS)


def test_an_unknown_fault_and_a_place_that_cannot_be_written_are_misuse(
    raycheck: Raycheck, tmp_path: Path, monkeypatch: Patch
) -> None:
    assert raycheck("faults", "--explain", "none-such", "--out", tmp_path).code == 2
    (tmp_path / "file").write_text("")
    assert raycheck("faults", "--explain", "far-root", "--out", tmp_path / "file").code == 2

    def full(*_: object) -> Path:
        raise OSError("no space")

    monkeypatch.setattr(lessons, "write_one", full)
    told = raycheck("faults", "--explain", "far-root", "--out", tmp_path)
    assert told.code == 2
    assert "no space" in told.err
