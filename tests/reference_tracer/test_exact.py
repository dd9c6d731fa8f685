"""Exact pixels: another algebra agrees with them, ties are told, and every ball contains them."""

import dataclasses

import numpy as np
import pytest
from flint import arb, ctx

from reference_tracer import certified, exact, llvm
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.ball import UNDERFLOW_64, Ball, Precision
from reference_tracer.numbers import at_least, less, select, sqrt0
from reference_tracer.rulebook import LECTURE
from reference_tracer.vector import dot
from scenes.catalogue import ladder, rung
from scenes.json_form import from_data

NAMES = [entry.name for entry in ladder()]
needs_llvm = pytest.mark.skipif(llvm.find() is None, reason=f"no libLLVM that works: {llvm.REMEDY}")
BACKENDS = ["numpy", pytest.param("drjit", marks=needs_llvm)]


def perpendicular(b, bv, v, r):
    """The sphere by the residual of the foot point: D = r² - |b - (b∘v)v|²."""
    foot = b - v * bv
    D = r * r - dot(foot, foot)
    root = sqrt0(D)
    return -bv - root, -bv + root, D


def vector_form(v, n, leaving, index):
    """Snell as t = ηv + (η cosθ1 - cosθ2)n."""
    eta = select(leaving, index, 1.0 / index)
    c1 = -dot(v, n)
    k = 1.0 - eta * eta * (1.0 - c1 * c1)
    return v * eta + n * (eta * c1 - sqrt0(k)), less(k, 0.0)


OTHER_ALGEBRA = dataclasses.replace(LECTURE, sphere_distances=perpendicular, refract=vector_form)


def tiny(objects, materials=("red", "green"), forward=(0, 0, 1)):
    """A 2x2 scene whose pixel (1, 1) looks along `forward` from the origin."""
    colours = {"red": [1, 0, 0], "green": [0, 1, 0]}
    black = {"diffuse": [0, 0, 0], "specular": [0, 0, 0], "shininess": 1, "reflect": [0, 0, 0], "transmit": [0, 0, 0]}
    return from_data(
        {
            "raycheck": 1,
            "name": "tiny",
            "source": "",
            "image": {"width": 2, "height": 2, "sample": [0, 0]},
            "camera": {"eye": [0, 0, 0], "forward": list(forward), "right": [0, 0, 1], "up": [1, -0.75, 0]},
            "background": [0, 0, 1],
            "depth": 0,
            "shadows": False,
            "display": "lecture",
            "materials": {name: {"ambient": colours[name], "index": 1, **black} for name in materials},
            "objects": objects,
            "lights": [],
        }
    )


@pytest.mark.parametrize("name", NAMES)
def test_another_algebraic_form_gives_overlapping_enclosures(name):
    scene = rung(name).scene().resized(12, 9)
    one, other = certified.render_exact(scene), certified.render_exact(scene, OTHER_ALGEBRA)
    assert one.decided.all()
    assert other.decided.all()
    assert (np.abs(one.value - other.value) <= one.bound + other.bound).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("backend", BACKENDS)
def test_the_balls_of_float64_contain_the_exact_value_of_every_pixel(name, backend):
    scene = rung(name).scene().resized(20, 15)
    truth = certified.render_exact(scene)
    found = lanes.enclose(scene, lanes.backend(backend, 64), 2.0**-53, 0.0)
    assert (np.abs(found.pixels - truth.value) <= found.radius + truth.bound).all()


def test_a_certified_picture_takes_the_pixels_in_doubt_from_exact():
    scene = rung("lecture-final").scene().resized(80, 60)
    lane = lanes.backend("numpy", 64)
    doubts = lanes.enclose(scene, lane, 2.0**-53, 0.0).doubts != 0
    found = certified.render(scene, lane)
    assert doubts.any()
    assert (found.bits[doubts] >= exact.START_BITS).all()
    assert (found.bits[~doubts] == certified.BALL_BITS).all()
    assert found.decided.all()
    truth = certified.render_exact(scene)
    assert (np.abs(found.value - truth.value) <= found.bound + truth.bound).all()


def test_an_exactly_tangent_eye_ray_is_decided_and_hits():
    # Ray (3, 4, 0) and the sphere at (5, 8.75, 0) of radius 1.25: (b∘w)² = (w∘w)(b∘b - r²) = 2500
    scene = tiny([{"shape": "sphere", "center": [5, 8.75, 0], "radius": 1.25, "material": "green"}], forward=(3, 4, 0))
    pixel = exact.ExactTracer(scene).pixel(1, 1)
    assert pixel.value == (0.0, 1.0, 0.0)
    assert pixel.decided


