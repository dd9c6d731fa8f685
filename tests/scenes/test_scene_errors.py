"""A wrong scene is refused with file, place, value and expectation."""

from __future__ import annotations

import copy
import json
import os
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenes.errors import SceneError
from scenes.files import MAX_BYTES, load
from scenes.json_form import from_json
from scenes.model import MAX_LIGHTS, MAX_OBJECTS
from scenes.text import from_text

GOOD: dict[str, Any] = {
    "raycheck": 1,
    "name": "two-spheres",
    "source": "L11",
    "image": {"width": 160, "height": 120, "sample": [0.0, 0.0]},
    "camera": {"eye": [0, 0, -2], "forward": [0, 0, 1], "right": [1.5, 0, 0], "up": [0, 1, 0]},
    "background": [0, 0, 0],
    "depth": 3,
    "shadows": True,
    "display": "lecture",
    "materials": {
        "red": {
            "ambient": [0.1, 0, 0],
            "diffuse": [0.8, 0.1, 0.1],
            "specular": [0.5, 0.5, 0.5],
            "shininess": 100,
            "reflect": [0, 0, 0],
            "transmit": [0, 0, 0],
            "index": 1.0,
        }
    },
    "objects": [
        {"shape": "sphere", "center": [0, 0, 1], "radius": 1.0, "material": "red"},
        {"shape": "plane", "normal": [0, 1, 0], "offset": -1.0, "material": "red"},
    ],
    "lights": [
        {"kind": "point", "position": [2, 3, -2], "color": [1, 1, 1], "attenuation": "none"},
        {"kind": "directional", "toward": [0, 1, -1], "color": [0.3, 0.3, 0.3]},
    ],
}
TEXT = """\
raycheck 1 two-spheres
image 160 120 0 0
eye 0 0 -2
forward 0 0 1
right 1.5 0 0
up 0 1 0
background 0 0 0
depth 3
shadows 1
fresnel 0
display lecture
material red 0.1 0 0 0.8 0.1 0.1 0.5 0.5 0.5 100 0 0 0 0 0 0 1
sphere 0 0 1 1 red
plane 0 1 0 -1 red
point 2 3 -2 1 1 1 none
directional 0 1 -1 0.3 0.3 0.3
end
"""

Step = str | int


def changed(path: tuple[Step, ...], value: Any) -> dict[str, Any]:
    data = copy.deepcopy(GOOD)
    inner: Any = data
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = value
    return data


def refusal_of_json(text: str) -> SceneError:
    with pytest.raises(SceneError) as caught:
        from_json(text, "wrong.json")
    return caught.value


def refusal_of_text(text: str) -> SceneError:
    with pytest.raises(SceneError) as caught:
        from_text(text, "wrong.txt")
    return caught.value


def test_the_scenes_that_are_spoilt_here_are_good() -> None:
    assert from_json(json.dumps(GOOD)).depth == 3
    assert from_text(TEXT).depth == 3


