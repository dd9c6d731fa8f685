"""Affine forms must hold, symbol by symbol, whatever a tracer of their roundoff may compute; arb says what that is."""

import inspect
import textwrap

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given
from hypothesis import strategies as st

from reference_tracer import numbers
from reference_tracer.formulas import conventions, optics, plane, shading, sphere
from reference_tracer.lanes import affine
from reference_tracer.lanes.affine import NONE, Affine
from reference_tracer.lanes.ball import UNDERFLOW_32, Ball, Precision
from reference_tracer.lanes.sloppy import Error, Sloppy
from reference_tracer.vector import Vec, unit

U = 2.0**-23
FLOAT32 = Precision(U, UNDERFLOW_32)
ROUND = U - 2.0**-53  # the midpoint is rounded too
LANES, SYMBOLS = 80, 7
SEEDS = range(6)


@pytest.fixture(autouse=True)
def many_bits():
    before, ctx.prec = ctx.prec, 200
    with np.errstate(all="ignore"):  # as the renderer has it
        yield
    ctx.prec = before


class Draw:
    """Forms that share symbols, and true values inside them."""

    def __init__(self, seed, lanes=LANES):
        self.chance = np.random.default_rng(seed)
        self.lanes = lanes
        self.share = self._shares((SYMBOLS, lanes))

    def _shares(self, shape):
        """Half at the ends of [-1, 1]: a bound that fails, fails there."""
        return np.clip(self.chance.uniform(-2, 2, shape), -1.0, 1.0)

    def form(self, low=-3.0, high=3.0, wide=None):
        """A form and exact values inside it; radii from 2^-30 to `wide`, by lane; a tenth knows no symbol."""
        chance, n = self.chance, self.lanes
        size = 10.0 ** chance.uniform(-9, -1, n) if wide is None else wide * chance.random(n)
        dev = size * chance.uniform(-1, 1, (SYMBOLS, n)) / SYMBOLS
        rest = size * chance.random(n) * chance.choice([0.0, 0.1], n)
        dev[:, chance.random(n) < 0.1] = 0.0
        mid = chance.uniform(low, high, n)
        off = self._shares(n)
        true = [self.exact(mid[k], dev[:, k], rest[k], off[k], self.share[:, k]) for k in range(n)]
        return Affine(mid, rest, FLOAT32, dev), true

    @staticmethod
    def exact(mid, dev, rest, off, share):
        linear = sum((arb(d) * arb(s) for d, s in zip(dev, share, strict=True)), arb(0))
        return arb(mid) + linear + arb(rest) * arb(off)

    def rounded(self, values):
        """Each value with a tracer's error, exactly."""
        off = self._shares(len(values)) * ROUND
        return [value * (1 + arb(o)) for value, o in zip(values, off, strict=True)]

    def outside(self, form, values):
        """Lanes whose value is not mid + Σ dev_k share_k ± rest, with the very shares that its arguments had."""
        mid, rest = (np.broadcast_to(x, self.lanes) for x in (form.mid, form.rest))
        dev = np.broadcast_to(form.dev, (len(form.dev), self.lanes))
        assert not np.isnan(rest).any()
        return [
            k
            for k, value in enumerate(values)
            if np.isfinite(rest[k])
            and abs(value - self.exact(mid[k], dev[:, k], 0.0, 0.0, self.share[: len(dev), k])) > arb(rest[k])
        ]


BINARY = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "2 -": lambda a, b: 2.0 - b,
    "1 /": lambda a, b: 1.0 / b,
    "2 *": lambda a, b: 2.0 * a,
}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", BINARY)
def test_an_operation_contains_every_rounded_result_with_the_same_symbols(name, seed):
    draw = Draw(seed)
    (a, x), (b, y) = draw.form(), draw.form()
    operation = BINARY[name]
    found = operation(a, b)
    exact = [operation(p, q) for p, q in zip(x, y, strict=True)]
    assert draw.outside(found, draw.rounded(exact)) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_a_difference_of_forms_that_share_their_symbols_is_narrow(seed):
    draw = Draw(seed)
    a, x = draw.form(wide=0.1)
    b = Affine(a.mid * 1.5, a.rest, FLOAT32, a.dev)
    found = b - a
    assert (
        found.rad <= 2.0 * a.rest + 2.0 * U * (np.abs(found.mid) + 2.0 * a.rest) + 16 * 2.0**-53
    ).all()  # of this line itself
    exact = [p + arb(q) - arb(r) - p for p, q, r in zip(x, b.mid, a.mid, strict=True)]
    assert draw.outside(found, draw.rounded(exact)) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("wide", [None, 0.5])
