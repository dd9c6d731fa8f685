"""Shrinking: what is left still fails, is smaller, was not made harder, and the search ends."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from oracles.compare import compare
from oracles.faults import TWINS, fault
from oracles.faults.files import linear
from oracles.faults.power import Bench, picture
from oracles.images import Picture
from oracles.shrinking import Limits, Pixel, Step, shrink, size, words
from oracles.shrinking.arrangement import gap, sides
from oracles.shrinking.edits import crops
from oracles.truth import truth
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from scenes.catalogue import ladder, rung
from scenes.generator import GAP
from scenes.model import Scene, Sphere
from scenes.random_scenes import random_scene

FREELY = Limits(2000, 1e9)
FAULTS = (
    "upside-down",
    "far-root",
    "exponent-plus-1",
    "mirrored-by-2n-minus-i",
    "normal-not-unit",
    "aspect-left-out",
    "hits-behind-the-eye",
    "no-attenuation",
)


def clearly_wrong(found: Picture, scene: Scene) -> Pixel | None:
    """A pixel that is outside its bound and in no doubt."""
    expected = truth(scene, "float32")
    j, i = np.nonzero(compare(found, expected).outside & (expected.doubts == 0))
    return (int(i[0]), int(j[0])) if i.size else None


def killer(name: str) -> Scene:
    """The first scene of the ladder that fails the fault."""
    for entry in ladder():
        scene = entry.scene().resized(48, 36)
        if Bench(scene).kill(fault(name)):
            return scene
    raise AssertionError(f"{name} is never noticed")


def last(steps: Any) -> Step:
    *_, final = steps
    assert isinstance(final, Step)
    return final


@pytest.mark.parametrize("name", FAULTS)
def test_what_is_left_of_a_scene_fails_the_fault_and_no_correct_tracer(name: str) -> None:
    scene = killer(name)

    def fails(candidate: Scene) -> Pixel | None:
        return clearly_wrong(picture(candidate, fault(name)), candidate)

    final = last(shrink(scene, fails, FREELY))
    assert final.least
    assert fails(final.scene) == final.pixel
    right = linear(render(final.scene, NumPyBackend(32)).pixels)
    assert compare(right, truth(final.scene, "float32")).judged.outside == 0
    bench = Bench(final.scene)
    assert [twin.name for twin in TWINS if bench.wrongly_killed(twin)] == []
    assert size(final.scene) < size(scene)
    assert final.scene.features <= scene.features
    assert last(shrink(scene, fails, FREELY)) == final


def test_a_scene_that_does_not_fail_gives_nothing() -> None:
    assert list(shrink(rung("background").scene(), lambda _: None, FREELY)) == []


def test_where_everything_fails_nothing_is_left() -> None:
    final = last(shrink(rung("lecture-final").scene(), lambda _: (0, 0), FREELY))
    assert final.least
    assert size(final.scene)[:4] == (0, 0, 0, 1)
    assert words(final.scene) == "nothing, depth 0, 1 pixel"
    assert final.tries < 60


def test_everything_that_the_failure_needs_stays() -> None:
    scene = rung("lecture-final").scene()
    needed = (len(scene.objects) - 1, scene.depth, len(scene.lights))

    def fails(candidate: Scene) -> Pixel | None:
        enough = len(candidate.objects) >= needed[0] and candidate.depth >= needed[1]
        return (0, 0) if enough and len(candidate.lights) == needed[2] and candidate.image.width > 3 else None

    final = last(shrink(scene, fails, FREELY)).scene
    assert (len(final.objects), final.depth, len(final.lights)) == needed
    assert (final.image.width, final.image.height) == (4, 3)


def test_numbers_become_as_round_as_the_failure_allows() -> None:
    def fails(candidate: Scene) -> Pixel | None:
        balls = [thing for thing in candidate.objects if isinstance(thing, Sphere)]
        return (0, 0) if balls and 0.3 < balls[0].radius < 0.55 and balls[0].center[0] < -0.7 else None

    scene = rung("headlight-sphere").scene()
    (ball,) = scene.objects
    assert isinstance(ball, Sphere)
    odd = ball.model_copy(update={"radius": 0.43219, "center": (-1.34567, 0.1, 1.00001)})
    final = last(shrink(scene.model_copy(update={"objects": (odd,)}), fails, FREELY)).scene
    assert isinstance(final.objects[0], Sphere)
    assert final.objects[0].radius == 0.5
    assert all(x.is_integer() for x in final.objects[0].center)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000))
def test_every_step_is_smaller_than_the_one_before_and_no_more_crowded(seed: int) -> None:
    scene = random_scene(seed)

    def fails(candidate: Scene) -> Pixel | None:
        return (
            (seed % candidate.image.width, 0) if int(candidate.content_hash(), 16) % 3 or candidate is scene else None
        )

    steps = list(shrink(scene, fails, Limits(150, 1e9)))
    floor = min(gap(scene), GAP)
    for before, after in pairwise(steps):
        assert size(after.scene) < size(before.scene) or (after.least and after.scene == before.scene)
        assert gap(after.scene) >= floor
        assert after.scene.features <= scene.features
        Scene.model_validate(after.scene.model_dump())
        things = [(len(s.objects), len(s.lights)) for s in (before.scene, after.scene)]
        if things[0] == things[1]:
            assert sides(after.scene) == sides(before.scene)


@pytest.mark.parametrize("seed", range(5))
def test_a_failure_by_chance_ends_the_search_too(seed: int) -> None:
    chance = random.Random(seed).random  # noqa: S311, no secret
    calls = 0

    def fails(_: Scene) -> Pixel | None:
        nonlocal calls
        calls += 1
        return (0, 0) if calls == 1 or chance() < 0.5 else None

    assert list(shrink(rung("lecture-final").scene(), fails, FREELY))
    assert calls < FREELY.tries


@pytest.mark.parametrize("tries", [1, 2, 7])
def test_no_more_scenes_are_tried_than_the_limit_says(tries: int) -> None:
    calls = 0

    def fails(_: Scene) -> Pixel | None:
        nonlocal calls
        calls += 1
        return (0, 0)

    steps = list(shrink(rung("lecture-final").scene(), fails, replace(FREELY, tries=tries)))
    assert calls == tries
    assert not steps[-1].least


def test_time_ends_the_search_after_the_try_under_way() -> None:
    now = 0.0

    def fails(_: Scene) -> Pixel | None:
        nonlocal now
        now += 1.0
        return (0, 0)

    final = last(shrink(rung("lecture-final").scene(), fails, Limits(1000, 3.5, lambda: now)))
    assert final.tries == 4
    assert not final.least


def test_a_window_of_a_picture_shows_the_same_pixels() -> None:
    scene = rung("lecture-final").scene().resized(40, 30)
    whole = render(scene, NumPyBackend(64)).pixels
    for edit in crops(scene)[:6]:
        part = edit(scene, (17, 21))
        assert part is not None
        width, height = part.image.width, part.image.height
        i0, j0 = 17 - width // 2, 21 - height // 2
        window = linear(whole[j0 : j0 + height, i0 : i0 + width], 0.0)
        assert compare(window, truth(part, "float32")).judged.outside == 0


def test_a_window_at_the_edge_stays_inside() -> None:
    scene = rung("lecture-final").scene().resized(40, 30)
    whole = render(scene, NumPyBackend(64)).pixels
    part = crops(scene)[4](scene, (39, 29))
    assert part is not None
    window = linear(whole[-3:, -4:], 0.0)
    assert compare(window, truth(part, "float32")).judged.outside == 0


def test_the_eye_stays_outside_what_it_was_outside_of() -> None:
    scene = rung("headlight-sphere").scene()

    def fails(candidate: Scene) -> Pixel | None:
        return (0, 0) if len(candidate.objects) == 1 else None

    before, after = scene, last(shrink(scene, fails, FREELY)).scene
    assert sides(before)[0] == sides(after)[0] == 1
    assert gap(after) >= min(gap(before), GAP)


def test_what_is_left_is_said_in_words() -> None:
    assert words(rung("lecture-final").scene().resized(8, 6)).endswith("8x6 pixels")
    assert words(rung("headlight-sphere").scene().resized(1, 1)) == "1 sphere, 1 light, depth 0, 1 pixel"