WRONG = [
    # path in the file, value, the value as shown, what was expected
    (("colour",), 1, "1", "only the keys of the scene format"),
    (("image", "depth"), 8, "8", "only the keys of the scene format"),
    (("camera", "fov"), 60, "60", "only the keys of the scene format"),
    (("materials", "red", "emission"), [0, 0, 0], "[0, 0, 0]", "only the keys of the scene format"),
    (("objects", 0, "colour"), "red", "'red'", "only the keys of the scene format"),
    (("lights", 1, "radius"), 1, "1", "only the keys of the scene format"),
    (("raycheck",), 2, "2", "1"),
    (("raycheck",), True, "True", "the integer 1"),
    (("raycheck",), "1", "'1'", "the integer 1"),
    (("name",), "two spheres", "'two spheres'", "pattern"),
    (("name",), "", "''", "pattern"),
    (("name",), "../up", "'../up'", "pattern"),
    (("name",), "ä", "'ä'", "pattern"),
    (("name",), "red\n", "'red\\n'", "pattern"),
    (("name",), "x" * 65, "'xxx", "at most 64 characters"),
    (("source",), "one\ntwo", "'one\\ntwo'", "pattern"),
    (("source",), 7, "7", "valid string"),
    (("image", "width"), 16385, "16385", "less than or equal to 16384"),
    (("image", "height"), 16385, "16385", "less than or equal to 16384"),
    (("image", "width"), 0, "0", "greater than or equal to 1"),
    (("image", "height"), -1, "-1", "greater than or equal to 1"),
    (("image", "width"), 160.0, "160.0", "valid integer"),
    (("image", "width"), "160", "'160'", "valid integer"),
    (("image", "width"), True, "True", "valid integer"),
    (("image", "sample", 0), 1.5, "1.5", "less than or equal to 1"),
    (("camera", "eye"), [0, 0], "camera.eye.2: missing", ""),
    (("camera", "eye", 2), "far", "'far'", "valid number"),
    (("camera", "forward"), [0, 0, 0], "[0, 0, 0]", "other than (0, 0, 0)"),
    (("camera", "right"), [0, -0.0, 0], "[0, -0.0, 0]", "other than (0, 0, 0)"),
    (("camera", "up"), [0, 0, 0], "[0, 0, 0]", "other than (0, 0, 0)"),
    (("camera", "up", 1), float("nan"), "nan", "finite number"),
    (("background", 1), -0.1, "-0.1", "greater than or equal to 0"),
    (("background", 1), float("inf"), "inf", "finite number"),
    (("background",), None, "None", ""),
    (("depth",), 17, "17", "less than or equal to 16"),
    (("depth",), -1, "-1", "greater than or equal to 0"),
    (("depth",), 1.5, "1.5", "valid integer"),
    (("shadows",), 1, "1", "valid boolean"),
    (("shadows",), "true", "'true'", "valid boolean"),
    (("fresnel",), None, "None", "valid boolean"),
    (("display",), "gamma", "'gamma'", "'lecture' or 'srgb'"),
    (("materials", "red", "index"), 0, "0", "greater than 0"),
    (("materials", "red", "index"), -1.5, "-1.5", "greater than 0"),
    (("materials", "red", "shininess"), 0, "0", "greater than or equal to 1"),
    (("materials", "red", "shininess"), 2.5, "2.5", "valid integer"),
    (("materials", "red", "diffuse", 2), -1, "-1", "greater than or equal to 0"),
    (("materials", "red", "transmit", 0), float("-inf"), "-inf", "finite number"),
    (("objects", 0, "radius"), 0, "0", "greater than 0"),
    (("objects", 0, "radius"), -1.0, "-1.0", "greater than 0"),
    (("objects", 0, "radius"), float("nan"), "nan", "finite number"),
    (("objects", 0, "radius"), 10**400, "1000", "finite number"),
    (("objects", 0, "center"), {"x": 0}, "{'x': 0}", ""),
    (("objects", 0, "shape"), "cube", "'cube'", "'sphere', 'plane'"),
    (("objects", 0, "material"), "blue", "'blue'", "a defined material (red)"),
    (("objects", 1, "normal"), [0, 0, 0], "[0, 0, 0]", "other than (0, 0, 0)"),
    (("objects", 1, "offset"), float("inf"), "inf", "finite number"),
    (("objects",), {}, "{}", ""),
    (("lights", 0, "attenuation"), "linear", "'linear'", "'inverse'"),
    (("lights", 0, "kind"), "spot", "'spot'", "'point', 'directional'"),
    (("lights", 1, "toward"), [0, 0, 0], "[0, 0, 0]", "other than (0, 0, 0)"),
    (("lights", 1, "color", 0), -1, "-1", "greater than or equal to 0"),
    (("lights", 0, "position", 0), False, "False", "valid number"),
]


@pytest.mark.parametrize(
    ("path", "value", "shown", "expected"),
    WRONG,
    ids=[f"{'.'.join(map(str, p))}={str(v)[:20]!r}" for p, v, _, _ in WRONG],
)
def test_a_wrong_json_value_is_named_with_file_path_value_and_expectation(
    path: tuple[Step, ...], value: Any, shown: str, expected: str
) -> None:
    message = str(refusal_of_json(json.dumps(changed(path, value))))
    where = list(path)
    if where[-1] in ("shape", "kind"):
        where = where[:2]
    assert message.startswith("wrong.json: " + ".".join(map(str, where)))
    assert shown in message
    assert expected in message.split("; expected ", 1)[1]


