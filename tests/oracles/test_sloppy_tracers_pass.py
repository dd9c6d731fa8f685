"""A tracer that errs by up to u in every operation is never failed, and bounds with a term taken out do fail it."""

import random

import numpy as np
import pytest

from oracles.compare import compare
from oracles.images import Picture
from oracles.truth import truth
from reference_tracer import dialects
from reference_tracer.dialects import CHOICES, Dialect
from reference_tracer.lanes import sloppy
from reference_tracer.lanes.affine import Affine
from reference_tracer.lanes.ball import Ball, Precision
from reference_tracer.lanes.balls import Balls
from reference_tracer.lanes.render import backend, enclose, narrow, render
from reference_tracer.rulebook import LECTURE
from scenes.catalogue import ladder, rung
from scenes.random_scenes import random_scene

SINGLE = 2.0**-24
DEEP = ("lecture-final", "air-bubble", "glass-sphere", "reflect-and-refract", "invisible-sphere", "strays")


def failures(scene, seeds, rules=LECTURE):
    against = truth(scene, "float32", rules=rules)
    return [
        seed
        for seed in seeds
        if compare(Picture(sloppy.render(scene, SINGLE, seed, rules).pixels), against).judged.outside > 0
    ]


@pytest.mark.parametrize("name", [entry.name for entry in ladder()])
def test_a_sloppy_tracer_passes_every_catalogue_scene(name):
    assert failures(rung(name).scene().resized(40, 30), range(2)) == []


@pytest.mark.parametrize("name", DEEP)
def test_sloppy_tracers_pass_deep_scenes_again_and_again(name):
    assert failures(rung(name).scene().resized(80, 60), range(10, 16)) == []


def some_dialect(seed):
    """Every convention drawn by chance."""
    chance = random.Random(seed)  # noqa: S311 - scenes, not secrets
    return dialects.rules(Dialect(**{key: chance.choice(choices) for key, choices in CHOICES.items()}))


@pytest.mark.parametrize("seed", range(1000, 1030))
def test_sloppy_tracers_pass_random_scenes_in_random_dialects(seed):
    assert failures(random_scene(seed), range(2), some_dialect(seed)) == []


@pytest.mark.parametrize("name", DEEP)
def test_a_tracer_without_errors_is_the_float64_lanes_bit_for_bit(name):
    scene = rung(name).scene().resized(20, 15)
    assert (sloppy.render(scene, 0.0, 0).pixels == render(scene, backend("numpy", 64)).pixels).all()


def test_a_tracer_far_sloppier_than_it_says_is_seen():
    # Worst-case bounds leave room below 20 times
    scene = rung("headlight-plane").scene().resized(40, 30)
    got = sloppy.render(scene, 20.0 * SINGLE, 0).pixels
    assert compare(Picture(got), truth(scene, "float32")).word == "fail"


@pytest.mark.parametrize("kind", [Ball, Affine])
def test_bounds_without_the_tracers_rounding_fail_sloppy_tracers(monkeypatch, kind):
    class Careless(Balls):
        def __init__(self, u, *rest, **named):
            super().__init__(u, *rest, **named)
            self.precision = Precision(0.0, 0.0)

    monkeypatch.setattr("reference_tracer.lanes.render.Balls", Careless)
    scene = rung("two-lights").scene().resized(20, 15)
    found = enclose(scene, backend("numpy", 64), 2.0 * SINGLE, 0.0)
    if kind is Affine:
        monkeypatch.setattr("reference_tracer.lanes.render.WIDE", -1.0)
        found = narrow(scene, found, 2.0 * SINGLE, 0.0)
    got = sloppy.render(scene, SINGLE, 0).pixels
    assert (np.abs(got - found.pixels) > found.radius).any()
