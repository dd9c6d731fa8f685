"""Lanes and the plain tracer are one tracer: the same bits."""

import dataclasses

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference_tracer import llvm, plain
from reference_tracer.lanes import render as lanes
from reference_tracer.rulebook import LECTURE
from reference_tracer.vector import Vec, unit
from scenes.catalogue import ladder, rung
from scenes.json_form import from_data

needs_llvm = pytest.mark.skipif(llvm.find() is None, reason=f"no libLLVM that works: {llvm.REMEDY}")
BACKENDS = ["numpy", pytest.param("drjit", marks=needs_llvm)]
NAMES = [entry.name for entry in ladder()]


def bits(image):
    return image.pixels.view(np.uint64)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("backend", BACKENDS)
def test_float64_lanes_equal_the_plain_tracer_bit_for_bit(name, backend):
    scene = rung(name).scene().resized(28, 21)
    assert (bits(lanes.render(scene, lanes.backend(backend, 64))) == bits(plain.render(scene))).all()


@pytest.mark.parametrize("name", NAMES)
@needs_llvm
def test_numpy_and_drjit_agree_bit_for_bit_at_full_size(name):
    scene = rung(name).scene()
    numpy, drjit = (lanes.render(scene, lanes.backend(kind, 64)) for kind in ("numpy", "drjit"))
    assert (bits(numpy) == bits(drjit)).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("backend", BACKENDS)
def test_the_midpoint_of_balls_is_the_float64_image_bit_for_bit(name, backend):
    scene = rung(name).scene().resized(60, 45)
    lane = lanes.backend(backend, 64)
    found = lanes.enclose(scene, lane, 2.0**-23, 1e-3)
    assert (found.pixels.view(np.uint64) == bits(lanes.render(scene, lane))).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("backend", BACKENDS)
def test_float32_lanes_lie_inside_the_balls_of_their_roundoff(name, backend):
    scene = rung(name).scene().resized(120, 90)
    got = lanes.render(scene, lanes.backend(backend, 32)).pixels.astype(np.float64)
    found = lanes.enclose(scene, lanes.backend(backend, 64), 2.0**-24, 0.0)
    assert (np.abs(got - found.pixels) <= found.radius).all()


def test_tiles_make_no_difference(monkeypatch):
    scene = rung("lecture-final").scene().resized(40, 30)
    whole = lanes.render(scene, lanes.backend("numpy", 64))
    small = lanes.backend("numpy", 64)
    monkeypatch.setattr(small, "tile", 97)
    assert (bits(lanes.render(scene, small)) == bits(whole)).all()


def test_a_deep_splitting_scene_is_traced_in_small_tiles():
    scene = rung("reflect-and-refract").scene().with_depth(12).resized(8, 6)
    assert lanes.tile_size(scene, lanes.backend("numpy", 64)) <= 64
    assert np.isfinite(lanes.render(scene, lanes.backend("numpy", 64)).pixels).all()


def test_an_empty_scene_is_its_background():
    image = lanes.render(rung("background").scene(), lanes.backend("numpy", 64))
    assert (image.pixels == np.array([0.8, 0.5, 0.2])).all()


