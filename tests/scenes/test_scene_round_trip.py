"""JSON -> text -> JSON is the identity, for every scene there can be."""

from __future__ import annotations

import math
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from scenes.catalogue import ladder
from scenes.files import load
from scenes.json_form import from_json, to_json
from scenes.model import (
    Camera,
    DirectionalLight,
    ImagePlane,
    Material,
    Plane,
    PointLight,
    Scene,
    Sphere,
)
from scenes.text import from_text, to_text

# From the contract, word for word (but for the text form's comment, which "is for this page only")
CONTRACT_JSON = """
{"raycheck": 1, "name": "two-spheres", "source": "L11: Ray Tracing Depth Sorting",
 "image": {"width": 160, "height": 120, "sample": [0.0, 0.0]},
 "camera": {"eye": [0,0,-2], "forward": [0,0,1], "right": [1.3333333333333333,0,0], "up": [0,1,0]},
 "background": [0,0,0], "depth": 3, "shadows": true, "display": "lecture",
 "materials": {"red": {"ambient": [0.1,0,0], "diffuse": [0.8,0.1,0.1], "specular": [0.5,0.5,0.5], "shininess": 100,
                       "reflect": [0,0,0], "transmit": [0,0,0], "index": 1.0}},
 "objects": [{"shape": "sphere", "center": [0,0,1], "radius": 1.0, "material": "red"},
             {"shape": "plane", "normal": [0,1,0], "offset": -1.0, "material": "red"}],
 "lights": [{"kind": "point", "position": [2,3,-2], "color": [1,1,1], "attenuation": "none"},
            {"kind": "directional", "toward": [0,1,-1], "color": [0.3,0.3,0.3]}]}
"""
CONTRACT_TEXT = """\
raycheck 1 two-spheres
image 160 120 0 0
eye 0 0 -2
forward 0 0 1
right 1.3333333333333333 0 0
up 0 1 0
background 0 0 0
depth 3
shadows 1
fresnel 0
display lecture
material red  0.1 0 0  0.8 0.1 0.1  0.5 0.5 0.5  100  0 0 0  0 0 0  1
sphere 0 0 1  1  red
plane 0 1 0  -1  red
point 2 3 -2  1 1 1  none
directional 0 1 -1  0.3 0.3 0.3
end
"""

EXTREMES = (-0.0, 5e-324, -5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, -1.7976931348623157e308, 0.1)
finite = st.floats(allow_nan=False, allow_infinity=False) | st.sampled_from(EXTREMES)
vectors = st.tuples(finite, finite, finite)
directions = vectors.filter(any)
intensities = finite.map(abs) | st.just(-0.0)
colours = st.tuples(intensities, intensities, intensities)
positives = finite.map(abs).filter(bool)
unit_interval = st.floats(0.0, 1.0)
odd_names = st.sampled_from(("end", "sphere", "plane", "point", "materials", "1", "0x", "-", ".", "+", "1e5", "nan"))
material_names = st.from_regex(r"[A-Za-z0-9_.+-]{1,64}", fullmatch=True) | odd_names
scene_names = st.from_regex(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}", fullmatch=True)
sources = st.text(st.characters(exclude_characters="\r\n", exclude_categories=("Cs",)), max_size=40) | st.sampled_from(
    ("", " ", "# source ", "a\u2028b", "a\x0bend", "a\x85b", "  x  ")
)


@st.composite
def scenes(draw: st.DrawFn) -> Scene:
    material = st.builds(
        Material,
        ambient=colours,
        diffuse=colours,
        specular=colours,
        shininess=st.integers(1, 1_000_000),
        reflect=colours,
        transmit=colours,
        index=positives,
    )
    materials = draw(st.dictionaries(material_names, material, min_size=1, max_size=3))
    named = st.sampled_from(sorted(materials))
    sphere = st.builds(Sphere, shape=st.just("sphere"), center=vectors, radius=positives, material=named)
    plane = st.builds(Plane, shape=st.just("plane"), normal=directions, offset=finite, material=named)
    point = st.builds(
        PointLight,
        kind=st.just("point"),
        position=vectors,
        color=colours,
        attenuation=st.sampled_from(("none", "inverse", "inverse_square")),
    )
    far = st.builds(DirectionalLight, kind=st.just("directional"), toward=directions, color=colours)
    return Scene(
        raycheck=1,
        name=draw(scene_names),
        source=draw(sources),
        image=draw(
            st.builds(
                ImagePlane,
                width=st.integers(1, 16384),
                height=st.integers(1, 16384),
                sample=st.tuples(unit_interval, unit_interval),
            )
        ),
        camera=draw(st.builds(Camera, eye=vectors, forward=directions, right=directions, up=directions)),
        background=draw(colours),
        depth=draw(st.integers(0, 16)),
        shadows=draw(st.booleans()),
        fresnel=draw(st.booleans()),
        display=draw(st.sampled_from(("lecture", "srgb"))),
        materials=materials,
        objects=tuple(draw(st.lists(sphere | plane, max_size=3))),
        lights=tuple(draw(st.lists(point | far, max_size=3))),
    )


