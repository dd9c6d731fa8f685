"""Methods against exact truth: each keeps its error law, and fails where it is said to fail."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from oracles.stability import truth
from reference_tracer import exact, llvm, plain
from reference_tracer.lanes import render as lanes
from reference_tracer.lanes.ball import Ball, Precision
from reference_tracer.methods import REFRACT, SPHERE, pairs
from reference_tracer.methods.double_word import DoubleWord
from reference_tracer.numbers import sqrt0
from reference_tracer.vector import Vec
from scenes.catalogue import rung

needs_llvm = pytest.mark.skipif(llvm.find() is None, reason=f"no libLLVM that works: {llvm.REMEDY}")
BACKENDS = ["numpy", pytest.param("drjit", marks=needs_llvm)]
METHODS = {**SPHERE, **REFRACT}
QUADRATIC = ("lecture", "geometric")
SCENES = ("lecture-final", "air-bubble", "shadow-hard")
U = {np.float32: 2.0**-24, np.float64: 2.0**-53}


def bits(image):
    return image.pixels.view(np.uint64)


def met(method, o, v, c, r):
    """λ of the nearest hit, NaN for a miss, on lanes of the inputs' type."""
    rules = SPHERE[method]
    with np.errstate(all="ignore"):
        away = np.zeros(len(r), dtype=bool)
        distance, meets = rules.sphere_hit(rules.sphere_distances, Vec(*o.T), Vec(*v.T), Vec(*c.T), r, away, 0.0)
    return np.where(meets, distance, np.nan)


def one(method, dtype, o, v, c=(0, 0, 0), r=1.0):
    row = [np.array([part], dtype=dtype) for part in (o, v, c)]
    return float(met(method, *row, np.array([r], dtype=dtype))[0])


def towards(rng, n, D, s, dtype):
    """Random rays from D radii off, passing the centre at s radii (both (n,)), unit but for rounding."""
    a, b = (w / np.linalg.norm(w, axis=1)[:, None] for w in rng.standard_normal((2, n, 3)))
    across = np.cross(a, b)
    across /= np.linalg.norm(across, axis=1)[:, None]
    sine = (s / D)[:, None]
    v = -a * np.sqrt(1 - sine * sine) + across * sine
    return (a * D[:, None]).astype(dtype), v.astype(dtype), np.zeros((n, 3), dtype), np.ones(n, dtype)


LAW = {  # |Δλ|/r in units of u; the direction's own rounding adds up to D(1 + s/cos) more
    "lecture": lambda D, s, cos: 4 * (D + D * D / cos),
    "geometric": lambda D, s, cos: 4 * (D + D * D / cos),
    "perpendicular": lambda D, s, cos: 4 * D * (1 + s / cos),
    "haines": lambda D, s, cos: 4 * D * (1 + s / cos),
    "compensated": lambda D, s, cos: 4 * D * (1 + s / cos),
    "wide": lambda D, s, cos: 4 * D * (1 + s / cos),
    "double-word": lambda D, s, cos: D,
}


@pytest.mark.parametrize("method", SPHERE)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("exponent", [0.5, 1, 2, 3])
def test_each_method_keeps_its_error_law(method, dtype, exponent):
    rng = np.random.default_rng(7)
    D, s = np.full(400, 10.0**exponent), rng.uniform(0, 0.9, 400)
    o, v, c, r = towards(rng, 400, D, s, dtype)
    error = truth.distances(o, v, c, r).error(met(method, o, v, c, r))
    law = U[dtype] * LAW[method](D, s, np.sqrt(1 - s * s))
    decided = law < 0.1  # beyond, the quadratic methods of float32 miss the sphere
    assert (error[decided] <= law[decided]).all()


@pytest.mark.parametrize(("method", "fails"), [(name, name in QUADRATIC) for name in SPHERE])
def test_far_away_the_quadratic_methods_alone_decide_wrongly(method, fails):
    rng = np.random.default_rng(1)
    s = np.where(rng.random(400) < 0.5, 0.9, 1.1)
    rays = towards(rng, 400, np.full(400, 1e8), s, np.float64)
    wrong = np.isnan(met(method, *rays)) != np.isnan(truth.distances(*rays).value)
    assert wrong.any() == fails


@pytest.mark.parametrize(
    ("method", "good"),
    [(name, name in ("compensated", "double-word")) for name in SPHERE if name != "wide"] + [("wide", True)],
)
def test_just_above_the_surface_only_an_accurate_power_of_the_point_helps(method, good):
    rng = np.random.default_rng(2)
    n, h = 300, 1e-4
    a = rng.standard_normal((n, 3))
    a /= np.linalg.norm(a, axis=1)[:, None]
    o, v = (a * (1 + h)).astype(np.float32), (-a).astype(np.float32)
    c, r = np.zeros((n, 3), np.float32), np.ones(n, np.float32)
    exact_ = truth.distances(o, v, c, r)
    relative = exact_.error(met(method, o, v, c, r)) / exact_.value / U[np.float32]
    assert (relative.max() <= 4) == good  # the others lose u/h: thousands of units


