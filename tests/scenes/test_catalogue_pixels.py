"""Each scene excites its idea: a tracer that lacks the idea makes another picture, beyond float32's tolerance."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oracles.compare import compare
from oracles.images import Picture
from oracles.truth import truth
from reference_tracer.lanes.render import backend, render
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.catalogue import rung
from scenes.model import Plane, PointLight, Scene

Pixels = NDArray[Any]
SURE = 2.0**-40
"""Decisions are asked of rays that are so far from the edge: a thousand times what the checks' own arithmetic loses."""


def pixels(scene: Scene, rules: Rulebook = LECTURE) -> Pixels:
    return render(scene, backend("numpy", 64), rules).pixels


@cache
def scene_of(name: str) -> Scene:
    return rung(name).scene()


@cache
def picture_of(name: str) -> Pixels:
    return pixels(scene_of(name))


def outside(name: str, wrong: Pixels, precision: str = "float32") -> int:
    """Number of pixels that the suite calls wrong when a tracer of a precision hands in `wrong` for the scene."""
    return compare(Picture(wrong), truth(scene_of(name), precision)).judged.outside


def view(scene: Scene) -> tuple[NDArray[Any], NDArray[Any]]:
    """Eye and unit eye rays by the contract's formula, (3,) and (height, width, 3)."""
    image, camera = scene.image, scene.camera
    X = -1 + 2 * (np.arange(image.width) + image.sample[0]) / image.width
    Y = 1 - 2 * (np.arange(image.height) + image.sample[1]) / image.height
    v = np.array(camera.forward) + X[None, :, None] * np.array(camera.right) + Y[:, None, None] * np.array(camera.up)
    return np.array(camera.eye), v / np.linalg.norm(v, axis=-1, keepdims=True)


@pytest.mark.parametrize("depth", [2, 3, 4])
@pytest.mark.parametrize("step", [-1, 1])
def test_facing_mirrors_of_one_generation_more_or_less_fail(depth: int, step: int) -> None:
    name = f"facing-mirrors-{depth}"
    assert scene_of(name).depth == depth
    assert outside(name, pixels(scene_of(name).with_depth(depth + step))) > 0.1 * picture_of(name)[..., 0].size


def test_facing_mirrors_differ_in_depth_only() -> None:
    three = scene_of("facing-mirrors-3")
    for depth in (2, 4):
        other = scene_of(f"facing-mirrors-{depth}")
        assert other.model_copy(update={"name": three.name, "depth": 3}) == three


def test_depth_order_does_not_depend_on_the_order_of_the_objects() -> None:
    forward, backward = scene_of("depth-order"), scene_of("depth-order-reversed")
    assert forward.objects == backward.objects[::-1]
    np.testing.assert_array_equal(picture_of("depth-order"), picture_of("depth-order-reversed"))


@pytest.mark.parametrize("name", ["depth-order", "depth-order-reversed"])
def test_a_tracer_that_takes_the_farthest_hit_fails_both_depth_orders(name: str) -> None:
    farthest = dataclasses.replace(LECTURE, nearer=lambda distance, best, order, best_order: distance > best)
    assert outside(name, pixels(scene_of(name), farthest)) > 100


@pytest.mark.parametrize(
    ("name", "keeps"),
    [
        ("depth-order", lambda order, best_order: order < best_order),
        ("depth-order-reversed", lambda order, best_order: order > best_order),
    ],
)
def test_a_tracer_that_sorts_by_list_order_fails_one_of_them(name: str, keeps: Any) -> None:
    def first(distance: Any, best: Any, order: Any, best_order: Any) -> Any:
        return keeps(order, best_order)

    assert outside(name, pixels(scene_of(name), dataclasses.replace(LECTURE, nearer=first))) > 100


def test_the_invisible_sphere_changes_nothing() -> None:
    scene = scene_of("invisible-sphere")
    without = scene.model_copy(update={"objects": scene.objects[1:]})
    assert scene.objects[0].material == "nothing"
    assert outside("invisible-sphere", pixels(without), "float64") == 0


def test_a_tracer_that_stops_at_the_invisible_sphere_fails() -> None:
    assert outside("invisible-sphere", pixels(scene_of("invisible-sphere").with_depth(0))) > 100


def test_the_sphere_behind_the_light_shades_nothing() -> None:
    scene = scene_of("shadow-behind-light")
    lit = pixels(scene.model_copy(update={"shadows": False}))
    np.testing.assert_array_equal(picture_of("shadow-behind-light"), lit)


def test_a_tracer_whose_shadow_rays_pass_the_light_fails() -> None:
    endless = dataclasses.replace(
        LECTURE, blocks=lambda distance, light_distance, opaque: distance > 0.0 * light_distance
    )
    assert outside("shadow-behind-light", pixels(scene_of("shadow-behind-light"), endless)) > 100


