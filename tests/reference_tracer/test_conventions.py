"""Other tracers' conventions against closed forms, and every dialect the same in every arithmetic."""

import dataclasses
import math
import random
from fractions import Fraction

import numpy as np
import pytest

from reference_tracer import certified, dialects, llvm, plain
from reference_tracer.dialects import CHOICES, SCENE_MODEL, Dialect
from reference_tracer.formulas import conventions, optics, shading
from reference_tracer.lanes import render as lanes
from reference_tracer.vector import Vec
from scenes.catalogue import ladder, rung

NORMAL = Vec(0.0, 0.0, 1.0)
U = 2.0**-53
INDICES = [1 / 2.4, 1 / 1.5, 0.75, 1.0, 1.33, 1.5, 2.4]
needs_llvm = pytest.mark.skipif(llvm.find() is None, reason=f"no libLLVM that works: {llvm.REMEDY}")


def toward(angle, side=0.0):
    """The unit vector at this angle from the normal."""
    return Vec(math.sin(angle) * math.cos(side), math.sin(angle) * math.sin(side), math.cos(angle))


def arriving(angle):
    return -toward(angle)


# Schlick: F0 head on, 1 at grazing incidence, and close to Fresnel where that is its purpose


@pytest.mark.parametrize("leaving", [False, True])
@pytest.mark.parametrize("index", INDICES)
def test_schlick_head_on_is_fresnel_head_on(index, leaving):
    F0 = float(((Fraction(index) - 1) / (Fraction(index) + 1)) ** 2)
    rounded = 8 * U * F0  # sum, difference and quotient round once each, the square doubles that and rounds
    assert conventions.schlick(arriving(0.0), NORMAL, leaving, index) == pytest.approx(F0, abs=rounded)
    # Fresnel's sums and differences hold products: twice the roundings, and half a sum of two squares
    assert optics.fresnel(arriving(0.0), NORMAL, leaving, index) == pytest.approx(F0, abs=4 * rounded + 8 * U)


@pytest.mark.parametrize("index", [1.33, 1.5, 2.4])
def test_schlick_at_grazing_incidence_is_one(index):
    assert conventions.schlick(arriving(math.pi / 2), NORMAL, False, index) == pytest.approx(
        1.0, abs=8 * U
    )  # the cosine of a rounded right angle takes u from 1, five times in the power; two sums


@pytest.mark.parametrize("angle", np.linspace(0.0, 1.5, 7))
@pytest.mark.parametrize("index", [1.33, 1.5, 2.4])
def test_schlick_follows_his_formula_on_the_thinner_side(index, angle):
    F0 = ((index - 1.0) / (index + 1.0)) ** 2
    expected = F0 + (1.0 - F0) * (1.0 - math.cos(angle)) ** 5
    rounded = 16 * U  # of F0 <= 0.17 eight, of the fifth power four, here and there, and of the sums
    assert conventions.schlick(arriving(angle), NORMAL, False, index) == pytest.approx(expected, abs=rounded)
    inside = math.asin(math.sin(angle) / index)  # the same angle in the air, seen from inside
    # sin² is off by 18u, so the cosine in the air by 9u/cos, of which F changes by at most five times as much
    beyond = rounded + 45 * U / math.cos(angle)
    assert conventions.schlick(arriving(inside), NORMAL, True, index) == pytest.approx(expected, abs=beyond)


@pytest.mark.parametrize("angle", [0.75, 1.0, 1.5])
def test_schlick_is_one_under_total_reflection(angle):
    assert conventions.schlick(arriving(angle), NORMAL, True, 1.5) == 1.0


@pytest.mark.parametrize("seed", range(20))
def test_schlick_is_a_share(seed):
    chance = random.Random(seed)  # noqa: S311 - angles, not secrets
    F = conventions.schlick(arriving(chance.uniform(0, 1.57)), NORMAL, chance.random() < 0.5, chance.choice(INDICES))
    assert 0.0 <= F <= 1.0


# Lobes


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.9, 1.3])
def test_blinn_and_phong_peak_in_the_mirror_direction(angle):
    i = toward(angle)
    mirrored = optics.reflect(i, NORMAL)
    eyes = [toward(angle + d, math.pi) for d in (-0.2, -0.1, 0.0, 0.1, 0.2) if angle + d >= 0.0]
    for lobe in (conventions.blinn_lobe, conventions.phong_lobe):
        values = [lobe(i, NORMAL, -eye, 50, mirrored) for eye in eyes]
        assert max(values) == pytest.approx(1.0, abs=50 * 16 * U)  # the base: 9u of r, 4u of ∘, 3u
        assert max(values) == lobe(i, NORMAL, -toward(angle, math.pi), 50, mirrored)


