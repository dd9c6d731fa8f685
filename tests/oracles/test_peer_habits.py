"""Habits of peers: the offset of starts, total reflection; arbitration with and without them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracles.images import Picture
from oracles.peers.arbitration import Party, arbitrate
from oracles.peers.conventions import TotalReflectionTracer
from oracles.peers.explain import FAR, OFFSET, TOTAL_REFLECTION, Habit
from oracles.peers.offset import RAY_EPSILON, OffsetTracer
from reference_tracer.plain import PlainTracer, render
from reference_tracer.vector import Vec
from scenes.catalogue import rung
from scenes.model import Scene

U = 2.0**-53


def pixels_of(scene: Scene, tracer: PlainTracer) -> NDArray[np.float64]:
    values = np.empty((scene.image.height, scene.image.width, 3))
    for j, i in np.ndindex(*values.shape[:2]):
        values[j, i] = tracer.pixel(i, j)
    return values


def picture_of(scene: Scene, tracer: PlainTracer) -> Picture:
    return Picture(pixels_of(scene, tracer).astype(np.float32).astype(np.float64), roundoff=2.0**-24)


def test_a_ray_through_water_lands_beside_by_the_offset_times_the_tangent() -> None:
    """Start moved by m along n: the refracted line shifts by m·tan θ2 along the surface, whatever lies below."""
    scene = rung("refract-plane").scene()
    tracer = OffsetTracer(scene)
    theta = math.asin(math.sin(math.radians(60)) / 1.33)
    p, v = Vec(0.3, 0.0, 2.0), Vec(math.sin(theta), -math.cos(theta), 0.0)
    moved = tracer.moved(p, v, Vec(0.0, 1.0, 0.0))
    assert moved == pytest.approx((0.3, -3.0 * RAY_EPSILON, 2.0), abs=2 * U)
    x = [q.x + (q.y + 5.0) * math.tan(theta) for q in (p, moved)]  # where both meet y = -5
    assert x[0] - x[1] == pytest.approx(3.0 * RAY_EPSILON * math.tan(theta), abs=32 * U)  # of numbers below 8


def test_as_the_offset_shrinks_the_offset_tracer_becomes_the_plain_one() -> None:
    scene = rung("mirror-imperfect").scene().resized(16, 12)
    ours = pixels_of(scene, PlainTracer(scene))
    far, near = (np.abs(pixels_of(scene, OffsetTracer(scene, m)) - ours).max() for m in (2.0**-10, 2.0**-20))
    # A smooth picture: the difference is linear in the offset; twice that for what is of second order
    assert 0.0 < near <= 2.0 * 2.0**-10 * far


def test_where_nothing_is_totally_reflected_that_tracer_is_the_plain_one() -> None:
    scene = rung("glass-sphere").scene().resized(16, 12)
    theirs, ours = (picture_of(scene, t(scene)).values for t in (TotalReflectionTracer, PlainTracer))
    assert np.array_equal(theirs, ours)


@pytest.mark.parametrize(
    ("name", "habit"),
    [
        ("inside-glass", OFFSET),
        ("inside-glass", TOTAL_REFLECTION),
        ("air-bubble", TOTAL_REFLECTION),
        ("far-ball", FAR),
    ],
)
def test_a_habit_explains_its_own_pixels(name: str, habit: Habit) -> None:
    scene = rung(name).scene().resized(48, 36)
    party = Party("peer", "float32", picture_of(scene, habit.tracer(scene)), 1.0, "", (habit,))
    case = arbitrate(scene, [party], "numpy")
    assert case.standings[0].outside > 0
    assert case.unexplained == 0
    assert case.standings[0].reason == habit.reason


def test_a_habit_excuses_nothing_else() -> None:
    scene = rung("inside-glass").scene().resized(48, 36)
    picture = picture_of(scene, OffsetTracer(scene))
    picture.values[3, 4] += 0.01
    case = arbitrate(scene, [Party("peer", "float32", picture, 1.0, "", (OFFSET,))], "numpy")
    assert case.unexplained == 1


def test_of_two_who_differ_the_wrong_one_is_named() -> None:
    scene = rung("point-light").scene().resized(16, 12)
    right = Picture(render(scene).pixels)
    wrong = Picture(right.values.copy())
    wrong.values[5, 7, 1] += 1e-3
    parties = [
        Party("a", "float64", right, 1.0),
        Party("b", "float64", wrong, 2.0),
        Party("c", "float64", None, 0.0, "no"),
    ]
    case = arbitrate(scene, parties, "numpy")
    assert [s.outside for s in case.standings] == [0, 1, 0]
    (pair,) = case.pairs
    assert (pair.at, pair.wrong) == ((7, 5), ("b",))
    assert pair.worst == pytest.approx(1e-3, abs=2 * U)  # added to a number below 1
    assert case.standings[1].at == (7, 5)
    assert case.standings[2].message == "no"