KEYS = [
    *[(key,) for key in GOOD],
    *[("image", key) for key in GOOD["image"]],
    *[("camera", key) for key in GOOD["camera"]],
    *[("materials", "red", key) for key in GOOD["materials"]["red"]],
    *[("objects", k, key) for k, thing in enumerate(GOOD["objects"]) for key in thing],
    *[("lights", k, key) for k, lamp in enumerate(GOOD["lights"]) for key in lamp],
]


@pytest.mark.parametrize("path", KEYS, ids=[".".join(map(str, path)) for path in KEYS])
def test_no_key_has_a_default(path: tuple[Step, ...]) -> None:
    data = copy.deepcopy(GOOD)
    inner: Any = data
    for step in path[:-1]:
        inner = inner[step]
    del inner[path[-1]]
    message = str(refusal_of_json(json.dumps(data)))
    named = path[:-1] if path[-1] in ("shape", "kind") else path
    assert message.startswith("wrong.json: " + ".".join(map(str, named)))


@pytest.mark.parametrize("name", ["sphere", "plane", "point", "directional"])
def test_a_material_named_like_a_shape_keeps_its_name_in_the_path(name: str) -> None:
    data = copy.deepcopy(GOOD)
    data["materials"][name] = {**data["materials"]["red"], "index": 0.0}
    assert str(refusal_of_json(json.dumps(data))).startswith(f"wrong.json: materials.{name}.index: ")


@pytest.mark.parametrize("name", ["two words", "", "é", "a/b", "x" * 65, "#1"])
def test_a_material_name_the_text_form_cannot_hold_is_refused(name: str) -> None:
    data = copy.deepcopy(GOOD)
    data["materials"][name] = data["materials"]["red"]
    assert str(refusal_of_json(json.dumps(data))).startswith("wrong.json: materials.")


@pytest.mark.parametrize(("key", "limit"), [("objects", MAX_OBJECTS), ("lights", MAX_LIGHTS)])
def test_more_entries_than_the_limit_are_refused(key: str, limit: int) -> None:
    data = copy.deepcopy(GOOD)
    data[key] = [data[key][0]] * (limit + 1)
    message = str(refusal_of_json(json.dumps(data)))
    assert message.startswith(f"wrong.json: {key}: ")
    assert str(limit) in message


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1 column 1: not JSON"),
        ("{", "line 1 column 2: not JSON"),
        ('{"raycheck": 1,\n "name": }', "line 2 column 10: not JSON"),
        ('{"raycheck": 1} more', "line 1 column 17: not JSON"),
        ("\ufeff{}", "not JSON"),
        ("[]", "scene: wrong value (got []); expected an object"),
        ("null", "scene: wrong value (got None); expected an object"),
        ("1", "scene: wrong value (got 1); expected an object"),
        ('{"raycheck": 1, "raycheck": 1}', "key given twice (got 'raycheck'); expected each key once"),
        ('{"raycheck": ' + "1" * 5000 + "}", "an integer of too many digits"),
        ('{"name": "\\ud800"}', "not JSON"),
    ],
)
def test_what_is_no_json_object_is_refused_with_its_place(text: str, words: str) -> None:
    message = str(refusal_of_json(text))
    assert message.startswith("wrong.json: ")
    assert words in message


def test_a_material_given_twice_is_refused_in_json() -> None:
    one = json.dumps(GOOD["materials"]["red"])
    text = json.dumps(GOOD).replace(f'"red": {one}', f'"red": {one}, "red": {one}')
    assert "key given twice (got 'red')" in str(refusal_of_json(text))


@pytest.mark.parametrize("depth", [*range(180, 1020, 20), 10_000, 1_000_000])
@pytest.mark.parametrize("brackets", ["[]", "{}"])
def test_deep_nesting_is_refused_and_nothing_else(depth: int, brackets: str) -> None:
    opening = '{"a":' if brackets == "{}" else "["
    text = '{"raycheck": ' + opening * depth + "1" + brackets[1] * depth + "}"
    assert str(refusal_of_json(text)).startswith("wrong.json: ")


@given(st.text())
def test_random_text_is_refused_in_both_notations(text: str) -> None:
    refusal_of_json(text)
    refusal_of_text(text)