@pytest.mark.parametrize("method", SPHERE)
def test_no_method_minds_where_the_worlds_origin_is(method):
    rng = np.random.default_rng(3)
    o, v, c, r = towards(rng, 200, np.full(200, 10.0), rng.uniform(0, 0.9, 200), np.float32)
    c = (c + 1e6 * np.array([0.6, 0.48, 0.64])).astype(np.float32)
    o = o + c  # rounded; truth takes what came of it
    b = o.astype(np.float64) - c
    D = np.linalg.norm(b, axis=1)
    s = np.linalg.norm(np.cross(b, v), axis=1)
    fine = s < 0.95
    law = U[np.float32] * LAW[method](D, s, np.sqrt(np.maximum(1 - s * s, 0.05)))
    error = truth.distances(o, v, c, r).error(met(method, o, v, c, r))
    assert (error[fine] <= law[fine]).all()


@pytest.mark.parametrize(
    ("method", "o", "dtype", "expected"),
    [
        ("lecture", (0.5, 0, -5000), np.float32, 5000),
        ("geometric", (0.5, 0, -5000), np.float32, 4999),
        ("lecture", (0.5, 0, -1e8), np.float64, 1e8),
        ("geometric", (0.5, 0, -1e8), np.float64, 99999999),
        ("haines", (0, 1, 0), np.float32, None),
    ],
)
def test_the_known_failures_are_reproduced(method, o, dtype, expected):
    if expected is None:  # a huge floor under the eye, seen straight down: no method dominates
        got = one(method, dtype, o, (0, -1, 0), (0, -1e6, 0), 1e6)
        assert got == pytest.approx(1.0158, abs=0.5 * 10.0**-4)  # as it was found, to four decimals
        assert one("lecture", dtype, o, (0, -1, 0), (0, -1e6, 0), 1e6) == 1.0
        assert one("compensated", dtype, o, (0, -1, 0), (0, -1e6, 0), 1e6) == 1.0
    else:
        assert one(method, dtype, o, (0, 0, 1)) == expected
        assert one("compensated", dtype, o, (0, 0, 1)) == pytest.approx(
            -o[2] - math.sqrt(0.75), rel=2 * U[dtype], abs=0.0
        )


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("scene", SCENES)
def test_every_method_has_the_same_bits_plain_and_on_lanes(name, backend, scene):
    picture = rung(scene).scene().resized(24, 18)
    expected = plain.render(picture, METHODS[name])
    assert (bits(lanes.render(picture, lanes.backend(backend, 64), METHODS[name])) == bits(expected)).all()


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("backend", BACKENDS)
@pytest.mark.parametrize("scene", SCENES)
def test_balls_of_every_method_hold_its_float32_and_float64_pictures(name, backend, scene):
    picture = rung(scene).scene().resized(40, 30)
    lane = lanes.backend(backend, 64)
    found = lanes.enclose(picture, lane, 2.0**-24, 0.0, METHODS[name])
    for bits_ in (32, 64):
        got = lanes.render(picture, lanes.backend(backend, bits_), METHODS[name]).pixels.astype(np.float64)
        assert (np.abs(got - found.pixels) <= found.radius).all()


@pytest.mark.parametrize("name", METHODS)
@pytest.mark.parametrize("scene", SCENES)
def test_every_method_agrees_with_the_lecture_in_exact_numbers(name, scene):
    picture = rung(scene).scene().resized(16, 12)
    own, lecture = exact.ExactTracer(picture, METHODS[name]), exact.ExactTracer(picture)
    for i, j in ((3, 4), (5, 8), (11, 7), (13, 2)):
        a, b = own.pixel(i, j), lecture.pixel(i, j)
        assert a.decided
        assert all(abs(x - y) <= p + q for x, y, p, q in zip(a.value, b.value, a.bound, b.bound, strict=True))


@pytest.mark.parametrize("i", [(0.0, 0.0, 1.0), tuple(x / math.sqrt(14) for x in (1.0, 2.0, 3.0))])
def test_at_normal_incidence_only_the_slides_refraction_has_no_value(i):
    v, n = Vec(*(-x for x in i)), Vec(*i)
    for name in ("division-free", "vector"):
        t, total = REFRACT[name].refract(v, n, False, 1.5)
        assert not total
        assert t == pytest.approx(v, abs=4 * 2.0**-53)
    t, total = REFRACT["slide"].refract(v, n, False, 1.5)
    assert total
    assert any(math.isnan(part) for part in t)


def test_no_nan_of_the_slides_refraction_is_traced():
    picture = rung("glass-sphere").scene().resized(24, 18)
    ours, slides = plain.render(picture).pixels, plain.render(picture, REFRACT["slide"]).pixels
    gap = np.abs(slides - ours).max(axis=2)
    assert gap[9, 12] > 0.1  # the middle pixel's ray is exactly normal: its transmitted light is missing
    gap[9, 12] = 0.0
    assert gap.max() < 2.0**-20  # O(sqrt u) elsewhere, and no NaN


