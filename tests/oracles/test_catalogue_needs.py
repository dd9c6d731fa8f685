"""No scene of the catalogue asks for more model than it needs, unless that is what it is there for."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest

from oracles.needs import needs
from reference_tracer import certified
from reference_tracer.lanes.numpy_backend import NumPyBackend
from scenes.catalogue import Needs, ladder, rung

NAMES = [entry.name for entry in ladder()]
HEIGHT = {"mirror-chain": 60}
"""Pixels; the fourth mirror in mirrors is too small for the others' 24."""


def needs_of(name: str) -> Needs:
    found = rung(name).needs
    assert found is not None
    return found


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_needs_what_its_rung_says(name: str) -> None:
    scene = rung(name).scene()
    height = HEIGHT.get(name, 24)
    scene = scene.resized(height * scene.image.width // scene.image.height, height)
    certify = partial(certified.render, backend=NumPyBackend(64))
    found = needs(scene, certify, np.ones((height, scene.image.width, 3)))
    assert (found.model.features, found.model.depth) == (needs_of(name).features, needs_of(name).depth)


@pytest.mark.parametrize("name", NAMES)
def test_a_scene_that_asks_for_more_says_why(name: str) -> None:
    scene, least = rung(name).scene(), needs_of(name)
    assert least.features <= scene.features
    assert least.depth <= scene.depth
    assert bool(least.beyond) == ((least.features, least.depth) != (scene.features, scene.depth))