def test_a_root_contains_the_root_of_every_positive_part(seed, wide):
    draw = Draw(seed)
    a, x = draw.form(-0.1, 3.0, wide)
    exact = [p.sqrt() if p > 0 else arb(0) for p in x]
    assert draw.outside(numbers.sqrt0(a), draw.rounded(exact)) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_the_positive_part_contains_every_positive_part(seed):
    draw = Draw(seed)
    a, x = draw.form(-0.1, 0.1)
    assert draw.outside(numbers.clamp0(a), [p if p > 0 else arb(0) for p in x]) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("n", [1, 5, 100, 1000])
def test_a_power_contains_every_power_computed_by_a_chain(seed, n):
    draw = Draw(seed)
    a, x = draw.form(-0.2, 1.01)
    chain = [(1 + arb(ROUND)) ** (n - 1), (1 - arb(ROUND)) ** (n - 1)]
    exact = [(p if p > 0 else arb(0)) ** n * chain[k % 2] for k, p in enumerate(x)]
    assert draw.outside(numbers.power(numbers.clamp0(a), n), exact) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_a_sum_of_three_contains_every_order_of_summation(seed, order):
    draw = Draw(seed)
    forms, exact = zip(*(draw.form(wide=w) for w in (0.1, 1e-3, 1e-6)), strict=True)
    i, j, k = order
    first = draw.rounded([p + q for p, q in zip(exact[i], exact[j], strict=True)])
    whole = draw.rounded([p + q for p, q in zip(first, exact[k], strict=True)])
    assert draw.outside(numbers.sum3(*forms), whole) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_division_by_pi_contains_both_ways_to_do_it(seed):
    draw = Draw(seed)
    a, x = draw.form()
    rounded = draw.rounded([1 / arb.pi()] * len(x))
    assert draw.outside(numbers.over_pi(a), draw.rounded([p * q for p, q in zip(x, rounded, strict=True)])) == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("wide", [None, 1e-7, 1e-2, 0.3])
def test_a_unit_vector_contains_every_direction(seed, wide):
    draw = Draw(seed)
    forms, exact = zip(*(draw.form(wide=wide) for _ in range(3)), strict=True)
    found = numbers.unit3(*forms)
    sizes = [(x * x + y * y + z * z).sqrt() for x, y, z in zip(*exact, strict=True)]
    for part, values in zip(found, exact, strict=True):
        assert draw.outside(part, draw.rounded([p / size for p, size in zip(values, sizes, strict=True)])) == []


@pytest.mark.parametrize("seed", SEEDS)
def test_an_undecided_selection_holds_both_branches_and_a_decided_one_keeps_its_symbols(seed):
    draw = Draw(seed)
    (a, x), (b, y), (c, z) = draw.form(), draw.form(), draw.form(-0.05, 0.05)
    condition = numbers.less(c, 0.0)
    assert condition.sure.any()
    assert not condition.sure.all()
    found = numbers.select(condition, a, b)
    assert draw.outside(found, [p if r < 0 else q for p, q, r in zip(x, y, z, strict=True)]) == []
    assert (found.dev[:, condition.sure] != 0.0).any()


@pytest.mark.parametrize("seed", SEEDS)
def test_a_sure_comparison_holds_for_all_values(seed):
    draw = Draw(seed)
    (a, x), (b, y) = draw.form(-0.1, 0.1), draw.form(-0.1, 0.1)
    found = numbers.less(a, b)
    sure = np.flatnonzero(found.sure)
    assert sure.size > 0
    assert [k for k in sure if bool(x[k] < y[k]) != found.value[k]] == []


values = st.floats(-1e3, 1e3, allow_subnormal=False)
shares = st.floats(-1, 1)
parts = st.tuples(values, st.floats(-1, 1), st.floats(-1, 1), st.floats(0, 0.1))


