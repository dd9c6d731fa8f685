"""Goldens: proved, complete or absent, resumable, and refused as soon as they do not stand."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import OpenEXR
import pytest

import raycheck.cli
from oracles.golden import GoldenError, load, make, verify
from oracles.golden.record import Manifest, read_manifest
from reference_tracer import certified
from reference_tracer.dialects import Dialect, rules
from scenes.catalogue import ladder, rung
from scenes.model import Scene

ROOT = Path(raycheck.cli.__file__).parents[1]
NAMES = ("headlight-sphere", "two-lights", "glass-sphere")
MADE_BY = Manifest(suite="test", machine="a test", packages={}, command="", goldens={})


def scenes() -> list[Scene]:
    return [rung(name).scene().resized(24, 18) for name in NAMES]


def today(name: str) -> Scene | None:
    return {entry.name: entry.scene() for entry in ladder()}.get(name)


def silent(*_: object) -> None:
    """Tell nothing."""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    make(tmp_path, scenes(), MADE_BY, "numpy", 1, silent)
    return tmp_path


def test_fresh_goldens_stand(folder: Path) -> None:
    assert verify(folder, today, "numpy", silent) == {}


def test_a_golden_holds_the_exact_values(folder: Path) -> None:
    golden = load(folder / "glass-sphere.exr")
    truth = certified.render_exact(golden.scene)
    assert (np.abs(golden.value - truth.value) <= golden.bound + truth.bound).all()
    assert golden.decided.all()


def test_the_bound_in_the_exr_covers_its_storage_in_float32(folder: Path) -> None:
    golden = load(folder / "two-lights.exr")
    channels = OpenEXR.File(str(folder / "two-lights.exr"), separate_channels=True).channels()
    for k, name in enumerate("RGB"):
        stored, bound = (channels[key].pixels.astype(np.float64) for key in (name, f"bound.{name}"))
        assert (np.abs(stored - golden.value[:, :, k]) + golden.bound[:, :, k] <= bound).all()


def test_the_exr_tells_what_each_eye_ray_meets(folder: Path) -> None:
    channels = OpenEXR.File(str(folder / "headlight-sphere.exr"), separate_channels=True).channels()
    depth, thing = channels["depth.Z"].pixels, channels["object.id"].pixels
    normal = np.stack([channels[f"normal.{axis}"].pixels for axis in "XYZ"], axis=-1)
    hit = thing == 0
    assert hit.any()
    assert (thing[~hit] == -1).all()
    assert np.isinf(depth[~hit]).all()
    assert np.linalg.norm(normal[hit], axis=-1) == pytest.approx(1.0, abs=8 * 2.0**-24)  # stored in float32
    assert (depth[hit] >= 3.0 - 0.9 - 0.2).all()  # the sphere's nearest point is |c - o| - r = 3.04 - 0.9 away


def test_goldens_that_stand_are_kept_and_others_made_again(folder: Path) -> None:
    kept = (folder / "two-lights.exr").stat().st_mtime_ns
    (folder / "glass-sphere.npz").write_bytes(b"")
    told: list[str] = []
    make(folder, scenes(), MADE_BY, "numpy", 1, lambda name, *_: told.append(name))
    assert told == ["glass-sphere"]
    assert (folder / "two-lights.exr").stat().st_mtime_ns == kept
    assert verify(folder, today, "numpy", silent) == {}


def test_two_jobs_make_the_same_bytes_as_one(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    other = tmp_path_factory.mktemp("jobs")
    make(other, scenes(), MADE_BY, "numpy", 2, silent)
    assert read_manifest(other).goldens == read_manifest(folder).goldens


def edit_pixel(folder: Path) -> None:
    """Change a value and the hash with it, as someone would who wants to be believed."""
    path = folder / "two-lights.npz"
    with np.load(path) as stored:
        arrays = dict(stored)
    arrays["value"][5, 7, 1] += 1e-6
    np.savez_compressed(path, **arrays)
    forge(folder, "two-lights", "npz")


def edit_scene(folder: Path) -> None:
    path = folder / "two-lights.json"
    path.write_text(path.read_text().replace('"depth": 0', '"depth": 1'))
    forge(folder, "two-lights", "json")


def forge(folder: Path, name: str, ending: str) -> None:
    import hashlib

    manifest = json.loads((folder / "manifest.json").read_text())
    data = (folder / f"{name}.{ending}").read_bytes()
    manifest["goldens"][name]["files"][ending] = hashlib.sha256(data).hexdigest()
    (folder / "manifest.json").write_text(json.dumps(manifest))


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda folder: (folder / "two-lights.exr").write_bytes(b"x"), "two-lights.exr: not as it was written"),
        (lambda folder: os.truncate(folder / "two-lights.exr", 1000), "two-lights.exr: not as it was written"),
        (lambda folder: (folder / "two-lights.png").unlink(), "two-lights.png: missing"),
        (edit_pixel, "pixel (7, 5) G is not what is computed now"),
        (edit_scene, "its scene is not the one it was made of"),
    ],
    ids=["edited", "truncated", "missing", "pixel-edited-and-hash-forged", "scene-edited-and-hash-forged"],
)
def test_a_golden_that_does_not_stand_is_named(folder: Path, spoil: Callable[[Path], object], words: str) -> None:
    spoil(folder)
    problems = verify(folder, today, "numpy", silent)
    assert list(problems) == ["two-lights"]
    assert words in problems["two-lights"]


def test_a_golden_of_a_scene_that_has_changed_is_stale(folder: Path) -> None:
    changed = rung("two-lights").scene().with_depth(2)
    problems = verify(folder, lambda name: changed if name == "two-lights" else today(name), "numpy", silent)
    assert problems == {"two-lights": "stale: the catalogue's scene has changed since"}


@pytest.mark.parametrize("text", ["", "{}", '{"format": 2, "suite": "x"}', "not json"])
def test_a_manifest_of_another_kind_is_refused(folder: Path, text: str) -> None:
    (folder / "manifest.json").write_text(text)
    with pytest.raises(GoldenError, match="goldens of format 1"):
        verify(folder, today, "numpy", silent)


def test_a_folder_without_manifest_is_refused(tmp_path: Path) -> None:
    with pytest.raises(GoldenError, match="written by `raycheck golden make`"):
        load(tmp_path / "x.exr")


@pytest.mark.parametrize("begun", [0, 1, 9, 30])
def test_killed_at_any_moment_nothing_half_written_counts(tmp_path: Path, begun: int) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()", "golden", "make", str(tmp_path)]
    child = subprocess.Popen([*command, "--size", "40x30"], env=environment, stdout=subprocess.DEVNULL)
    while child.poll() is None and sum(1 for _ in tmp_path.iterdir()) < begun:
        time.sleep(0.001)
    assert child.poll() is None, "all goldens were made before the kill"
    child.send_signal(signal.SIGKILL)
    child.wait()
    if (tmp_path / "manifest.json").exists():
        assert verify(tmp_path, today, "numpy", silent) == {}
    done = subprocess.run([*command, "--size", "40x30"], env=environment, stdout=subprocess.DEVNULL, check=False)
    assert done.returncode == 0
    assert len(read_manifest(tmp_path).goldens) == len(ladder())


def raycheck_(*words: object) -> int:
    return raycheck.cli.main([str(word) for word in words])


def test_compare_accepts_a_float32_picture_and_names_a_wrong_pixel(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "glass.npy"
    assert raycheck_("render", folder / "glass-sphere.json", picture, "--precision", 32, "--arithmetic", "numpy") == 0
    assert raycheck_("compare", picture, folder / "glass-sphere.exr") == 0
    values = np.load(picture)
    values[1, 2, 0] += 1e-4
    np.save(picture, values)
    capsys.readouterr()
    assert raycheck_("compare", picture, folder / "glass-sphere.exr") == 1
    assert "worst: pixel (2, 1) red: expected 0.3" in capsys.readouterr().out


def test_compare_as_displayed_forgives_what_no_display_shows(folder: Path, tmp_path: Path) -> None:
    picture = tmp_path / "lights.npy"
    raycheck_("render", folder / "two-lights.json", picture, "--arithmetic", "numpy")
    np.save(picture, np.load(picture) * (1 + 1e-5))
    assert raycheck_("compare", picture, folder / "two-lights.exr", "--precision", 64) == 1
    # Values far from the next code stay in theirs
    values = np.load(picture)
    np.save(picture, (np.floor(values * 255) + 0.5) / 255 * (values > 0))
    assert raycheck_("compare", picture, folder / "two-lights.exr", "--precision", "8bit") == 0


def test_compare_of_another_size_is_invalid(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "x.npy"
    np.save(picture, np.zeros((3, 3, 3)))
    assert raycheck_("compare", picture, folder / "two-lights.exr") == 1
    assert "invalid" in capsys.readouterr().out


def test_compare_without_golden_is_misuse(tmp_path: Path) -> None:
    assert raycheck_("compare", tmp_path / "x.npy", tmp_path / "y.exr") == 2


def test_verify_tells_and_exits_1(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "two-lights.png").unlink()
    assert raycheck_("golden", "verify", folder) == 1
    assert "two-lights: two-lights.png: missing\n1 golden does not stand" in capsys.readouterr().out


def test_goldens_of_a_dialect_hold_its_exact_values_and_replace_others(folder: Path) -> None:
    dialect = Dialect(lambert="1/pi")
    make(folder, scenes(), MADE_BY.model_copy(update={"dialect": dialect.other()}), "numpy", 1, silent)
    golden = load(folder / "two-lights.exr")
    truth = certified.render_exact(golden.scene, rules(dialect))
    assert golden.dialect == dialect
    assert (np.abs(golden.value - truth.value) <= golden.bound + truth.bound).all()
    assert verify(folder, today, "numpy", silent) == {}


def test_a_golden_knows_how_close_its_decisions_were(folder: Path) -> None:
    with np.load(folder / "glass-sphere.npz") as stored:
        margin = stored["margin"]
    channels = OpenEXR.File(str(folder / "glass-sphere.exr"), separate_channels=True).channels()
    assert (margin > 0.0).all()
    np.testing.assert_array_equal(channels["margin.V"].pixels, margin.astype(np.float32))
