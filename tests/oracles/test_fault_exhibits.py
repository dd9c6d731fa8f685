"""The picture pair of a fault: right is right, wrong is wrong, and the scene shows it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from oracles.faults import fault
from oracles.faults.exhibits import clearest, exhibit
from oracles.faults.files import linear
from oracles.faults.power import Bench, Kill, kills
from reference_tracer.formulas.display import encode
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from scenes.catalogue import rung

NAMES = ("background", "headlight-plane", "depth-order", "phong-10")


@pytest.fixture(scope="module")
def benches() -> list[Bench]:
    return [Bench(rung(name).scene().resized(48, 36)) for name in NAMES]


def test_the_pair_shows_the_reference_and_the_fault() -> None:
    scene = rung("phong-10").scene().resized(48, 36)
    shown = exhibit(scene, fault("no-highlight"))
    right = encode(render(scene, NumPyBackend(64)).pixels, scene.display)
    assert (shown.right == right).all()
    assert shown.right.max() > shown.wrong.max()
    assert shown.finite
    outside = np.count_nonzero(np.any(shown.difference != 0, axis=-1))
    assert 0 < shown.outside <= outside


def test_a_picture_without_numbers_is_shown_black_and_said_to_be_none() -> None:
    scene = rung("phong-10").scene().resized(12, 9)

    def holed(pixels: np.ndarray[tuple[int, ...], np.dtype[np.float64]], _: object) -> object:
        values = np.array(pixels)
        values[4, 3] = np.nan
        return linear(values)

    shown = exhibit(scene, replace(fault("upside-down"), picture=holed))
    assert not shown.finite
    assert shown.outside == 1
    assert (shown.wrong[4, 3] == 0).all()


def test_codes_are_shown_as_they_are() -> None:
    scene = rung("phong-10").scene().resized(48, 36)
    shown = exhibit(scene, fault("byte-rounded"))
    assert np.abs(shown.wrong - shown.right).max() == 1


def test_the_scene_that_is_shown_notices_the_fault_and_has_something_to_see(benches: list[Bench]) -> None:
    entry = fault("aspect-left-out")
    noticed = list(kills(benches, entry))
    assert [kill.scene for kill in noticed] == list(NAMES[1:])
    assert clearest(benches, entry, noticed) == "depth-order"


def test_a_blank_picture_is_shown_only_where_nothing_else_is() -> None:
    entry = fault("sign-of-b")
    there = [Bench(rung(name).scene().resized(48, 36)) for name in ("depth-order", "sphere-behind-eye")]
    noticed = list(kills(there, entry))
    assert clearest(there, entry, noticed) == "sphere-behind-eye"
    assert clearest(there, entry, noticed[:1]) == "depth-order"


def test_what_no_scene_notices_is_not_shown(benches: list[Bench]) -> None:
    assert clearest(benches, fault("infinity-is-1e10"), []) is None


def test_only_scenes_that_notice_it_are_considered(benches: list[Bench]) -> None:
    assert clearest(benches, fault("upside-down"), [Kill("phong-10", 3, 1.0)]) == "phong-10"
