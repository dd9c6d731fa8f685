"""Laws of pictures: our own tracer obeys them whatever it writes, and each sees a fault of its kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from oracles.images import Picture
from oracles.laws.dice import repeated, seeded
from oracles.laws.pictures import PictureLaw, Sight, picture_laws, sight
from oracles.truth import Truth, truth
from raycheck.lanes import best_lanes
from raycheck.manifest import FEATURES
from reference_tracer import plain
from reference_tracer.lanes import render as lanes
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

LAWS = picture_laws()


def name_of(law: PictureLaw) -> str:
    return law.name


@cache
def true_of(text: str, precision: str) -> Truth:
    return truth(Scene.model_validate_json(text), precision, best_lanes())


def pixels_by(bits: int, rules: Rulebook = LECTURE) -> Callable[[Scene], Any]:
    return lambda scene: lanes.render(scene, lanes.backend("numpy", bits), rules).pixels.astype(np.float64)


@dataclass
class Hung:
    """A studio of one renderer and one format."""

    pixels: Callable[[Scene], Any]
    precision: str = "float64"
    maximum: int | None = None
    features: frozenset[str] = frozenset(FEATURES)

    def show(self, scene: Scene) -> Sight:
        values = self.pixels(scene)
        if self.maximum is not None:
            values = np.floor(np.clip(values, 0.0, 1.0) * self.maximum)
        picture = Picture(values, self.maximum, 2.0**-24 if self.precision == "float32" else 0.0)
        return sight(picture, true_of(scene.model_dump_json(), self.precision))


def worst(law: PictureLaw, studio: Hung, seed: int | None = None) -> float:
    dice = repeated(np.zeros((1, 0)), studio.precision) if seed is None else seeded(1, studio.precision, seed)
    return float(law.test(dice, studio).excess().max())


@pytest.mark.parametrize("bits", [32, 64])
@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_our_tracer_obeys_the_law(law: PictureLaw, bits: int) -> None:
    studio = Hung(pixels_by(bits), f"float{bits}")
    assert worst(law, studio) <= 1.0
    assert worst(law, studio, 3) <= 1.0


@pytest.mark.parametrize("maximum", [255])
@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_a_picture_of_codes_obeys_the_law_as_what_it_encodes(law: PictureLaw, maximum: int) -> None:
    assert worst(law, Hung(pixels_by(32), "float32", maximum)) <= 1.0


@pytest.mark.parametrize(
    "features", [set(), {"plane"}, {"plane", "shadow"}, {"reflect"}, {"plane", "shadow", "reflect"}]
)
def test_a_tracer_is_asked_for_what_it_offers_and_no_more(features: set[str]) -> None:
    asked: set[str] = set()

    def pixels(scene: Scene) -> Any:
        asked.update(scene.features)
        return pixels_by(32)(scene)

    studio = Hung(pixels, "float32", features=frozenset(features))
    for law in LAWS:
        if set(law.needs) <= features:
            assert worst(law, studio) <= 1.0
    assert asked <= features


@pytest.mark.parametrize("name", ["image/object-order", "image/lights-add", "image/crop"])
def test_the_plain_tracer_obeys_the_law(name: str) -> None:
    law = next(law for law in LAWS if law.name == name)
    assert worst(law, Hung(lambda scene: plain.render(scene).pixels)) <= 1.0


def ordered_fault(scene: Scene) -> Any:
    """The last object hit is drawn."""
    place = np.array([*scene.tie_order, -1])
    rules = replace(LECTURE, nearer=lambda distance, best, order, best_order: place[order] > place[best_order])
    return pixels_by(64, rules)(scene)


def ambient_per_lamp(scene: Scene) -> Any:
    base = pixels_by(64)(scene)
    extra = pixels_by(64)(scene.model_copy(update={"lights": ()})) - scene.background
    return base + (len(scene.lights) - 1) * np.maximum(extra, 0.0)


def swapped(scene: Scene) -> Any:
    """Red is looked at twice."""
    return pixels_by(64)(scene)[:, :, [0, 0, 2]]


def changed_scene(**parts: Callable[[Scene], Any]) -> Callable[[Scene], Any]:
    return lambda scene: pixels_by(64)(scene.model_copy(update={k: f(scene) for k, f in parts.items()}))


FAULTS: list[tuple[Callable[[Scene], Any], set[str]]] = [
    (ordered_fault, {"image/object-order", "image/hidden-object"}),
    (ambient_per_lamp, {"image/split-lamp"}),
    (swapped, {"image/channels"}),
    (lambda scene: np.minimum(pixels_by(64)(scene), 0.4), {"image/lights-add", "image/light-scales"}),
    (
        lambda scene: pixels_by(64)(scene) ** (1 / 2.2),
        {"image/lights-add", "image/ambient-adds", "image/background-adds"},
    ),
    (lambda scene: pixels_by(64)(scene) + 1e-4, {"image/black"}),
    (lambda scene: 3.0 * pixels_by(64)(scene), {"image/energy"}),
    (changed_scene(depth=lambda s: s.depth + (s.depth == 0)), {"image/depth-zero"}),
    (changed_scene(background=lambda s: (0.25, 0.25, 0.25)), {"image/black"}),
    (changed_scene(image=lambda s: s.image.model_copy(update={"sample": (0.0, 0.0)})), {"image/mirrored-camera"}),
    (changed_scene(lights=lambda s: s.lights[:1]), {"image/light-order"}),
    (lambda scene: np.roll(pixels_by(64)(scene), 1, axis=0), {"image/upside-down-camera", "image/crop"}),
    (
        lambda scene: pixels_by(
            64, replace(LECTURE, attenuation=lambda d, one, two: 1.0 / (1.0 + d * one + d * d * two))
        )(scene),
        {"image/inverse", "image/inverse-square"},
    ),
    (
        lambda scene: pixels_by(
            64, replace(LECTURE, refract=lambda v, n, leaving, index: LECTURE.refract(v, n, leaving, index * 1.1))
        )(scene),
        {"image/invisible-ball"},
    ),
    (
        lambda scene: pixels_by(64, replace(LECTURE, plane_normal=lambda n: n))(scene),
        {"image/plane-normal"},
    ),
    (
        lambda scene: pixels_by(64, replace(LECTURE, light_vector=lambda k, p, point: (k, 1.0 + 0.0 * k.x)))(scene),
        {"image/lamp-direction-length", "image/translate"},
    ),
    (
        lambda scene: pixels_by(
            64, replace(LECTURE, mix=lambda local, r, reflected, t, transmitted: local + reflected + transmitted)
        )(scene),
        {"image/reflect-adds"},
    ),
    (
        lambda scene: pixels_by(64, replace(LECTURE, camera_ray=lambda f, r, u, X, Y: (f + r * X) + u * Y))(scene),
        {"image/view-length"},
    ),
]


@pytest.mark.parametrize(
    ("pixels", "expected"), FAULTS, ids=lambda value: "+".join(sorted(value)) if isinstance(value, set) else ""
)
def test_a_fault_breaks_the_laws_that_speak_of_it(pixels: Callable[[Scene], Any], expected: set[str]) -> None:
    studio = Hung(pixels)
    with np.errstate(all="ignore"):
        caught = {law.name for law in LAWS if law.name in expected and worst(law, studio) > 1.0}
    assert caught == expected


def test_sums_and_scales_of_sights_keep_their_intervals() -> None:
    one = Sight(*(np.full((1, 1, 3), x) for x in (1.0, 2.0, 0.25, 1.5)))
    both = one - one * 0.5
    assert (both.low[0, 0, 0], both.high[0, 0, 0]) == (0.0, 1.5)
    assert both.tolerance[0, 0, 0] == 0.375
    assert both.excess().max() == 0.0


def test_the_first_and_the_last_code_stand_for_what_was_clamped(picture_codes: Sight) -> None:
    assert picture_codes.low[0, 0, 0] == -np.inf
    assert picture_codes.high[0, 0, 2] == np.inf
    assert picture_codes.low[0, 0, 1] == 100 / 255


@pytest.fixture
def picture_codes() -> Sight:
    scene = next(iter([Scene.model_validate(Scene.model_validate_json(SCENE))]))
    values = np.array([[[0.0, 100.0, 255.0]]])
    return sight(Picture(values, 255), truth(scene, "float32"))


SCENE = """{"raycheck": 1, "name": "one", "source": "", "image": {"width": 1, "height": 1, "sample": [0, 0]},
"camera": {"eye": [0, 0, 0], "forward": [0, 0, 1], "right": [1, 0, 0], "up": [0, 1, 0]}, "background": [0, 0.4, 2],
"depth": 0, "shadows": false, "display": "lecture", "materials": {}, "objects": [], "lights": []}"""