WRONG_LINES = [
    # line, what stands there instead, the words of the message
    (1, "raycheck 2 two-spheres", "(got 2); expected 1"),
    (1, "raycheck 1.0 two-spheres", "(got 1.0)"),
    (1, "raycheck 1 two spheres", "statement out of place (got 'raycheck 1 two spheres'); expected `raycheck` with 2"),
    (1, "raycheck 1 two/spheres", "name: not a usable name (got 'two/spheres')"),
    (2, "image 16385 120 0 0", "image.width: too large (got 16385); expected less than or equal to 16384"),
    (2, "image 160 0 0 0", "image.height: too small (got 0)"),
    (2, "image 160 120 0 1.5", "image.sample.1: too large (got 1.5)"),
    (2, "image 160.5 120 0 0", "image.width: wrong value (got 160.5); expected a valid integer"),
    (3, "eye 0 0 far", "camera.eye.2: wrong value (got 'far'); expected a valid number"),
    (3, "eye 0 0 nan", "camera.eye.2: not a finite number (got nan); expected a finite number"),
    (3, "eye 0 0 1e999", "camera.eye.2: not a finite number (got inf)"),
    (3, "eye 0 0 1_0", "(got '1_0'); expected a valid number"),
    (3, "eye 0 0 ٣", "(got '٣'); expected a valid number"),
    (3, "eye 0 0 0x1", "(got '0x1'); expected a valid number"),
    (3, "eye 0 0", "statement out of place (got 'eye 0 0'); expected `eye` with 3"),
    (4, "forward 0 0 0", "camera.forward: cannot be used"),
    (5, "right 0 0 -0", "camera.right: cannot be used"),
    (6, "up 0 0 0", "expected a vector other than (0, 0, 0)"),
    (7, "background 0 -1 0", "background.1: too small (got -1); expected greater than or equal to 0"),
    (8, "depth 17", "depth: too large (got 17); expected less than or equal to 16"),
    (8, "depth -1", "depth: too small (got -1); expected greater than or equal to 0"),
    (8, "shadows 1", "statement out of place (got 'shadows 1'); expected `depth`"),
    (9, "shadows true", "shadows: wrong value (got 'true'); expected a valid boolean"),
    (9, "shadows 2", "shadows: wrong value (got '2')"),
    (10, "fresnel yes", "fresnel: wrong value (got 'yes')"),
    (11, "display gamma", "display: unknown value (got 'gamma'); expected 'lecture' or 'srgb'"),
    (12, "material red 1 2 3", "`material` with 4 word(s)"),
    (12, TEXT.splitlines()[11][:-1] + "0", "materials.red.index: too small (got 0); expected greater than 0"),
    (12, TEXT.splitlines()[11].replace(" 100 ", " 0 "), "materials.red.shininess: too small (got 0)"),
    (12, TEXT.splitlines()[11].replace(" 100 ", " 2.5 "), "(got 2.5); expected a valid integer"),
    (12, TEXT.splitlines()[11].replace("0.8", "-0.8"), "materials.red.diffuse.0: too small (got -0.8)"),
    (13, "sphere 0 0 1 0 red", "objects.0.radius: too small (got 0); expected greater than 0"),
    (13, "sphere 0 0 1 -1 red", "objects.0.radius: too small (got -1)"),
    (13, "sphere 0 0 1 1 blue", "unknown material (got 'blue'); expected a material defined above"),
    (13, "sphere 0 0 1 1", "`sphere` with 4 word(s)"),
    (13, "cube 0 0 1 1 red", "unknown statement (got 'cube')"),
    (14, "plane 0 0 0 -1 red", "objects.1.normal: cannot be used"),
    (14, "plane 0 1 0 inf red", "objects.1.offset: not a finite number (got inf)"),
    (15, "point 2 3 -2 1 1 1 linear", "lights.0.attenuation: unknown value (got 'linear')"),
    (15, "point 2 3 -2 1 1 1", "`point` with 6 word(s)"),
    (16, "directional 0 0 0 1 1 1", "lights.1.toward: cannot be used"),
    (16, "directional 0 1 -1 -0.3 0.3 0.3", "lights.1.color.0: too small (got -0.3)"),
    (16, "raycheck 1 two-spheres", "unknown statement (got 'raycheck')"),
    (17, "# no end", "file ends early (got no `end`)"),
    (17, "end\nsphere 0 0 1 1 red", "words after `end` (got 'sphere 0 0 1 1 red')"),
    (17, "end of scene", "words after `end` (got 'of scene')"),
]


