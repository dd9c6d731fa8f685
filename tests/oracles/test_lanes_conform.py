"""A correct tracer of a precision passes at that precision: no false alarm on the catalogue or on random scenes."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray

from oracles.compare import compare
from oracles.images import Picture, read, write
from oracles.truth import Truth, truth
from reference_tracer.formulas.display import encode
from reference_tracer.lanes.render import backend, render
from scenes.catalogue import ladder, rung
from scenes.random_scenes import random_scene

NAMES = [entry.name for entry in ladder()]
SIZE = (80, 60)
SEEDS = range(60)


@cache
def pixels_in_float32(name: str) -> NDArray[Any]:
    return render(rung(name).scene().resized(*SIZE), backend("numpy", 32)).pixels


@cache
def truth_of(name: str, precision: str) -> Truth:
    return truth(rung(name).scene().resized(*SIZE), precision)


def told(picture: Picture, against: Truth) -> str:
    outcome = compare(picture, against)
    return outcome.word if outcome.word == "pass" else f"{outcome.word}: {outcome.message}"


@pytest.mark.parametrize("name", NAMES)
def test_float32_lanes_pass_a_catalogue_scene(name: str) -> None:
    pixels = pixels_in_float32(name)
    assert pixels.dtype == np.float32
    assert told(Picture(pixels.astype(np.float64), roundoff=2.0**-24), truth_of(name, "float32")) == "pass"


@pytest.mark.parametrize("name", NAMES)
def test_float32_lanes_pass_a_catalogue_scene_written_as_half(tmp_path: Path, name: str) -> None:
    path = tmp_path / "half.exr"
    half = np.ascontiguousarray(pixels_in_float32(name).astype(np.float16))
    OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": half}).write(str(path))
    assert told(read(path, *SIZE), truth_of(name, "float32")) == "pass"


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("maximum", [255, 65535])
def test_float32_lanes_pass_a_catalogue_scene_in_codes(name: str, maximum: int) -> None:
    against = truth_of(name, "float32")
    codes = encode(pixels_in_float32(name), against.scene.display, maximum)
    assert told(Picture(codes.astype(np.float64), maximum), against) == "pass"


@pytest.mark.parametrize("name", NAMES)
def test_float64_lanes_pass_a_catalogue_scene_at_float64(name: str) -> None:
    against = truth_of(name, "float64")
    pixels = render(against.scene, backend("numpy", 64)).pixels
    assert told(Picture(pixels), against) == "pass"


@pytest.mark.parametrize("name", NAMES)
def test_float64_lanes_pass_a_catalogue_scene_at_float32(name: str) -> None:
    against = truth_of(name, "float32")
    pixels = render(against.scene, backend("numpy", 64)).pixels
    assert told(Picture(pixels), against) == "pass"


@pytest.mark.parametrize("name", ["phong-100", "glass-sphere", "lecture-final"])
def test_float32_lanes_fail_at_float64(name: str) -> None:
    pixels = pixels_in_float32(name).astype(np.float64)
    assert told(Picture(pixels, roundoff=2.0**-24), truth_of(name, "float64")).startswith("fail")


@pytest.mark.parametrize("ending", ["pfm", "exr", "npy", "ppm", "png"])
def test_what_float32_lanes_write_to_a_file_passes(tmp_path: Path, ending: str) -> None:
    against = truth_of("lecture-final", "float32")
    path = tmp_path / f"a.{ending}"
    write(path, pixels_in_float32("lecture-final"), against.scene.display)
    assert told(read(path, *SIZE), against) == "pass"


def test_the_random_scenes_show_every_feature() -> None:
    shown = set().union(*(random_scene(seed).features for seed in SEEDS))
    assert shown == {"plane", "shadow", "reflect", "refract", "fresnel"}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("precision", "bits"), [("float32", 32), ("float64", 64), ("float32", 64)])
def test_lanes_are_never_failed_on_a_random_scene(seed: int, precision: str, bits: int) -> None:
    scene = random_scene(seed)
    pixels = render(scene, backend("numpy", bits)).pixels.astype(np.float64)
    picture = Picture(pixels, roundoff=2.0**-24 if bits == 32 else 0.0)
    assert told(picture, truth(scene, precision)).split(":")[0] in ("pass", "undecided")


def test_most_random_scenes_are_decided_in_most_pixels() -> None:
    shares = [np.mean(truth(random_scene(seed), "float32").doubts == 0) for seed in SEEDS]
    assert np.median(shares) > 0.5
