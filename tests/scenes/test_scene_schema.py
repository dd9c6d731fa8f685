"""The published JSON Schema says what the model says."""

from __future__ import annotations

import copy
import json
from importlib import resources
from typing import Any

import jsonschema
import pytest

from scenes.catalogue import ladder
from scenes.json_form import schema

NAMES = [rung.name for rung in ladder()]


def published() -> dict[str, Any]:
    found: dict[str, Any] = json.loads(resources.files("scenes.schema").joinpath("scene-1.json").read_text("utf-8"))
    return found


def file_of(name: str) -> dict[str, Any]:
    found: dict[str, Any] = json.loads(resources.files("scenes.catalogue").joinpath(f"{name}.json").read_text("utf-8"))
    return found


def accepts(data: Any) -> bool:
    return bool(jsonschema.Draft202012Validator(published()).is_valid(data))


def test_the_committed_schema_is_the_generated_one() -> None:
    assert resources.files("scenes.schema").joinpath("scene-1.json").read_text("utf-8") == schema()


def test_the_schema_is_a_schema() -> None:
    jsonschema.Draft202012Validator.check_schema(published())


@pytest.mark.parametrize("name", NAMES)
def test_the_schema_accepts_a_catalogue_scene(name: str) -> None:
    jsonschema.Draft202012Validator(published()).validate(file_of(name))


def test_the_schema_accepts_fresnel() -> None:
    assert accepts({**file_of("glass-sphere"), "fresnel": True})


MUTATIONS: list[tuple[tuple[str | int, ...], Any]] = [
    (("unknown",), 1),
    (("raycheck",), 2),
    (("raycheck",), True),
    (("name",), "a b"),
    (("source",), 1),
    (("image", "width"), 0),
    (("image", "width"), 16385),
    (("image", "width"), 1.5),
    (("image", "sample"), [0.5]),
    (("image", "sample", 0), 2),
    (("camera", "eye"), [0, 0, 0, 0]),
    (("camera", "up", 1), "1"),
    (("background", 0), -1),
    (("depth",), 17),
    (("depth",), -1),
    (("shadows",), 1),
    (("display",), "gamma"),
    (("materials",), []),
    (("materials", "red", "unknown"), 1),
    (("materials", "floor", "index"), 0),
    (("materials", "floor", "shininess"), 0),
    (("materials", "floor", "ambient", 0), -0.1),
    (("objects", 0, "shape"), "cube"),
    (("objects", 0, "unknown"), 1),
    (("objects", 1, "radius"), 0),
    (("objects", 1, "radius"), None),
    (("lights", 0, "kind"), "spot"),
    (("lights", 0, "attenuation"), "linear"),
    (("lights", 0, "color"), [1, 1]),
]


@pytest.mark.parametrize(("path", "value"), MUTATIONS, ids=[f"{'.'.join(map(str, p))}={v}" for p, v in MUTATIONS])
def test_the_schema_rejects_a_wrong_value(path: tuple[str | int, ...], value: Any) -> None:
    data: Any = file_of("lecture-final")
    inner = data
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = value
    assert not accepts(data)


@pytest.mark.parametrize("name", ["a b", "", "é"])
def test_the_schema_rejects_a_material_name_that_the_model_rejects(name: str) -> None:
    data: Any = file_of("lecture-final")
    data["materials"][name] = {}
    assert not accepts(data)


@pytest.mark.parametrize("key", sorted(file_of("lecture-final")))
def test_the_schema_rejects_a_scene_without_one_of_its_keys(key: str) -> None:
    data = copy.deepcopy(file_of("lecture-final"))
    del data[key]
    assert not accepts(data)
