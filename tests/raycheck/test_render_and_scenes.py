"""The reference tracer and the catalogue from the command line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from oracles.images import read
from reference_tracer import plain
from reference_tracer.formulas.display import encode
from reports import results
from scenes.catalogue import ladder, rung
from scenes.files import load
from scenes.json_form import from_json, to_json
from scenes.text import from_text, to_text

Raycheck = Callable[..., Any]


@pytest.fixture(scope="module")
def expected() -> np.ndarray[Any, Any]:
    return plain.render(rung("depth-order").scene().resized(16, 12)).pixels


@pytest.mark.parametrize("ending", ["exr", "pfm", "npy", "ppm", "png"])
def test_render_writes_the_reference_picture_in_every_format(
    raycheck: Raycheck, tmp_path: Path, expected: np.ndarray[Any, Any], ending: str
) -> None:
    path = tmp_path / f"x.{ending}"
    assert raycheck("render", "depth-order", path, "--size", "16x12").code == 0
    picture = read(path, 16, 12)
    if picture.maximum is not None:
        assert np.array_equal(picture.values, encode(expected, "lecture"))
    elif ending == "npy":
        assert np.array_equal(picture.values, expected)
    else:
        assert np.array_equal(picture.values, expected.astype(np.float32))


@pytest.mark.parametrize("arithmetic", ["plain", "numpy", "drjit"])
def test_every_arithmetic_renders_the_same_picture(
    raycheck: Raycheck, tmp_path: Path, expected: np.ndarray[Any, Any], arithmetic: str
) -> None:
    from raycheck.lanes import best_lanes

    if arithmetic == "drjit" and best_lanes() != "drjit":
        pytest.skip("no libLLVM that DrJit can use")
    assert (
        raycheck("render", "depth-order", tmp_path / "x.npy", "--size", "16x12", "--arithmetic", arithmetic).code == 0
    )
    assert np.array_equal(np.load(tmp_path / "x.npy"), expected)


def test_precision_32_renders_in_32_bits(raycheck: Raycheck, tmp_path: Path) -> None:
    words = ("--size", "16x12", "--arithmetic", "numpy", "--precision", "32")
    assert raycheck("render", "depth-order", tmp_path / "x.npy", *words).code == 0
    assert np.load(tmp_path / "x.npy").dtype == np.float32


def test_depth_0_takes_the_mirrors_away(raycheck: Raycheck, tmp_path: Path) -> None:
    for depth in (0, 3):
        path = tmp_path / f"{depth}.npy"
        assert raycheck("render", "mirror-perfect", path, "--size", "16x12", "--depth", depth).code == 0
    assert not np.array_equal(np.load(tmp_path / "0.npy"), np.load(tmp_path / "3.npy"))


def test_render_reads_scene_files_in_both_notations(raycheck: Raycheck, tmp_path: Path) -> None:
    scene = rung("depth-order").scene().resized(16, 12)
    (tmp_path / "a.json").write_text(to_json(scene), "utf-8")
    (tmp_path / "a.txt").write_text(to_text(scene), "utf-8")
    for ending in ("json", "txt"):
        assert raycheck("render", tmp_path / f"a.{ending}", tmp_path / f"{ending}.npy").code == 0
    assert np.array_equal(np.load(tmp_path / "json.npy"), np.load(tmp_path / "txt.npy"))


def test_render_leaves_nothing_beside_the_image(raycheck: Raycheck, tmp_path: Path) -> None:
    raycheck("render", "background", tmp_path / "x.exr", "--size", "4x3")
    assert [path.name for path in tmp_path.iterdir()] == ["x.exr"]


def test_render_onto_a_folder_is_exit_2(raycheck: Raycheck, tmp_path: Path) -> None:
    (tmp_path / "x.png").mkdir()
    told = raycheck("render", "background", tmp_path / "x.png", "--size", "4x3")
    assert told.code == 2
    assert [path.name for path in tmp_path.iterdir()] == ["x.png"]


@pytest.mark.parametrize("name", [entry.name for entry in ladder()])
def test_both_notations_of_a_scene_read_back_as_the_scene(raycheck: Raycheck, name: str) -> None:
    scene = rung(name).scene()
    assert from_json(raycheck("scenes", name).out) == scene
    assert from_json(raycheck("scenes", name, "--as", "json").out) == scene
    assert from_text(raycheck("scenes", name, "--as", "text").out) == scene


def test_a_scene_file_is_turned_into_the_other_notation(raycheck: Raycheck, tmp_path: Path) -> None:
    path = tmp_path / "mine.txt"
    path.write_text(raycheck("scenes", "glass-sphere", "--as", "text").out, "utf-8")
    assert from_json(raycheck("scenes", path).out) == load(path)


@pytest.mark.parametrize("text", ["{}", "[", "raycheck 1", ""])
def test_a_wrong_scene_file_is_exit_2_and_named(raycheck: Raycheck, tmp_path: Path, text: str) -> None:
    for path in (tmp_path / "x.json", tmp_path / "x.txt"):
        path.write_text(text, "utf-8")
        told = raycheck("scenes", path)
        assert told.code == 2
        assert str(path) in told.err


def test_report_writes_the_same_bytes_again(raycheck: Raycheck, tmp_path: Path) -> None:
    out = tmp_path / "o"
    raycheck("check", f"images:{tmp_path}", "--scenes", "background,headlight-plane", "--out", out)
    names = ("index.html", "junit.xml", "results.json")
    before = {name: (out / name).read_bytes() for name in names}
    (out / "index.html").unlink()
    (out / "junit.xml").write_text("old")
    told = raycheck("report", out)
    assert told.code == 0
    assert told.out == f"{out / 'index.html'}\n"
    assert {name: (out / name).read_bytes() for name in names} == before


@pytest.mark.parametrize(
    "garbage", ["", "{", "[]", "null", '{"schema_version": 2}', "[" * 100_000, "\x00", '"\\ud800"']
)
def test_a_report_on_garbage_is_exit_2_and_names_the_file(raycheck: Raycheck, tmp_path: Path, garbage: str) -> None:
    (tmp_path / results.FILE).write_text(garbage, "utf-8")
    told = raycheck("report", tmp_path)
    assert told.code == 2
    assert str(tmp_path / results.FILE) in told.err
    assert [path.name for path in tmp_path.iterdir()] == [results.FILE]


def test_a_report_that_cannot_be_written_is_exit_2(raycheck: Raycheck, tmp_path: Path) -> None:
    raycheck("check", "builtin:reference", "--scenes", "background", "--out", tmp_path)
    (tmp_path / "index.html").unlink()
    (tmp_path / "index.html").mkdir()
    assert raycheck("report", tmp_path).code == 2