@given(a=parts, b=parts, e=shares, f=shares, p=shares, q=shares, rounding=shares, name=st.sampled_from(sorted(BINARY)))
def test_an_operation_contains_every_rounded_result_anywhere(a, b, e, f, p, q, rounding, name):
    forms = [Affine(np.array([m]), np.array([r]), FLOAT32, np.array([[d], [g]])) for m, d, g, r in (a, b)]
    x, y = (Draw.exact(m, (d, g), r, s, (e, f)) for (m, d, g, r), s in ((a, p), (b, q)))
    with np.errstate(all="ignore"):
        found = BINARY[name](*forms)
    if np.isfinite(found.rest[0]):
        value = BINARY[name](x, y) * (1 + arb(ROUND * rounding))
        dev = found.dev[:, 0] if len(found.dev) else ()
        inside = Draw.exact(found.mid[0], dev, 0.0, 0.0, (e, f)[: len(dev)])
        assert not abs(value - inside) > arb(found.rest[0])


# Whole formulas: the same inputs, computed with an error in every operation


def sphere_case(a):
    o, v, c = Vec(*a[:3]), unit(Vec(*a[3:6])), Vec(*a[6:9]) + Vec(0.0, 0.0, 6.0)
    distance, meets = sphere.sphere_hit(sphere.sphere_distances, o, v, c, a[9] + 4.0, NOWHERE, 0.0)
    return [distance, *sphere.sphere_normal(o + v * distance, c)], meets


def plane_case(a):
    distance, meets = plane.plane_hit(Vec(*a[:3]), unit(Vec(*a[3:6])), Vec(*a[6:9]), a[9], ~NOWHERE, 0.0)
    return [distance, *plane.plane_normal(Vec(*a[6:9]))], meets


def snell_case(a):
    v, n = unit(Vec(*a[:3])), unit(Vec(*a[3:6]))
    facing, leaving = optics.face(v, n)
    index = a[9] * 0.1 + 1.5
    t, total = optics.refract(v, facing, leaving, index)
    shares_ = [formula(v, facing, leaving, index) for formula in (optics.fresnel, conventions.schlick)]
    return [*t, *optics.reflect(-v, facing), *shares_], total


def light_case(a):
    k, p, n, v = (Vec(*a[3 * j : 3 * j + 3]) for j in range(4))
    i, distance = shading.light_vector(k, p, ~NOWHERE)
    n, v = unit(n), unit(v)
    lobes = [
        formula(i, n, v, 10, optics.reflect(i, n))
        for formula in (shading.phong, conventions.phong_lobe, conventions.blinn_lobe)
    ]
    factor = shading.attenuation(distance, NOWHERE, ~NOWHERE)
    return [*i, distance, factor, shading.lambert(i, n), conventions.lambert_over_pi(i, n), *lobes], None


NOWHERE = np.zeros(4000, dtype=bool)
FORMULAS = {"sphere": sphere_case, "plane": plane_case, "Snell": snell_case, "light": light_case}


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("name", FORMULAS)
def test_a_formula_contains_what_a_tracer_computes_with_an_error_in_every_operation(name, seed):
    chance = np.random.default_rng(seed)
    n = NOWHERE.size
    size = 10.0 ** chance.uniform(-9, -3, n)
    forms, inputs = [], []
    error, share = Error(2.0**-24, seed), np.clip(chance.uniform(-2, 2, (SYMBOLS, n)), -1, 1)
    for _ in range(12):
        mid, dev = chance.uniform(-3, 3, n), size * chance.uniform(-1, 1, (SYMBOLS, n))
        rest = size * chance.choice([0.0, 0.1], n) + 2.0**-50  # ours: the inputs are made in float64
        forms.append(Affine(mid, rest, FLOAT32, dev))
        inputs.append(Sloppy(mid + (dev * share).sum(axis=0) + (rest - 2.0**-50) * chance.uniform(-1, 1, n), error))
    with np.errstate(all="ignore"):
        (found, condition), (got, answer) = FORMULAS[name](forms), FORMULAS[name](inputs)
    if condition is not None:
        sure = np.broadcast_to(condition.sure, n)
        assert sure.mean() > 0.5
        assert (condition.value == answer)[sure].all()
    for form, value in zip(found, got, strict=True):
        lost = np.abs(value.value - form.mid) > form.rad
        assert not lost.any(), np.flatnonzero(lost)[:5]
        assert np.isfinite(form.rad).mean() > 0.5


# What is not known must not become known


UNKNOWN = [(1.0, np.inf), (np.nan, np.inf), (np.inf, np.inf), (1.0, np.nan)]