@pytest.mark.parametrize("name", REFRACT)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_away_from_the_hard_angles_all_refractions_are_right_to_a_few_units(name, dtype):
    rng = np.random.default_rng(4)
    k = 400
    n = rng.standard_normal((k, 3))
    n /= np.linalg.norm(n, axis=1)[:, None]
    side = np.cross(n, rng.standard_normal((k, 3)))
    side /= np.linalg.norm(side, axis=1)[:, None]
    angle = rng.uniform(0.3, 1.4, k)[:, None]
    v = (-n * np.cos(angle) + side * np.sin(angle)).astype(dtype)
    n = n.astype(dtype)
    index = np.full(k, 1.5, dtype)
    t, total = REFRACT[name].refract(Vec(*v.T), Vec(*n.T), np.zeros(k, bool), index)
    assert not total.any()
    error = truth.directions(v, n, index).error(np.stack(t, axis=-1)).max(axis=1)
    # 3u(1 + 1/c2)(1 + η) for the forms, c2 >= 0.75, η = 2/3, 6u/(η s1) for the slide; v and n are unit to 1.5u each
    assert error.max() <= U[dtype] * (3 * (1 + 1 / 0.75) * (5 / 3) + 6 * 1.5 / math.sin(0.3) + 3)


finite = st.floats(-1e6, 1e6, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-30)


@given(a=finite, b=finite)
def test_sums_and_products_are_split_without_error(a, b):
    for parts, value in (
        (pairs.two_sum(a, b), Fraction(a) + Fraction(b)),
        (pairs.two_product(a, b), Fraction(a) * Fraction(b)),
    ):
        assert Fraction(parts[0]) + Fraction(parts[1]) == value


single = st.floats(-1e3, 1e3, width=32, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-9)


@given(a=single, b=single)
def test_they_are_split_without_error_in_float32(a, b):
    x, y = np.array([a], np.float32), np.array([b], np.float32)
    for parts, value in (
        (pairs.two_sum(x, y), Fraction(a) + Fraction(b)),
        (pairs.two_product(x, y), Fraction(a) * Fraction(b)),
    ):
        assert all(part.dtype == np.float32 for part in parts)
        assert Fraction(float(parts[0][0])) + Fraction(float(parts[1][0])) == value


def fraction(x):
    return Fraction(x.high) + Fraction(x.low)


OPERATIONS = {
    "+": (lambda a, b: a + b, 4),
    "-": (lambda a, b: a - b, 4),
    "*": (lambda a, b: a * b, 8),
    "/": (lambda a, b: a / b, 16),
}


@pytest.mark.parametrize("name", OPERATIONS)
@given(a=finite, b=finite, p=st.floats(-1, 1), q=st.floats(-1, 1))
def test_double_words_keep_their_bounds(name, a, b, p, q):
    operation, units = OPERATIONS[name]
    x, y = (DoubleWord(*pairs.two_sum(m, m * t * 2.0**-53)) for m, t in ((a, p), (b, q)))
    assume(name != "/" or y.high != 0)
    value = operation(fraction(x), fraction(y))
    assume(value == 0 or abs(value) > Fraction(1, 10**200))
    got = operation(x, y)
    assert abs(fraction(got) - value) <= units * Fraction(2) ** -106 * abs(value)


@given(a=st.floats(1e-20, 1e20), p=st.floats(-1, 1))
def test_the_root_of_a_double_word_keeps_its_bound(a, p):
    x = DoubleWord(*pairs.two_sum(a, a * p * 2.0**-53))
    root = fraction(sqrt0(x))
    # |r - sqrt x| <= 25/8 u² sqrt x, so |r² - x| <= 2·25/8 u² x and a little
    assert abs(root * root - fraction(x)) <= 7 * Fraction(2) ** -106 * fraction(x)


@given(b=st.tuples(finite, finite, finite), r=st.floats(1e-3, 1e6))
def test_the_power_of_a_point_keeps_its_bound(b, r):
    value = sum(Fraction(x) ** 2 for x in b) - Fraction(r) ** 2
    size = sum(Fraction(x) ** 2 for x in b) + Fraction(r) ** 2
    u = Fraction(2) ** -53
    assert abs(Fraction(pairs.power_of_point(Vec(*b), r)) - value) <= u * abs(value) + 17 * u * u * size


@given(
    b=st.tuples(finite, finite, finite),
    r=st.floats(1e-3, 1e6),
    width=st.floats(0, 1e-3),
    shares=st.tuples(*[st.floats(-1, 1)] * 4),
)
def test_the_power_of_a_point_of_balls_holds_that_of_every_point_in_them(b, r, width, shares):
    precision = Precision(2.0**-24, 1e-300)
    mids = [*b, r]
    radii = [abs(x) * width for x in mids]
    balls = [Ball(np.array([m]), np.array([w]), precision) for m, w in zip(mids, radii, strict=True)]
    found = pairs.power_of_point(Vec(*balls[:3]), balls[3])
    x, y, z, w = (Fraction(m) + Fraction(k) * Fraction(t) for m, k, t in zip(mids, radii, shares, strict=True))
    gap = abs(x * x + y * y + z * z - w * w - Fraction(float(found.mid[0])))
    assert gap <= Fraction(float(found.rad[0]))
    assert found.mid[0] == pairs.power_of_point(Vec(*b), r)
