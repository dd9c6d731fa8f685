"""What a scene tells about itself."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from scenes.catalogue import rung
from scenes.json_form import from_data
from scenes.model import Scene


def plane_points(scene: Scene) -> np.ndarray:
    """forward + X·right + Y·up at the four corners of the image, by the contract's formula."""
    camera, corners = scene.camera, [(-1.0, 1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
    forward, right, up = (np.array(v) for v in (camera.forward, camera.right, camera.up))
    return np.array([forward + X * right + Y * up for X, Y in corners])


@pytest.mark.parametrize(("width", "height"), [(80, 60), (320, 240), (4, 3), (16000, 12000)])
def test_a_picture_of_the_same_aspect_has_the_same_corner_rays(width: int, height: int) -> None:
    scene = rung("off-centre-camera").scene().resized(160, 120)
    np.testing.assert_array_equal(plane_points(scene.resized(width, height)), plane_points(scene))


@given(st.integers(1, 16384), st.integers(1, 16384))
def test_a_resized_picture_keeps_the_shape_of_its_pixels_and_its_height(width: int, height: int) -> None:
    scene = rung("off-centre-camera").scene()
    new = scene.resized(width, height)
    assert (new.image.width, new.image.height) == (width, height)
    assert new.camera.up == scene.camera.up
    # A pixel is 2|right|/width by 2|up|/height; four roundings of u = 2^-53 in `resized`, four here
    before = np.array(scene.camera.right) / scene.image.width * scene.image.height
    after = np.array(new.camera.right) / width * height
    np.testing.assert_allclose(after, before, rtol=8 * 2.0**-53, atol=0.0)


def test_a_resized_picture_changes_nothing_but_size_and_right() -> None:
    scene = rung("lecture-final").scene()
    new = scene.resized(200, 100)
    changed = {"image": scene.image, "camera": new.camera.model_copy(update={"right": scene.camera.right})}
    assert new.model_copy(update=changed) == scene


def test_with_depth_changes_the_depth_only() -> None:
    scene = rung("lecture-final").scene()
    assert scene.with_depth(7).depth == 7
    assert scene.with_depth(7).with_depth(scene.depth) == scene


@pytest.mark.parametrize(
    ("name", "features"),
    [
        ("background", set()),
        ("headlight-sphere", set()),
        ("headlight-plane", {"plane"}),
        ("shadow-hard", {"plane", "shadow"}),
        ("mirror-imperfect", {"reflect"}),
        ("facing-mirrors-2", {"plane", "reflect"}),
        ("glass-sphere", {"refract"}),
        ("reflect-and-refract", {"reflect", "refract"}),
        ("lecture-final", {"plane", "shadow", "reflect", "refract"}),
    ],
)
def test_the_features_are_what_the_scene_shows(name: str, features: set[str]) -> None:
    assert rung(name).scene().features == features


def test_a_scene_of_depth_0_needs_neither_reflection_nor_refraction() -> None:
    assert rung("reflect-and-refract").scene().with_depth(0).features == set()


def test_shadows_without_a_light_are_no_feature() -> None:
    scene = rung("shadow-hard").scene().model_copy(update={"lights": ()})
    assert scene.features == {"plane"}


def test_a_material_that_no_object_has_is_no_feature() -> None:
    scene = rung("reflect-and-refract").scene()
    others = tuple(thing for thing in scene.objects if thing.material != "gem")
    assert scene.model_copy(update={"objects": others}).features == set()


def test_fresnel_is_a_feature() -> None:
    scene = rung("glass-sphere").scene().model_copy(update={"fresnel": True})
    assert scene.features == {"refract", "fresnel"}


def leaves(data: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    if isinstance(data, dict):
        return [leaf for key, part in data.items() for leaf in leaves(part, (*path, key))]
    if isinstance(data, list):
        return [leaf for k, part in enumerate(data) for leaf in leaves(part, (*path, k))]
    return [path]


FULL = {**json.loads(rung("lecture-final").scene().model_dump_json()), "fresnel": False}
FULL["materials"]["extra"] = FULL["materials"]["red"]
OTHERS: dict[str, Any] = {"display": "srgb", "name": "other", "source": "other", "attenuation": "inverse"}
SKIPPED = ("raycheck", "shape", "kind")
FIELDS = [path for path in leaves(FULL) if path[-1] not in SKIPPED]


def other(path: tuple[str | int, ...], value: Any) -> Any:
    if path[-1] == "material":
        return "extra"
    if isinstance(value, bool):
        return not value
    if isinstance(value, str):
        return OTHERS[str(path[-1])]
    if isinstance(value, int):
        return value + 1
    return 0.5 if path[:2] == ("image", "sample") else float(np.nextafter(value, 1e9))


@pytest.mark.parametrize("path", FIELDS, ids=[".".join(map(str, path)) for path in FIELDS])
def test_the_hash_changes_with_every_field_even_by_one_ulp(path: tuple[str | int, ...]) -> None:
    data = json.loads(json.dumps(FULL))
    inner = data
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = other(path, inner[path[-1]])
    assert from_data(data).content_hash() != from_data(FULL).content_hash()


def test_the_hash_changes_with_the_order_of_the_objects() -> None:
    scene = rung("lecture-final").scene()
    assert scene.model_copy(update={"objects": scene.objects[::-1]}).content_hash() != scene.content_hash()


def test_the_hash_is_that_of_an_equal_scene() -> None:
    assert from_data(json.loads(json.dumps(FULL))).content_hash() == from_data(FULL).content_hash()


def test_a_scene_cannot_be_changed_in_place() -> None:
    scene = rung("background").scene()
    with pytest.raises(ValidationError, match="frozen"):
        scene.depth = 3  # type: ignore[misc]