@pytest.mark.parametrize("name", ["shadow-hard", "shadow-touching", "shadow-glass", "lecture-final"])
def test_a_tracer_without_shadows_fails(name: str) -> None:
    assert outside(name, pixels(scene_of(name).model_copy(update={"shadows": False}))) > 100


def test_beyond_the_critical_angle_the_water_surface_shows_its_ambient_only() -> None:
    scene = scene_of("under-water")
    _, v = view(scene)
    # Snell at the plane y = 0: sinθ2 = 1.33 sinθ1 and sinθ1 is the horizontal part of the ray
    sin2 = 1.33 * np.hypot(v[..., 0], v[..., 2])
    total = (v[..., 1] > 0) & (sin2 > 1 + SURE)
    assert 0.1 < total.mean() < 0.9
    np.testing.assert_array_equal(picture_of("under-water")[total], [[0.0, 0.05, 0.1]] * np.count_nonzero(total))


def test_below_the_critical_angle_the_water_surface_lets_light_through() -> None:
    scene = scene_of("under-water")
    _, v = view(scene)
    through = (v[..., 1] > 0) & (1.33 * np.hypot(v[..., 0], v[..., 2]) < 1 - SURE)
    assert np.count_nonzero(through) > 100
    assert (picture_of("under-water")[through] > [0.0, 0.05, 0.1]).any(axis=-1).all()


def test_the_air_bubble_has_a_ring_from_which_no_light_comes() -> None:
    # Only the bubble's own ambient, through one surface of the glass: 0.95 · (0.02, 0, 0)
    ring = (picture_of("air-bubble") == [0.95 * 0.02, 0.0, 0.0]).all(axis=-1)
    assert np.count_nonzero(ring) > 1000


def test_inside_glass_some_rays_are_totally_reflected() -> None:
    total = (picture_of("inside-glass") == [0.02, 0.03, 0.03]).all(axis=-1)
    assert np.count_nonzero(total) > 100


def test_a_scaled_normal_is_the_same_plane_as_the_unit_one() -> None:
    scene = scene_of("plane-scaled-normal")
    (plane,) = scene.objects
    assert isinstance(plane, Plane)
    length = float(np.linalg.norm(plane.normal))
    assert length > 2.0
    x, y, z = (part / length for part in plane.normal)
    unit = plane.model_copy(update={"normal": (x, y, z), "offset": plane.offset / length})
    same = pixels(scene.model_copy(update={"objects": (unit,)}))
    assert outside("plane-scaled-normal", same, "float64") == 0


@pytest.mark.parametrize("spoilt", ["offset", "shading"])
def test_a_tracer_that_mixes_up_the_length_of_the_normal_fails(spoilt: str) -> None:
    scene = scene_of("plane-scaled-normal")
    (plane,) = scene.objects
    assert isinstance(plane, Plane)
    if spoilt == "shading":
        wrong = pixels(scene, dataclasses.replace(LECTURE, plane_normal=lambda normal: normal))
    else:
        x, y, z = (part / float(np.linalg.norm(plane.normal)) for part in plane.normal)
        wrong = pixels(scene.model_copy(update={"objects": (plane.model_copy(update={"normal": (x, y, z)}),)}))
    assert outside("plane-scaled-normal", wrong) > 500


def test_pixel_centre_and_pixel_corner_are_one_scene_sampled_twice() -> None:
    corner, centre = scene_of("pixel-corner"), scene_of("pixel-centre")
    image = centre.image.model_copy(update={"sample": (0.0, 0.0)})
    assert centre.model_copy(update={"name": corner.name, "image": image}) == corner
    assert centre.image.sample == (0.5, 0.5)


@pytest.mark.parametrize(("name", "other"), [("pixel-centre", "pixel-corner"), ("pixel-corner", "pixel-centre")])
def test_the_wrong_sample_position_fails(name: str, other: str) -> None:
    assert outside(name, picture_of(other)) > 50


def test_the_centres_are_the_odd_corners_of_twice_the_resolution() -> None:
    # X = -1 + 2(i + 1/2)/w = -1 + 2(2i + 1)/2w
    corner = scene_of("pixel-corner")
    doubled = pixels(corner.resized(2 * corner.image.width, 2 * corner.image.height))
    assert outside("pixel-centre", doubled[1::2, 1::2], "float64") == 0


def distance_to_light(name: str) -> NDArray[Any]:
    """From each pixel's point on the wall z = 2 to the light."""
    scene = scene_of(name)
    eye, v = view(scene)
    (light,) = scene.lights
    assert isinstance(light, PointLight)
    wall = eye + v * ((2.0 - eye[2]) / v[..., 2])[..., None]
    return np.linalg.norm(wall - np.array(light.position), axis=-1)