@pytest.mark.parametrize("off", [0.1, 0.3, 0.6])
def test_off_the_peak_blinns_angle_is_half_of_phongs_in_the_plane_of_incidence(off):
    i, eye = toward(0.4), toward(0.4 + off, math.pi)
    mirrored = optics.reflect(i, NORMAL)
    rounded = 7 * 16 * U  # the base as above
    assert conventions.phong_lobe(i, NORMAL, -eye, 7, mirrored) == pytest.approx(math.cos(off) ** 7, abs=rounded)
    assert conventions.blinn_lobe(i, NORMAL, -eye, 7, mirrored) == pytest.approx(math.cos(off / 2) ** 7, abs=rounded)


def test_a_lobe_in_front_is_dark_for_a_light_behind_and_the_bare_one_is_not():
    i, eye = toward(1.7), toward(1.4, math.pi)
    mirrored = optics.reflect(i, NORMAL)
    for lobe in (conventions.blinn_lobe, conventions.phong_lobe):
        assert conventions.in_front(lobe)(i, NORMAL, -eye, 5, mirrored) == 0.0
        assert lobe(i, NORMAL, -eye, 5, mirrored) > 0.0
    assert shading.phong(i, NORMAL, -eye, 5, mirrored) == 0.0


def test_a_white_surface_over_pi_sends_back_all_light_it_gets():
    # ∫ cosθ/π dω over the hemisphere = 2 ∫ cosθ sinθ dθ = 1, by the midpoint rule
    steps = 2000
    h = math.pi / 2 / steps
    angles = (np.arange(steps) + 0.5) * h
    total = sum(conventions.lambert_over_pi(toward(a), NORMAL) * math.sin(a) for a in angles)
    # The rule's error is (b - a)h²/24·max|f''|, of f = sin 2θ here: 4
    assert total * 2.0 * math.pi * h == pytest.approx(1.0, abs=math.pi / 2 * h * h / 6)


# Mixing, ambient, clamp, sides, shadows


def test_lerp_keeps_what_all_its_parts_are():
    colour, r, t = Vec(0.2, 0.4, 0.8), Vec(0.3, 0.0, 0.5), Vec(0.4, 0.9, 0.5)
    assert conventions.lerp(colour, r, colour, t, colour) == pytest.approx(
        colour, abs=5 * U
    )  # 2u of the own weight, u of the products, 2u of the sums


def test_lerp_of_nothing_else_is_local_and_of_all_else_is_not():
    local, other, none, one = Vec(0.2, 0.4, 0.8), Vec(0.9, 0.1, 0.0), Vec(0.0, 0.0, 0.0), Vec(1.0, 1.0, 1.0)
    assert conventions.lerp(local, none, other, none, other) == local
    assert conventions.lerp(local, one, other, none, local) == other
    assert conventions.lerp(local, none, local, one, other) == other


def test_ambient_per_light_is_the_ambient_times_the_sum_of_the_lights():
    ambient, black = Vec(0.1, 0.2, 0.3), Vec(0.0, 0.0, 0.0)
    lights = [Vec(1.0, 0.5, 0.0), Vec(0.25, 0.25, 2.0)]
    total = conventions.no_ambient(ambient)
    for light in lights:
        total = conventions.add_light_and_ambient(total, black, ambient, light)
    assert total == pytest.approx([0.125, 0.15, 0.6], abs=4 * U)  # two products, two sums


def test_a_colour_is_cut_at_one_and_only_there():
    assert conventions.clamped(Vec(0.5, 1.0, 7.0)) == Vec(0.5, 1.0, 1.0)


def test_the_outward_normal_does_not_turn():
    for v in (arriving(0.3), toward(0.3)):
        facing, leaving = optics.face(v, NORMAL)
        assert conventions.outward_normal(facing, leaving) == NORMAL


def test_only_opaque_surfaces_block():
    assert not conventions.opaque_blocks(1.0, 2.0, False)
    assert conventions.opaque_blocks(1.0, 2.0, True)
    assert not conventions.opaque_blocks(3.0, 2.0, True)


def test_samples_are_at_the_corner_and_at_the_centre():
    assert conventions.at_corner(0.0, 0.0, 4.0, 2.0, (0.3, 0.9)) == (-1.0, 1.0)
    assert conventions.at_centre(0.0, 0.0, 4.0, 2.0, (0.3, 0.9)) == (-0.75, 0.5)