def exactly(value: Any) -> Any:
    """The same tree with each float as its bits, so that -0.0 is not 0.0; dicts as ordered pairs."""
    if isinstance(value, dict):
        return [(key, exactly(part)) for key, part in value.items()]
    if isinstance(value, list | tuple):
        return [exactly(part) for part in value]
    return struct.pack("<d", value) if isinstance(value, float) else value


def content(scene: Scene) -> Any:
    return exactly(scene.model_dump())


@given(scenes())
def test_every_scene_survives_json_to_text_to_json_bit_for_bit(scene: Scene) -> None:
    through_json = from_json(to_json(scene))
    through_text = from_text(to_text(through_json))
    assert content(from_json(to_json(through_text))) == content(scene)


@given(scenes())
def test_every_statement_of_the_text_form_has_the_words_of_the_contract(scene: Scene) -> None:
    sizes = {"image": 5, "eye": 4, "forward": 4, "right": 4, "up": 4, "background": 4, "depth": 2, "shadows": 2}
    sizes |= {"raycheck": 3, "fresnel": 2, "display": 2, "material": 19, "sphere": 6, "plane": 6, "point": 8}
    sizes |= {"directional": 7, "end": 1}
    statements = [line.split(" ") for line in to_text(scene).split("\n") if line and not line.startswith("#")]
    assert all(len(words) == sizes[words[0]] for words in statements)
    assert [words[0] for words in statements].count("end") == 1


@pytest.mark.parametrize("name", [rung.name for rung in ladder()])
def test_a_catalogue_scene_survives_json_to_text_to_json(name: str) -> None:
    scene = next(rung.scene() for rung in ladder() if rung.name == name)
    assert content(from_json(to_json(from_text(to_text(scene))))) == content(scene)


def test_the_two_forms_in_the_contract_are_the_same_scene() -> None:
    from_words = from_text(CONTRACT_TEXT)
    assert content(from_words.model_copy(update={"source": "L11: Ray Tracing Depth Sorting"})) == content(
        from_json(CONTRACT_JSON)
    )


def test_the_text_form_is_written_as_in_the_contract() -> None:
    def words(text: str) -> list[list[str | float]]:
        lines = [line.split() for line in text.splitlines() if not line.startswith("#")]
        return [[float(word) if word[-1].isdigit() else word for word in line] for line in lines]

    assert words(to_text(from_json(CONTRACT_JSON))) == words(CONTRACT_TEXT)


@pytest.mark.parametrize("number", [0.1, 1 / 3, 5e-324, -0.0, 1.7976931348623157e308, 123456789012345680.0])
def test_numbers_in_the_text_form_are_written_in_17_significant_digits(number: float) -> None:
    scene = from_json(CONTRACT_JSON)
    camera = scene.camera.model_copy(update={"eye": (number, 0.0, -2.0)})
    line = next(x for x in to_text(scene.model_copy(update={"camera": camera})).splitlines() if x.startswith("eye"))
    assert line == f"eye {number:.17g} 0 -2"


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\n\n"),
        lambda text: text.replace("\n", "\n# a comment\n"),
        lambda text: text.replace("\n", "\n   # an indented comment\n"),
        lambda text: "# a first line\n\n" + text,
        lambda text: text.replace("\n", "  \n"),
        lambda text: text.replace(" ", "\t"),
        lambda text: text.rstrip("\n"),
        lambda text: text + "\n\n# the last word\n",
    ],
    ids=["crlf", "blank", "comments", "indented", "first", "trailing-blanks", "tabs", "no-last-newline", "after-end"],
)
def test_line_ends_blanks_and_comments_change_nothing(change: Any) -> None:
    assert content(from_text(change(CONTRACT_TEXT))) == content(from_text(CONTRACT_TEXT))


def test_a_crlf_text_keeps_its_source_free_of_the_carriage_return() -> None:
    text = "# source L11: a slide\n" + CONTRACT_TEXT
    assert from_text(text.replace("\n", "\r\n")).source == "L11: a slide"


@pytest.mark.parametrize("ending", ["json", "txt"])
def test_a_scene_file_of_either_ending_is_loaded(tmp_path: Any, ending: str) -> None:
    path = tmp_path / f"scene.{ending}"
    path.write_bytes((CONTRACT_JSON if ending == "json" else CONTRACT_TEXT).encode())
    assert load(path).objects[0] == Sphere(shape="sphere", center=(0.0, 0.0, 1.0), radius=1.0, material="red")


def test_a_crlf_json_file_is_loaded(tmp_path: Any) -> None:
    path = tmp_path / "scene.json"
    path.write_bytes(CONTRACT_JSON.replace("\n", "\r\n").encode())
    assert content(load(path)) == content(from_json(CONTRACT_JSON))


def test_fresnel_is_left_out_of_json_unless_it_is_true() -> None:
    scene = from_json(CONTRACT_JSON)
    assert '"fresnel"' not in to_json(scene)
    assert '"fresnel": true' in to_json(scene.model_copy(update={"fresnel": True}))


def test_minus_zero_keeps_its_sign_in_both_forms() -> None:
    scene = from_json(CONTRACT_JSON.replace('"offset": -1.0', '"offset": -0.0'))
    plane = from_text(to_text(scene)).objects[1]
    assert isinstance(plane, Plane)
    assert math.copysign(1.0, plane.offset) == -1.0