@pytest.mark.parametrize(("kind", "power"), [("inverse", 1), ("inverse-square", 2)])
def test_attenuation_divides_the_light_by_the_power_of_the_distance(kind: str, power: int) -> None:
    scene = scene_of(f"attenuation-{kind}")
    (light,) = scene.lights
    unattenuated = scene.model_copy(update={"lights": (light.model_copy(update={"attenuation": "none"}),)})
    expected = pixels(unattenuated) / distance_to_light(scene.name)[..., None] ** power
    # A distance of about ten roundings, squared; the factor meets three products and two sums
    np.testing.assert_allclose(picture_of(scene.name), expected, rtol=32 * 2.0**-53, atol=0.0)


@pytest.mark.parametrize("kind", ["none", "inverse", "inverse_square"])
@pytest.mark.parametrize("taken", ["none", "inverse", "inverse_square"])
def test_another_attenuation_fails(kind: str, taken: str) -> None:
    name = f"attenuation-{kind.replace('_', '-')}"
    scene = scene_of(name)
    (light,) = scene.lights
    wrong = pixels(scene.model_copy(update={"lights": (light.model_copy(update={"attenuation": taken}),)}))
    assert (outside(name, wrong) > 1000) is (kind != taken)


def test_a_light_behind_the_surface_leaves_the_ambient_and_nothing_else() -> None:
    scene = scene_of("light-behind")
    eye, v = view(scene)
    ball, light = np.array([0.0, 0.0, 1.0]), np.array([1.2, 0.8, 2.6])
    b = eye - ball
    bv = v @ b
    D = bv**2 - (b @ b - 1.0)
    hit = D > SURE
    p = eye + v * (-bv - np.sqrt(np.maximum(D, 0.0)))[..., None]
    behind = hit & (((light - p) * (p - ball)).sum(axis=-1) < -SURE)
    assert np.count_nonzero(behind) > 0.99 * np.count_nonzero(hit)
    np.testing.assert_array_equal(picture_of("light-behind")[behind], [[0.1, 0.05, 0.05]] * np.count_nonzero(behind))


@pytest.mark.parametrize("wrong", [lambda c: c, abs], ids=["unclamped", "two-sided"])
def test_a_tracer_that_does_not_clamp_the_cosine_fails(wrong: Any) -> None:
    def lambert(i: Any, n: Any) -> Any:
        return wrong(i.x * n.x + i.y * n.y + i.z * n.z)

    rules = dataclasses.replace(LECTURE, lambert=lambert)
    assert outside("light-behind", pixels(scene_of("light-behind"), rules)) > 1000


def test_a_tracer_that_takes_the_far_side_of_the_eye_fails_the_sphere_behind() -> None:
    scene = scene_of("sphere-behind-eye")
    mirrored = scene.objects[0].model_copy(update={"center": (0.2, 0.1, 0.0)})
    assert (
        outside("sphere-behind-eye", pixels(scene.model_copy(update={"objects": (mirrored, *scene.objects[1:])}))) > 100
    )


def test_phong_10_and_100_differ_in_the_exponent_only() -> None:
    ten, hundred = scene_of("phong-10"), scene_of("phong-100")
    shiny = ten.materials["shiny"].model_copy(update={"shininess": 100})
    assert (
        ten.model_copy(update={"name": "phong-100", "materials": {"shiny": shiny}, "source": hundred.source}) == hundred
    )
    assert outside("phong-100", picture_of("phong-10")) > 100


def test_a_tracer_with_highlights_behind_the_terminator_fails() -> None:
    def phong(i: Any, n: Any, v: Any, s: Any, mirrored: Any) -> Any:
        gloss = -(mirrored.x * v.x + mirrored.y * v.y + mirrored.z * v.z)
        return np.where(gloss > 0.0, gloss, 0.0) ** s

    rules = dataclasses.replace(LECTURE, phong=phong)
    assert outside("phong-terminator", pixels(scene_of("phong-terminator"), rules)) > 10


@pytest.mark.parametrize("name", ["mirror-imperfect", "mirror-perfect", "refract-plane", "strays"])
def test_the_depth_of_a_scene_is_needed(name: str) -> None:
    assert outside(name, pixels(scene_of(name).with_depth(scene_of(name).depth - 1))) > 100


@pytest.mark.parametrize("name", ["lecture-final", "reflect-and-refract", "air-bubble", "inside-glass", "shadow-glass"])
def test_the_first_generation_is_needed(name: str) -> None:
    assert outside(name, pixels(scene_of(name).with_depth(0))) > 100


def test_every_pixel_of_the_background_scene_is_the_background() -> None:
    np.testing.assert_array_equal(picture_of("background"), np.broadcast_to([0.8, 0.5, 0.2], (120, 160, 3)))