def test_fresnel_shares_the_light_between_the_branches_of_glass_and_leaves_a_mirror_alone():
    r, t = Vec(0.5, 0.5, 0.5), Vec(0.8, 0.8, 0.8)
    kept, passed = dialects.fresnel_on_glass(r, t, False, False, lambda: 0.25)
    assert kept == Vec(0.125, 0.125, 0.125)
    assert passed == pytest.approx([0.6, 0.6, 0.6], abs=2 * U)  # 0.8 and the product
    assert dialects.fresnel_on_glass(r, Vec(0.0, 0.0, 0.0), False, False, lambda: 0.25)[0] == r


def test_total_reflection_moves_the_weight_to_the_mirrored_ray():
    r, t = Vec(0.5, 0.1, 0.0), Vec(0.25, 0.5, 0.75)
    rules = dialects.rules(Dialect(tir="reflect"))
    assert rules.weights(r, t, True, False, lambda: 1.0) == (r + t, Vec(0.0, 0.0, 0.0))
    assert rules.weights(r, t, False, False, lambda: 1.0) == (r, t)


# Whole pictures

ALL = {
    f"{key}={value}": Dialect(**{key: value})
    for key, values in CHOICES.items()
    for value in values
    if value != getattr(SCENE_MODEL, key)
}


def drawn(seed):
    """Every convention by chance."""
    chance = random.Random(seed)  # noqa: S311 - conventions, not secrets
    return Dialect(**{key: chance.choice(values) for key, values in CHOICES.items()})


MIXED = {f"drawn {seed}": drawn(seed) for seed in range(6)}
SCENES = ("lecture-final", "air-bubble", "two-lights", "shadow-glass", "phong-terminator", "plane-both-sides")


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("dialect", ALL | MIXED)
def test_a_dialect_is_the_same_to_the_bit_on_plain_floats_and_numpy(dialect, name):
    scene, rules = rung(name).scene().resized(12, 9), dialects.rules((ALL | MIXED)[dialect])
    expected = plain.render(scene, rules).pixels
    assert (lanes.render(scene, lanes.backend("numpy", 64), rules).pixels == expected).all()


@needs_llvm
@pytest.mark.parametrize("dialect", ALL | MIXED)
def test_a_dialect_is_the_same_to_the_bit_on_drjit(dialect):
    rules = dialects.rules((ALL | MIXED)[dialect])
    for name in ("lecture-final", "two-lights"):
        scene = rung(name).scene().resized(12, 9)
        expected = lanes.render(scene, lanes.backend("numpy", 64), rules).pixels
        assert (lanes.render(scene, lanes.backend("drjit", 64), rules).pixels == expected).all()


@pytest.mark.parametrize("dialect", ALL | MIXED)
def test_the_balls_of_a_dialect_hold_its_exact_values(dialect):
    rules = dialects.rules((ALL | MIXED)[dialect])
    for name in ("lecture-final", "shadow-glass"):
        scene = rung(name).scene().resized(8, 6)
        truth = certified.render_exact(scene, rules)
        found = lanes.enclose(scene, lanes.backend("numpy", 64), 2.0**-53, 0.0, rules)
        assert (np.abs(found.pixels - truth.value) <= found.radius + truth.bound).all()


@pytest.mark.parametrize("dialect", ALL)
def test_a_catalogue_scene_tells_the_dialect_from_the_scene_model(dialect):
    rules = dialects.rules(ALL[dialect])
    lane = lanes.backend("numpy", 64)
    for entry in ladder():
        scene = entry.scene().resized(40, 30)
        if (lanes.render(scene, lane, rules).pixels != lanes.render(scene, lane).pixels).any():
            return
    pytest.fail(f"no scene of the catalogue tells {dialect}")


def test_the_scene_models_dialect_is_the_lectures_rulebook():
    assert dialects.rules(SCENE_MODEL) is dialects.LECTURE


@pytest.mark.parametrize("dialect", ALL)
def test_a_dialect_leaves_geometry_and_snell_alone(dialect):
    rules = dialects.rules(ALL[dialect])
    kept = {"camera_ray", "sphere_distances", "sphere_hit", "plane_hit", "nearer", "sphere_normal", "plane_normal"}
    kept |= {"face", "reflect", "mirror", "refract", "light_vector", "attenuation"}
    assert all(getattr(rules, name) is getattr(dialects.LECTURE, name) for name in kept)
    assert kept < {field.name for field in dataclasses.fields(rules)}
