"""raycheck needs from the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from scenes.catalogue import rung
from scenes.json_form import to_json

Raycheck = Callable[..., Any]


def test_the_table_names_model_proofs_precision_and_times(raycheck: Raycheck) -> None:
    told = raycheck("needs", "shadow-hard", "--size", "24x18")
    assert told.code == 0
    assert "shadow-hard at 24x18 needs features: plane, shadow; depth: 0\n" in told.out
    assert "of 1 lights, 2 objects it needs 1 and 2\n" in told.out
    assert "\n  shadow        " in told.out
    assert "precision and method: float32, sphere: lecture" in told.out
    assert "\n  what suffices" in told.out
    assert "\n  float64 " in told.out
    assert "(depth 1 changes nothing)" in told.out


def test_a_file_that_asks_for_too_much_is_told_what_that_costs(raycheck: Raycheck, tmp_path: Path) -> None:
    path = tmp_path / "deep.json"
    path.write_text(to_json(rung("mirror-perfect").scene().with_depth(3)), "utf-8")
    told = raycheck("needs", path, "--size", "24x18")
    assert told.code == 0
    assert "\n  not needed: depth 3\n  not needed: depth 2\n" in told.out
    assert "\n  with depth 3 " in told.out
    assert "\n  all that the scene asks for " in told.out


def test_an_unknown_scene_is_misuse(raycheck: Raycheck) -> None:
    told = raycheck("needs", "no-such-scene")
    assert told.code == 2
    assert "no such scene" in told.err
