"""Geometry formulas against hand-computed values and 60-digit decimals."""

import math
from decimal import Decimal, localcontext

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from reference_tracer.formulas.camera import camera_ray, plane_point
from reference_tracer.formulas.plane import plane_hit, plane_normal
from reference_tracer.formulas.sphere import sphere_distances, sphere_hit, sphere_normal
from reference_tracer.vector import Vec, dot, unit

U = 2.0**-53
coordinate = st.floats(-10, 10, allow_subnormal=False)
vectors = st.builds(Vec, coordinate, coordinate, coordinate)


def hit(o, v, c, r, starts_here=False, start=0.0):
    return sphere_hit(sphere_distances, o, v, c, r, starts_here, start)


def test_the_lectures_eye_meets_the_unit_sphere_before_it_at_2_and_4():
    b = Vec(0.0, 0.0, -2.0) - Vec(0.0, 0.0, 1.0)
    assert sphere_distances(b, -3.0, Vec(0.0, 0.0, 1.0), 1.0) == (2.0, 4.0, 1.0)


def test_from_inside_the_far_root_is_the_hit():
    assert hit(Vec(0.0, 0.0, 0.0), Vec(1.0, 0.0, 0.0), Vec(0.0, 0.0, 0.0), 2.0) == (2.0, True)


def test_a_sphere_behind_the_eye_is_not_met():
    assert not hit(Vec(0.0, 0.0, 5.0), Vec(0.0, 0.0, 1.0), Vec(0.0, 0.0, 0.0), 2.0)[1]


def test_a_tangent_ray_is_a_hit():
    distance, meets = hit(Vec(1.0, 0.0, -3.0), Vec(0.0, 0.0, 1.0), Vec(0.0, 0.0, 0.0), 1.0)
    assert (distance, meets) == (3.0, True)


def test_a_ray_that_leaves_its_own_sphere_outward_does_not_meet_it_again():
    assert not hit(Vec(1.0, 0.0, 0.0), Vec(0.6, 0.8, 0.0), Vec(0.0, 0.0, 0.0), 1.0, starts_here=True)[1]


def test_a_ray_that_enters_its_own_sphere_meets_the_far_wall_at_the_chord():
    distance, meets = hit(Vec(1.0, 0.0, 0.0), Vec(-0.6, 0.8, 0.0), Vec(0.0, 0.0, 0.0), 1.0, starts_here=True)
    assert meets
    assert distance == pytest.approx(1.2, abs=4 * U)  # chord 2 r cos


@given(o=vectors, aim=st.tuples(*[st.floats(-0.5, 0.5)] * 3), c=vectors, r=st.floats(0.1, 5))
def test_roots_agree_with_decimals_within_the_error_law(o, aim, c, r):
    w = Vec(*(c[k] + aim[k] * r - o[k] for k in range(3)))  # a ray that passes the centre within 0.87 r
    assume(math.hypot(*w) > 0.01)
    v = unit(w)
    b = o - c
    near, far, D = sphere_distances(b, dot(b, v), v, r)
    with localcontext() as context:
        context.prec = 60
        exact_b = [Decimal(x) - Decimal(y) for x, y in zip(o, c, strict=True)]
        size = sum(Decimal(x) ** 2 for x in w).sqrt()
        exact_v = [Decimal(x) / size for x in w]
        bv = sum(x * y for x, y in zip(exact_b, exact_v, strict=True))
        disc = bv * bv - (sum(x * x for x in exact_b) - Decimal(r) ** 2)
        assume(disc > Decimal(r) ** 2 / 100)  # cos >= 0.1
        assert D > 0
        cos = float(disc.sqrt()) / r
        distance = math.hypot(*b) / r
        # |dt|/r <= 4u(D + D²/cos); the direction's own rounding (3u) moves the hit by at most as much again
        bound = 2 * 4 * U * (1 + distance + distance**2 / cos) * r
        assert abs(float(Decimal(near) - (-bv - disc.sqrt()))) <= bound
        assert abs(float(Decimal(far) - (-bv + disc.sqrt()))) <= bound


def test_the_sphere_normal_points_outward_and_is_unit():
    assert sphere_normal(Vec(1.0, 2.0, 5.0), Vec(1.0, 2.0, 3.0)) == (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("normal", "offset"), [((0.0, 1.0, 0.0), -1.0), ((0.0, 2.5, 0.0), -2.5), ((0.0, -4.0, 0.0), 4.0)]
)
def test_a_plane_is_met_at_the_same_place_whatever_its_normals_length(normal, offset):
    v = Vec(0.0, -0.6, 0.8)
    assert plane_hit(Vec(0.0, 0.5, 0.0), v, Vec(*normal), offset, True, 0.0) == (2.5, True)


def test_a_parallel_ray_never_meets_the_plane():
    assert not plane_hit(Vec(0.0, 0.5, 0.0), Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), -1.0, True, 0.0)[1]


def test_a_ray_that_starts_on_the_plane_does_not_meet_it():
    assert not plane_hit(Vec(0.0, -1.0, 0.0), Vec(0.0, -1.0, 0.0), Vec(0.0, 1.0, 0.0), -1.0, False, 0.0)[1]


def test_the_plane_normal_is_unit():
    assert plane_normal(Vec(0.0, 0.0, -5.0)) == (0.0, 0.0, -1.0)


def test_the_zero_vector_has_no_direction_and_stays_zero():
    assert unit(Vec(0.0, 0.0, 0.0)) == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("i", "j", "X", "Y"), [(0, 0, -1.0, 1.0), (320, 240, 0.0, 0.0), (640, 480, 1.0, -1.0), (160, 120, -0.5, 0.5)]
)
def test_the_image_plane_of_the_slide(i, j, X, Y):
    assert plane_point(i, j, 640.0, 480.0, (0.0, 0.0)) == (X, Y)


def test_the_eye_ray_of_the_slide():
    # The slide's Ray(x, y): X' = X w/h, then unit([X', Y, -1] - (0, 0, -2))
    X, Y = plane_point(100, 50, 640.0, 480.0, (0.0, 0.0))
    x, y = (-1 + 2.0 / 640 * 100) * 640 / 480, -(-1 + 2.0 / 480 * 50)
    expected = [component / math.sqrt(x * x + y * y + 1) for component in (x, y, 1)]
    ray = camera_ray(Vec(0.0, 0.0, 1.0), Vec(640 / 480, 0.0, 0.0), Vec(0.0, 1.0, 0.0), X, Y)
    assert ray == pytest.approx(expected, abs=8 * U)
