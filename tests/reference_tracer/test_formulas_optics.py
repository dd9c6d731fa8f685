"""Reflection, refraction, Fresnel and shading against angles, closed forms and cited values."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference_tracer.formulas.display import encode
from reference_tracer.formulas.optics import face, fresnel, reflect, refract
from reference_tracer.formulas.shading import attenuation, direct_light, lambert, light_vector, phong
from reference_tracer.numbers import TINY_64, power
from reference_tracer.vector import Vec, dot

U = 2.0**-53
UP = Vec(0.0, 1.0, 0.0)
angles = st.floats(0.0, math.pi / 2 - 1e-6)


def at_angle(theta, sign=-1.0):
    """A unit ray at that angle to the y axis, travelling down (sign -1) or up."""
    return Vec(math.sin(theta), sign * math.cos(theta), 0.0)


def test_the_mirror_direction_swaps_sides():
    s = math.sqrt(0.5)
    assert reflect(Vec(s, s, 0.0), UP) == pytest.approx((-s, s, 0.0), abs=2 * U)


@given(theta=angles, phi=st.floats(0, 2 * math.pi))
def test_reflection_keeps_the_angle_the_plane_and_the_length(theta, phi):
    i = Vec(math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi))
    r = reflect(i, UP)
    assert (r.x, r.y, r.z) == pytest.approx((-i.x, i.y, -i.z), abs=9 * U)  # |r - r*| <= 9u


@given(theta=angles, index=st.floats(1.0, 2.5))
def test_entering_rays_obey_snell(theta, index):
    t, total = refract(at_angle(theta), UP, False, index)
    beta = math.asin(math.sin(theta) / index)
    assert not total
    # 2u(1 + 1/c2)(1 + 1/index), the law of the division-free form; asin and sin add a few u
    assert t == pytest.approx(at_angle(beta), abs=16 * U * (1 + 1 / math.cos(beta)))


@pytest.mark.parametrize("degrees", [0.0, 10.0, 30.0, 41.0])
def test_leaving_rays_bend_away_from_the_normal(degrees):
    theta = math.radians(degrees)
    n, leaving = face(at_angle(theta, 1.0), UP)
    t, total = refract(at_angle(theta, 1.0), n, leaving, 1.5)
    assert not total
    beta = math.asin(1.5 * math.sin(theta))
    assert t == pytest.approx(at_angle(beta, 1.0), abs=16 * U * (1 + 1 / math.cos(beta)))  # as on entering


@pytest.mark.parametrize(("index", "beyond"), [(1.5, 1e-9), (1.33, 1e-9), (2.4, 1e-9)])
def test_total_reflection_begins_at_the_critical_angle(index, beyond):
    critical = math.asin(1 / index)
    n = -UP
    assert refract(at_angle(critical + beyond, 1.0), n, True, index)[1]
    assert not refract(at_angle(critical - beyond, 1.0), n, True, index)[1]


def test_a_ray_entering_from_outside_a_denser_body_is_never_totally_reflected():
    assert not refract(at_angle(math.radians(89.9)), UP, False, 1.5)[1]


@pytest.mark.parametrize("v", [Vec(0.0, -1.0, 0.0), Vec(0.0, -1.0, 1e-8)])
def test_normal_incidence_goes_straight_through_and_near_it_nothing_is_lost(v):
    t, _ = refract(v, UP, False, 1.5)
    assert t == pytest.approx((0.0, -1.0, v.z / 1.5), abs=4 * U)


@given(theta=angles)
def test_index_one_is_the_identity(theta):
    v = at_angle(theta)
    t, total = refract(v, UP, False, 1.0)
    assert not total
    assert t == pytest.approx(v, abs=8 * U * (1 + 1 / math.cos(theta)))


def test_the_normal_turns_to_face_the_ray():
    assert face(Vec(0.0, -1.0, 0.0), UP) == (UP, False)
    assert face(Vec(0.0, 1.0, 0.0), UP) == (Vec(-0.0, -1.0, -0.0), True)


@pytest.mark.parametrize(("index", "share"), [(1.5, 0.04), (1.33, (0.33 / 2.33) ** 2), (2.42, (1.42 / 3.42) ** 2)])
def test_fresnel_at_normal_incidence_is_the_squared_contrast(index, share):
    assert fresnel(Vec(0.0, -1.0, 0.0), UP, False, index) == pytest.approx(
        share, abs=32 * U * share
    )  # some ten roundings, doubled by squares


def test_fresnel_at_brewsters_angle_has_only_the_s_half():
    n = 1.5
    theta = math.atan(n)
    assert fresnel(at_angle(theta), UP, False, n) == pytest.approx(
        ((1 - n * n) / (1 + n * n)) ** 2 / 2, rel=512 * U, abs=0.0
    )  # the angle is rounded; F changes by a few times that


def test_fresnel_is_one_under_total_reflection():
    assert fresnel(at_angle(math.radians(60), 1.0), -UP, True, 1.5) == 1.0


@given(theta=st.floats(0.0, 1.5), index=st.floats(1.1, 2.5))
def test_fresnel_is_the_same_in_both_directions(theta, index):
    inside = math.asin(math.sin(theta) / index)
    outward = fresnel(at_angle(theta), UP, False, index)
    inward = fresnel(at_angle(inside, 1.0), -UP, True, index)
    # sin² is off by 18u, so the outer cosine by 9u/cos, of which F changes by at most ten times as much; 38u of F's own
    assert inward == pytest.approx(outward, abs=128 * U / math.cos(theta))


def test_a_light_is_seen_in_its_direction_at_its_distance():
    i, distance = light_vector(Vec(0.0, 5.0, 0.0), Vec(0.0, 2.0, 4.0), True)
    assert i == (0.0, 0.6, -0.8)
    assert distance == 5.0


def test_a_directional_light_is_infinitely_far():
    assert light_vector(Vec(0.0, 3.0, -4.0), Vec(7.0, 7.0, 7.0), False) == ((0.0, 0.6, -0.8), math.inf)


@pytest.mark.parametrize(
    ("inverse", "square", "factor"), [(False, False, 1.0), (True, False, 0.25), (False, True, 0.0625)]
)
def test_attenuation_at_distance_four(inverse, square, factor):
    assert attenuation(4.0, inverse, square) == factor


def test_a_light_behind_the_surface_gives_nothing():
    assert lambert(Vec(0.6, -0.8, 0.0), UP) == 0.0
    assert phong(Vec(0.0, -1.0, 0.0), UP, Vec(0.0, 1.0, 0.0), 10, Vec(0.0, -1.0, 0.0)) == 0.0


def test_the_highlight_peaks_in_the_mirror_direction():
    i = Vec(0.6, 0.8, 0.0)
    r = reflect(i, UP)
    assert phong(i, UP, -r, 100, r) == pytest.approx(1.0, abs=400 * U)


def test_the_highlight_at_sixty_degrees_is_a_half_to_the_s():
    i = Vec(0.0, 1.0, 0.0)
    v = Vec(-math.sin(math.pi / 3), -math.cos(math.pi / 3), 0.0)
    assert phong(i, UP, v, 10, i) == pytest.approx(0.5**10, rel=64 * U, abs=0.0)  # ten times the cosine's own few u


def test_one_lights_share_is_weighted_channel_by_channel():
    share = direct_light(Vec(1.0, 0.5, 0.25), 2.0, Vec(0.5, 0.5, 0.5), 0.5, Vec(0.25, 0.0, 1.0), 0.5)
    assert share == (0.75, 0.25, 0.375)


@given(x=st.floats(0.01, 1.0), n=st.integers(1, 300))
def test_power_is_the_exact_power_within_its_roundings(x, n):
    exact = Fraction(x) ** n
    got = power(x, n)
    rounded = exact * Fraction(2 * n) * Fraction(U)
    if got == 0.0:
        assert exact - rounded <= Fraction(TINY_64)
    else:
        assert abs(Fraction(got) - exact) <= rounded


def test_power_is_the_same_on_floats_and_arrays():
    x = np.random.default_rng(1).random(1000)
    n = np.random.default_rng(2).integers(1, 500, 1000)
    assert [power(float(a), int(b)) for a, b in zip(x, n, strict=True)] == power(x, n).tolist()


@pytest.mark.parametrize(("value", "code"), [(-1.0, 0), (0.0, 0), (0.999, 254), (1.0, 255), (7.0, 255), (0.5, 127)])
def test_the_lectures_encoding_truncates_and_clamps_on_both_sides(value, code):
    assert encode(np.array([value]), "lecture")[0] == code


def test_srgb_is_that_of_colour_science():
    colour = pytest.importorskip("colour", reason="colour-science is not installed (pip install raycheck[peers])")
    values = np.linspace(0.0, 1.0, 4001)
    expected = np.floor(colour.models.eotf_inverse_sRGB(values) * 255 + 0.5)
    assert (encode(values, "srgb") == expected).all()


def test_encoding_never_decreases():
    values = np.linspace(-0.1, 1.1, 9999)
    for display in ("lecture", "srgb"):
        assert (np.diff(encode(values, display, 65535)) >= 0).all()


def test_dot_is_summed_from_left_to_right():
    assert dot(Vec(1e16, 1.0, -1e16), Vec(1.0, 1.0, 1.0)) == (1e16 + 1.0) + -1e16
