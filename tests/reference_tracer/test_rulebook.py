"""What a rulebook says of strays and of highlights is asked alike by the plain tracer, the lanes and the exact one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reference_tracer import plain
from reference_tracer.exact import ExactTracer
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import enclose, render
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import unit
from scenes.catalogue import rung

STRAYS = replace(LECTURE, name="strays", stray=lambda background, generation: background * float(generation))
CAMERA = replace(LECTURE, name="camera", view_vector=lambda v, p, eye: unit(p - eye))


@pytest.mark.parametrize(("rules", "name"), [(STRAYS, "strays"), (CAMERA, "lecture-final"), (CAMERA, "glass-sphere")])
def test_plain_lanes_and_exact_follow_the_same_entry(rules: Rulebook, name: str) -> None:
    scene = rung(name).scene().resized(24, 18)
    ours = render(scene, NumPyBackend(64)).pixels
    changed = plain.render(scene, rules).pixels
    assert np.array_equal(changed, render(scene, NumPyBackend(64), rules).pixels)
    places = np.argwhere(np.abs(changed - ours).max(axis=-1) > 1e-6)
    assert places.size
    j, i = places[len(places) // 2].tolist()
    exact = ExactTracer(scene, rules).pixel(i, j)
    proven = enclose(scene, NumPyBackend(64), 2.0**-52, 0.0, rules).radius[j, i]
    assert np.all(np.abs(np.array(exact.value) - changed[j, i]) <= proven)


def test_rays_of_later_generations_are_told_their_generation() -> None:
    asked: set[int] = set()

    def noted(background, generation):
        asked.add(generation)
        return background

    render(rung("strays").scene().resized(24, 18), NumPyBackend(64), replace(LECTURE, stray=noted))
    assert {0, 1, 2} <= asked
