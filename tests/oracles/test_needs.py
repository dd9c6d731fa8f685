"""What a scene needs: nothing less draws it, nothing more changes it; expected models follow from geometry."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from numpy.typing import NDArray

from oracles.measurement import Precision
from oracles.needs import HALF_A_CODE, METHODS, Needs, Part, Trial, changed, everything, needs, trials
from reference_tracer import certified
from reference_tracer.certified import Certified
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.rulebook import Rulebook
from scenes.catalogue import rung
from scenes.model import Scene, Sphere, Vector

certify = partial(certified.render, backend=NumPyBackend(64))


def small(name: str) -> Scene:
    return rung(name).scene().resized(24, 18)


def needed(scene: Scene) -> Needs:
    return needs(scene, certify, np.ones((scene.image.height, scene.image.width, 3)))


def tried(scene: Scene) -> list[Trial]:
    def draw(least: Scene, precision: Precision, rules: Rulebook) -> NDArray[np.floating]:
        return lanes.render(least, NumPyBackend(32 if precision == "float32" else 64), rules).pixels

    return trials(scene, certify(scene), draw)


def sphere(center: Vector, radius: float, material: str) -> Sphere:
    return Sphere(shape="sphere", center=center, radius=radius, material=material)


def moved(scene: Scene, by: float) -> Scene:
    """Spheres, point lights and eye along x; by a sum that float64 makes exactly."""

    def there(place: Vector) -> Vector:
        return (place[0] + by, place[1], place[2])

    things = tuple(t.model_copy(update={"center": there(t.center)}) for t in scene.objects if isinstance(t, Sphere))
    lamps = tuple(lamp.model_copy(update={"position": there(lamp.position)}) for lamp in scene.lights)
    camera = scene.camera.model_copy(update={"eye": there(scene.camera.eye)})
    return scene.model_copy(update={"objects": things, "lights": lamps, "camera": camera})


def test_one_convex_mirror_needs_no_third_generation() -> None:
    # a ray that leaves a convex mirror never meets it again, and nothing else reflects
    scene = small("mirror-perfect")
    mirrors = [t for t in scene.objects if any(scene.materials[t.material].reflect)]
    assert len(mirrors) == 1
    found = needed(scene.with_depth(3))
    assert found.model == everything(scene.with_depth(1))
    assert found.spare == (Part("depth", 3), Part("depth", 2))
    assert Part("depth", 1) in dict(found.necessary)


def test_an_object_that_no_ray_meets_is_not_needed() -> None:
    scene = small("glass-sphere")
    behind = sphere((0.0, 0.0, -1e6), 1.0, scene.objects[0].material)
    found = needed(scene.model_copy(update={"objects": (behind, *scene.objects)}))
    assert found.model.objects == (1, 2, 3)
    assert found.spare == (Part("object", 0),)


def test_of_two_equal_objects_one_is_needed() -> None:
    scene = small("headlight-sphere")
    found = needed(scene.model_copy(update={"objects": (scene.objects[0], scene.objects[0])}))
    assert found.model.objects == (1,)
    assert [str(part) for part, _ in found.necessary] == ["light 0", "object 1"]


def test_mirrors_that_nobody_follows_are_no_feature() -> None:
    found = needed(small("mirror-perfect").with_depth(0))
    assert (found.model.features, found.model.depth) == (frozenset(), 0)


def test_what_is_lacking_names_a_pixel_that_differs_by_as_much() -> None:
    scene = small("shadow-hard")
    found = needed(scene)
    bare, full = certify(scene.model_copy(update={"shadows": False})), certify(scene)
    lit = bare.value - full.value
    change = dict(found.necessary)[Part("feature", "shadow")]
    assert change.by == change.tolerances == lit[change.j, change.i].max() == lit.max() > 0.0
    assert change.pixels == (lit > bare.bound + full.bound).any(axis=-1).sum()


def test_a_difference_within_both_bounds_is_no_change() -> None:
    true = certify(small("background"))

    def shifted(by: float) -> Certified:
        return Certified(true.value + by, true.bound + 1.0, true.bits, true.decided, true.margin)

    assert changed(true, shifted(0.5), np.ones_like(true.value)) is None
    change = changed(true, shifted(1.5), np.full_like(true.value, 0.5))
    assert change is not None
    assert (change.pixels, change.by, change.tolerances) == (24 * 18, 1.5, 3.0)


@pytest.mark.parametrize("name", ["lecture-final", "glass-sphere", "mirror-perfect", "srgb-display"])
def test_float32_and_the_lectures_formula_suffice_for_the_lectures_scenes(name: str) -> None:
    (trial,) = tried(small(name))
    assert (trial.precision, trial.method, trial.suffices) == ("float32", "lecture", True)
    assert trial.codes <= HALF_A_CODE


def test_float32_is_not_enough_where_it_cannot_hold_the_scene() -> None:
    # beyond 2^24 float32 tells integers apart no more: a sphere of radius 1 is anywhere
    found = tried(moved(small("depth-order"), 2.0**25 + 1.0))
    assert [trial.precision for trial in found] == ["float32"] * len(METHODS) + ["float64"]
    assert found[-1].suffices
    assert not any(trial.suffices for trial in found[:-1])
    assert found[-1].wrong == 0 < found[0].wrong


def test_a_better_formula_lets_float32_suffice_far_away() -> None:
    # docs/stability.md: the lecture's formula holds to D = 63, the residual form to some thousands
    scene = small("headlight-sphere")
    ball = sphere((0.0, 0.0, 1000.0), 1.0, scene.objects[0].material)
    camera = scene.camera.model_copy(
        update={
            "eye": (0.0, 0.0, 0.0),
            "forward": (0.0, 0.0, 1000.0),
            "right": (1.6, 0.0, 0.0),
            "up": (0.0, 1.2, 0.0),
        }
    )
    lamp = scene.lights[0].model_copy(update={"position": (0.0, 0.0, 0.0)})
    found = tried(scene.model_copy(update={"objects": (ball,), "camera": camera, "lights": (lamp,)}))
    assert [(trial.precision, trial.suffices) for trial in found[:1]] == [("float32", False)]
    assert found[-1].precision == "float32"
    assert found[-1].method == "perpendicular"
    assert found[-1].suffices


def test_rays_that_touch_a_sphere_exactly_are_asked_of_no_precision() -> None:
    # four pixels lie on the silhouette so closely that float64 too gets them wrong with the lecture's formula
    scene = rung("ambient-diffuse").scene()
    true = certify(scene)
    (trial,) = tried(scene)
    assert (true.bits > certified.BALL_BITS).sum() == 4
    assert trial.suffices