unit_interval = st.floats(0, 1).map(lambda x: round(x, 3))
colour = st.tuples(unit_interval, unit_interval, unit_interval).map(list)
near = st.floats(-3, 3).map(lambda x: round(x, 3))
place = st.tuples(near, near, near).map(list)
weight = st.sampled_from([[0, 0, 0], [0.5, 0.4, 0.3], [1, 1, 1]])
material = st.fixed_dictionaries(
    {
        "ambient": colour,
        "diffuse": colour,
        "specular": colour,
        "shininess": st.integers(1, 300),
        "reflect": weight,
        "transmit": weight,
        "index": st.sampled_from([1.0, 1.33, 1.5, 0.67, 2.4]),
    }
)
sphere = st.fixed_dictionaries(
    {"shape": st.just("sphere"), "center": place, "radius": st.floats(0.2, 2.0), "material": st.sampled_from("ab")}
)
plane = st.fixed_dictionaries(
    {
        "shape": st.just("plane"),
        "normal": place.filter(any),
        "offset": near,
        "material": st.sampled_from("ab"),
    }
)
light = st.one_of(
    st.fixed_dictionaries(
        {
            "kind": st.just("point"),
            "position": place,
            "color": colour,
            "attenuation": st.sampled_from(["none", "inverse", "inverse_square"]),
        }
    ),
    st.fixed_dictionaries({"kind": st.just("directional"), "toward": place.filter(any), "color": colour}),
)
scenes = st.fixed_dictionaries(
    {
        "raycheck": st.just(1),
        "name": st.just("random"),
        "source": st.just(""),
        "image": st.just({"width": 9, "height": 7, "sample": [0.5, 0.5]}),
        "camera": st.just({"eye": [0, 0, -4], "forward": [0, 0, 1.5], "right": [1.3, 0, 0], "up": [0, 1, 0]}),
        "background": colour,
        "depth": st.integers(0, 4),
        "shadows": st.booleans(),
        "fresnel": st.booleans(),
        "display": st.just("lecture"),
        "materials": st.fixed_dictionaries({"a": material, "b": material}),
        "objects": st.lists(sphere | plane, max_size=4),
        "lights": st.lists(light, max_size=3),
    }
).map(from_data)


@given(scene=scenes)
@settings(max_examples=60)
def test_any_scene_has_the_same_bits_plain_and_on_numpy(scene):
    assert (bits(plain.render(scene)) == bits(lanes.render(scene, lanes.backend("numpy", 64)))).all()


@needs_llvm
@given(scene=scenes)
@settings(max_examples=60)
def test_any_scene_has_the_same_bits_on_numpy_and_drjit(scene):
    numpy, drjit = (lanes.render(scene, lanes.backend(kind, 64)) for kind in ("numpy", "drjit"))
    assert (bits(numpy) == bits(drjit)).all()


@given(scene=scenes)
@settings(max_examples=60)
def test_in_any_scene_float32_lies_inside_the_balls_of_its_roundoff(scene):
    got = lanes.render(scene, lanes.backend("numpy", 32)).pixels.astype(np.float64)
    found = lanes.enclose(scene, lanes.backend("numpy", 64), 2.0**-24, 0.0)
    assert (np.abs(got - found.pixels) <= found.radius * (1 + 2.0**-50)).all()  # the difference is rounded here


def test_ties_are_decided_the_same_way_whatever_the_order_of_objects():
    scene = rung("shadow-touching").scene().resized(40, 30)
    turned = scene.model_copy(update={"objects": scene.objects[::-1]})
    lane = lanes.backend("numpy", 64)
    assert (bits(lanes.render(scene, lane)) == bits(lanes.render(turned, lane))).all()


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_replaced_formula_changes_the_plain_tracer_and_the_lanes_alike(backend):
    false_identity = dataclasses.replace(LECTURE, reflect=lambda i, n: unit(Vec(*(2.0 * a for a in n)) - i))
    scene = rung("phong-10").scene().resized(32, 24)
    expected = plain.render(scene, false_identity)
    assert (bits(expected) != bits(plain.render(scene))).any()
    assert (bits(lanes.render(scene, lanes.backend(backend, 64), false_identity)) == bits(expected)).all()


def test_progress_goes_up_to_one():
    told = []
    plain.render(rung("pixel-centre").scene(), progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("u", [2.0**-23, 2.0**-53])
@needs_llvm
def test_numpy_and_drjit_enclose_alike_to_the_last_bit(name, u):
    scene = rung(name).scene().resized(80, 60)
    numpy, drjit = (lanes.enclose(scene, lanes.backend(kind, 64), u, 1e-3) for kind in ("numpy", "drjit"))
    assert (numpy.radius.view(np.uint64) == drjit.radius.view(np.uint64)).all()
    assert (numpy.doubts == drjit.doubts).all()