@pytest.mark.parametrize(("line", "instead", "words"), WRONG_LINES, ids=[f"{n}:{i[:30]}" for n, i, _ in WRONG_LINES])
def test_a_wrong_line_is_named_with_file_line_value_and_expectation(line: int, instead: str, words: str) -> None:
    lines = TEXT.splitlines()
    lines[line - 1] = instead
    message = str(refusal_of_text("\n".join(lines)))
    at = {"# no end": 16, "end\nsphere 0 0 1 1 red": 18}.get(instead, line)
    assert message.startswith(f"wrong.txt: line {at}: ")
    assert words in message


@pytest.mark.parametrize("line", range(1, 12))
def test_a_missing_header_statement_is_named_on_the_line_where_it_should_stand(line: int) -> None:
    lines = TEXT.splitlines()
    missing = lines.pop(line - 1).split()[0]
    assert f"wrong.txt: line {line}: statement out of place" in str(refusal_of_text("\n".join(lines)))
    assert f"expected `{missing}`" in str(refusal_of_text("\n".join(lines)))


@pytest.mark.parametrize("kept", range(17))
def test_a_text_that_ends_early_says_so_on_its_last_line(kept: int) -> None:
    message = str(refusal_of_text("\n".join(TEXT.splitlines()[:kept])))
    assert message.startswith(f"wrong.txt: line {max(kept, 1)}: file ends early")


def test_a_material_defined_twice_is_refused_in_the_text_form() -> None:
    lines = TEXT.splitlines()
    lines.insert(12, lines[11])
    message = str(refusal_of_text("\n".join(lines)))
    assert message == "wrong.txt: line 13: material defined twice (got 'red'); expected each name once"


def test_line_numbers_count_comments_and_blank_lines() -> None:
    text = "# first\n\n" + TEXT.replace("depth 3", "depth 99")
    assert str(refusal_of_text(text)).startswith("wrong.txt: line 10: depth: ")


def refusal_of_file(path: Path) -> str:
    with pytest.raises(SceneError) as caught:
        load(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    return message


@pytest.mark.parametrize("ending", ["json", "txt"])
def test_binary_garbage_is_refused_with_its_first_bad_byte(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"scene.{ending}"
    path.write_bytes(b"ray\xff\x00\x80")
    assert "not text (got byte 0xff at offset 3); expected UTF-8 text" in refusal_of_file(path)


@pytest.mark.parametrize("ending", ["json", "txt"])
def test_a_file_of_nul_bytes_is_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"scene.{ending}"
    path.write_bytes(bytes(100))
    refusal_of_file(path)


@pytest.mark.parametrize("ending", ["json", "txt"])
def test_a_file_over_the_limit_is_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"scene.{ending}"
    with path.open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)
    assert f"file too large (got over {MAX_BYTES} bytes); expected at most {MAX_BYTES} bytes" in refusal_of_file(path)


def test_a_file_of_just_the_limit_is_read(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(json.dumps(GOOD).encode().ljust(MAX_BYTES))
    assert load(path).name == "two-spheres"


def test_an_endless_device_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.symlink_to("/dev/zero")
    assert "not a regular file" in refusal_of_file(path)


def test_a_pipe_that_nobody_writes_to_does_not_keep_us_waiting(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    os.mkfifo(path)
    assert "not a regular file" in refusal_of_file(path)


def test_a_directory_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.mkdir()
    assert "Is a directory; expected a readable scene file" in refusal_of_file(path)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    assert "No such file or directory" in refusal_of_file(tmp_path / "scene.json")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_an_unreadable_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.json"
    path.touch(mode=0)
    assert "Permission denied" in refusal_of_file(path)


@pytest.mark.parametrize("name", ["scene.xml", "scene", "scene.JSON"])
def test_another_ending_is_refused(tmp_path: Path, name: str) -> None:
    assert "expected an ending .json or .txt" in refusal_of_file(tmp_path / name)
