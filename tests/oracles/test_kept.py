"""Truths kept between runs: the same as computed, told apart by all they follow from, never half or damaged."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from oracles import kept
from oracles import truth as truths
from oracles.truth import Truth
from reference_tracer.dialects import SCENE_MODEL, Dialect, rules
from scenes.catalogue import rung
from scenes.model import Scene


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(kept.FOLDER_VARIABLE, str(tmp_path / "cache"))
    return tmp_path / "cache"


def small(name: str = "glass-sphere") -> Scene:
    return rung(name).scene().resized(16, 12)


def same(a: Truth, b: Truth) -> bool:
    return all(np.array_equal(getattr(a, part), getattr(b, part)) for part in ("pixels", "tolerance", "doubts"))


def test_a_kept_truth_is_the_computed_one_and_is_not_computed_again(
    place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    computed = truths.truth(small(), "float32")
    assert same(kept.truth(small(), "float32", "numpy"), computed)
    monkeypatch.setattr(truths, "truth", None)
    assert same(kept.truth(small(), "float32", "numpy"), computed)


def test_scene_precision_and_dialect_each_have_truths_of_their_own(place: Path) -> None:
    for scene in (small(), small("phong-10")):
        for precision in ("float32", "float64"):
            for dialect in (SCENE_MODEL, Dialect(lambert="1/pi")):
                found = kept.truth(scene, precision, "numpy", dialect)
                assert same(found, truths.truth(scene, precision, rules=rules(dialect)))
    assert len(list(place.iterdir())) == 8


@pytest.mark.parametrize("damage", [b"", b"PK", b"not an archive at all"])
def test_a_damaged_one_is_computed_again(place: Path, damage: bytes) -> None:
    computed = kept.truth(small(), "float32", "numpy")
    (path,) = place.iterdir()
    path.write_bytes(damage)
    assert same(kept.truth(small(), "float32", "numpy"), computed)
    path.write_bytes(path.read_bytes()[:-50])
    assert same(kept.truth(small(), "float32", "numpy"), computed)


def test_the_oldest_go_when_there_is_no_more_room(place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept.truth(small(), "float32", "numpy")
    (oldest,) = place.iterdir()
    os.utime(oldest, (0, 0))
    monkeypatch.setattr(kept, "MOST_BYTES", oldest.stat().st_size * 3 // 2)
    kept.truth(small("phong-10"), "float32", "numpy")
    kept.truth(small("two-lights"), "float32", "numpy")
    assert not oldest.exists()


def test_without_a_place_to_keep_them_truths_are_still_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("in the way", "utf-8")
    monkeypatch.setenv(kept.FOLDER_VARIABLE, str(tmp_path / "file"))
    assert same(kept.truth(small(), "float32", "numpy"), truths.truth(small(), "float32"))