@pytest.mark.parametrize(("radius", "colour"), [(1.2500000001, (0.0, 1.0, 0.0)), (1.2499999999, (0.0, 0.0, 1.0))])
def test_beside_the_tangent_hit_and_miss_are_told_apart(radius, colour):
    scene = tiny(
        [{"shape": "sphere", "center": [5, 8.75, 0], "radius": radius, "material": "green"}], forward=(3, 4, 0)
    )
    assert exact.ExactTracer(scene).pixel(1, 1).value == colour


def test_a_tie_that_no_precision_resolves_is_the_hull_of_both_branches():
    # Two spheres touch at (3, 4, 0)/5 from either side, seen through that point: distances 5 and 5, never apart
    spheres = [
        {"shape": "sphere", "center": [6, 8, 0], "radius": 5, "material": "red"},
        {"shape": "sphere", "center": [0, 0, 0], "radius": 5, "material": "green"},
    ]
    pixel = exact.ExactTracer(tiny(spheres, forward=(3, 4, 0))).pixel(1, 1)
    if pixel.decided:  # the balls proved the distances equal: then the earlier object wins
        assert pixel.value == (1.0, 0.0, 0.0)
    else:
        assert pixel.value == (0.5, 0.5, 0.0)
        assert pixel.bound[2] == 0.0
        # arb's radii have 30 bits and are rounded up, here twice
        assert all(0.5 <= bound <= 0.5 * (1 + 2.0**-27) for bound in pixel.bound[:2])


def test_undecided_comparisons_stop_the_pixel():
    ctx.prec = 53
    with pytest.raises(exact.UndecidedError):
        less(arb(0, 0.1), arb(0.05))


@pytest.mark.parametrize(("a", "b", "smaller"), [(1, 2, True), (2, 1, False), (2, 2, False)])
def test_decided_comparisons_are_plain_bools(a, b, smaller):
    assert less(arb(a), arb(b)) is smaller
    assert at_least(arb(a), arb(b)) is not smaller


def test_all_combinations_of_branches_are_visited_once():
    decisions = exact.Decisions()
    decisions.script = []
    seen = []
    while True:
        first = decisions.ask()
        seen.append((first, decisions.ask() if first else None))
        if not decisions.next_script():
            break
    assert seen == [(False, None), (True, False), (True, True)]


def test_the_precision_of_the_caller_is_left_as_it_was():
    ctx.prec = 77
    exact.ExactTracer(rung("headlight-plane").scene()).pixel(3, 3)
    assert ctx.prec == 77
    ctx.prec = 53


DOUBLE = Precision(2.0**-53, UNDERFLOW_64)


def test_the_widening_constant_is_as_small_as_it_may_be():
    # 1 + 2^-53 rounds to 1 with an error of exactly u·1: u suffices, and nothing below u does
    u = 2.0**-53
    total = Ball(np.array([1.0]), np.array([0.0]), DOUBLE) + Ball(np.array([u]), np.array([0.0]), DOUBLE)
    assert total.mid[0] == 1.0
    assert u <= total.rad[0] <= u * (1 + 2.0**-40)
    smaller = Precision(0.999 * u, UNDERFLOW_64)
    lost = Ball(np.array([1.0]), np.array([0.0]), smaller) + Ball(np.array([u]), np.array([0.0]), smaller)
    assert lost.rad[0] < u


@pytest.mark.parametrize("backend", BACKENDS)
def test_underflow_and_flush_to_zero_are_inside_the_ball(backend):
    lane = lanes.backend(backend, 64)
    table = lane.packets([(1e-170, 1e-170, 1.0, 1.0)] * 32)
    x, y, *_ = lane.packet(table, lane.indices(0, 32))
    product = Ball(x, x - x, DOUBLE) * Ball(y, y - y, DOUBLE)
    assert (lane.numpy(product.mid) == 0.0).all()
    assert (lane.numpy(product.rad) > 0.0).all()  # the exact product is 1e-340


def test_an_exact_zero_stays_exact():
    nothing, something = Ball(np.zeros(1), np.zeros(1), DOUBLE), Ball(np.ones(1), np.full(1, 0.1), DOUBLE)
    assert (nothing * something).rad[0] == 0.0
    assert (nothing / something).rad[0] == 0.0