@pytest.mark.parametrize("kind", [Ball, Affine])
@pytest.mark.parametrize(("mid", "rad"), UNKNOWN)
def test_nothing_is_made_of_the_unknown(kind, mid, rad):
    x = kind(np.array([mid]), np.array([rad]), FLOAT32)
    one = kind(np.array([1.0]), np.array([0.0]), FLOAT32)
    unsure = numbers.less(kind(np.zeros(1), np.ones(1), FLOAT32), 0.0)
    with np.errstate(all="ignore"):
        results = {
            "+": x + one,
            "*": x * one,
            "/": one / x,
            "sum": numbers.sum3(one, x, one),
            "root": numbers.sqrt0(x),
            "positive part": numbers.clamp0(x),
            "power": numbers.power(x, 3),
            "over pi": numbers.over_pi(x),
            "hull": numbers.select(unsure, x, one),
            "other hull": numbers.select(unsure, one, x),
        }
        assert {name for name, y in results.items() if y.rad[0] < np.inf} == set()
        assert numbers.unit3(x, one, one)[1].rad[0] >= 2.0
        assert not numbers.less(x, one).sure[0]


@pytest.mark.parametrize("kind", [Ball, Affine])
def test_a_direction_is_not_told_from_squares_that_underflow_or_overflow(kind):
    for size, precision in ((1e-19, FLOAT32), (1e200, FLOAT32), (1e-160, Precision(2.0**-53, 1e-300))):
        x, y, z = (kind(np.array([s * size]), np.zeros(1), precision) for s in (3.0, 4.0, 0.0))
        with np.errstate(all="ignore"):
            found = numbers.unit3(x, y, z)
        assert abs(0.6 - found[0].mid[0]) <= found[0].rad[0]
        assert found[0].rad[0] > 1.0


def test_an_exact_zero_stays_exact():
    nothing = Affine(np.zeros(1), np.zeros(1), FLOAT32)
    something = Affine(np.ones(1), np.zeros(1), FLOAT32, np.full((2, 1), 0.1))
    for found in (nothing * something, nothing / something, numbers.sqrt0(nothing), nothing + 0.0):
        assert found.rad[0] == 0.0


def test_a_generation_starts_with_a_new_symbol_for_each_of_its_six_numbers():
    old = np.full((2, 3), 0.5)
    forms = [Affine(np.zeros(3), np.full(3, 0.1 * k), FLOAT32, old if k % 2 else NONE) for k in range(1, 7)]
    o, v = Affine.begin(Vec(*forms[:3]), Vec(*forms[3:]))
    for k, form in enumerate((*o, *v)):
        assert form.dev.shape == (8, 3)
        assert (form.rest == 0.0).all()
        assert (form.dev[2 + k] == forms[k].rest).all()
        assert np.count_nonzero(form.dev[2:, 0]) == 1


# Taking out any part of a bound must be noticed


def fails(test, *args):
    try:
        test(*args)
    except AssertionError:
        return True
    return False


def test_without_the_tracers_rounding_the_tests_fail(monkeypatch):
    rounded = Affine._rounded
    monkeypatch.setattr(Affine, "_rounded", lambda self, mid, rest, dev, times: rounded(self, mid, rest, dev, 0.0))
    assert fails(test_an_operation_contains_every_rounded_result_with_the_same_symbols, "+", 0)
    assert fails(test_an_operation_contains_every_rounded_result_with_the_same_symbols, "/", 0)


@pytest.mark.parametrize(
    ("part", "instead", "test"),
    [
        ("bend = x.rad * x.rad /", "bend = 0.0 * x.rad /", test_a_root_contains_the_root_of_every_positive_part),
        ("bend = R * ", "bend = 0.0 * ", test_a_unit_vector_contains_every_direction),
    ],
)
def test_without_the_second_order_the_tests_fail(monkeypatch, part, instead, test):
    name = "sqrt0" if "x.rad" in part else "unit3"
    method = getattr(affine.AffineOperations, name)
    source = textwrap.dedent(inspect.getsource(method))
    assert source.count(part) == 1
    scope = dict(vars(affine))
    exec(source.replace(part, instead), scope)  # noqa: S102 - our own source, one term taken out
    monkeypatch.setattr(affine.AffineOperations, name, scope[name])
    assert any(fails(test, seed, 0.3) for seed in SEEDS)


def test_without_the_reach_of_the_divisor_the_tests_fail(monkeypatch):
    monkeypatch.setattr(Affine, "rad", property(lambda self: self.rest))
    assert fails(test_an_operation_contains_every_rounded_result_with_the_same_symbols, "/", 0)
