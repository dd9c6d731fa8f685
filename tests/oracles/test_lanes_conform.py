"""A correct tracer of a precision passes at that precision: no false alarm on the catalogue or on random scenes."""

from __future__ import annotations

import random
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
from scenes.json_form import from_data
from scenes.model import Scene

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


def random_scene(seed: int) -> Scene:
    """Up to six objects and three lights in view of the lecture's camera, every feature at some odds."""
    chance = random.Random(seed)  # noqa: S311 - scenes, not secrets

    def triple(low: float, high: float) -> list[float]:
        return [chance.uniform(low, high) for _ in range(3)]

    def sometimes(odds: float) -> list[float]:
        return triple(0.1, 0.9) if chance.random() < odds else [0.0, 0.0, 0.0]

    def direction() -> list[float]:
        vector = triple(-1.0, 1.0)
        return vector if np.linalg.norm(vector) > 0.1 else [0.0, 1.0, 0.0]

    materials = {
        f"m{k}": {
            "ambient": triple(0.0, 0.2),
            "diffuse": sometimes(0.8),
            "specular": sometimes(0.5),
            "shininess": chance.choice((1, 2, 10, 37, 100)),
            "reflect": sometimes(0.4),
            "transmit": sometimes(0.4),
            "index": chance.choice((1.0, 1.33, 1.5, 1 / 1.5, 2.4)),
        }
        for k in range(3)
    }
    spheres = [
        {
            "shape": "sphere",
            "center": [chance.uniform(-2, 2), chance.uniform(-1.5, 1.5), chance.uniform(-1, 5)],
            "radius": chance.uniform(0.2, 1.2),
            "material": f"m{chance.randrange(3)}",
        }
        for _ in range(chance.randrange(1, 5))
    ]
    planes = [
        {
            "shape": "plane",
            "normal": direction(),
            "offset": chance.uniform(-2, 2),
            "material": f"m{chance.randrange(3)}",
        }
        for _ in range(chance.randrange(0, 3))
    ]
    lights = [
        {
            "kind": "point",
            "position": [chance.uniform(-3, 3), chance.uniform(0, 4), chance.uniform(-3, 3)],
            "color": triple(0.2, 1.0),
            "attenuation": chance.choice(("none", "inverse", "inverse_square")),
        }
        if chance.random() < 0.6
        else {"kind": "directional", "toward": direction(), "color": triple(0.2, 1.0)}
        for _ in range(chance.randrange(1, 4))
    ]
    things = [*spheres, *planes]
    chance.shuffle(things)
    return from_data(
        {
            "raycheck": 1,
            "name": f"random-{seed}",
            "source": "",
            "image": {"width": 40, "height": 30, "sample": [chance.random(), chance.random()]},
            "camera": {
                "eye": [0.0, 0.0, -2.0],
                "forward": [0.0, 0.0, 1.5],
                "right": [4 / 3, 0.0, 0.0],
                "up": [0.0, 1.0, 0.0],
            },
            "background": triple(0.0, 0.5),
            "depth": chance.randrange(0, 5),
            "shadows": chance.random() < 0.6,
            "fresnel": chance.random() < 0.3,
            "display": "lecture",
            "materials": materials,
            "objects": things,
            "lights": lights,
        }
    )


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
