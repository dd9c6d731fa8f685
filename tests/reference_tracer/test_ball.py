"""Balls must contain whatever a tracer of their roundoff may compute; exact fractions say what that is."""

import itertools
from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from reference_tracer import numbers
from reference_tracer.lanes.ball import Ball, Doubtful, Precision

U32 = 2.0**-24
FLOAT32 = Precision(U32, 1e-300)  # no underflow in these ranges
EXACT = Precision(0.0, 0.0)
values = st.floats(-1e3, 1e3, allow_subnormal=False)
radii = st.floats(0, 10, allow_subnormal=False)
shares = st.floats(-1, 1)


def ball(mid, rad):
    return Ball(np.array([mid]), np.array([rad]), FLOAT32)


def inside(value, result, slack=Fraction(1, 10**9)):
    """Is the exact value in the ball, whose own radius was computed in float64?"""
    mid, rad = float(result.mid[0]), float(result.rad[0])
    if rad == np.inf:  # the midpoint may have overflowed with it
        return True
    return abs(value - Fraction(mid)) <= Fraction(rad) * (1 + slack) + Fraction(1, 10**300)


def somewhere(mid, rad, share):
    """An exact value in mid ± rad."""
    return Fraction(mid) + Fraction(rad) * Fraction(share)


OPERATIONS = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
}


@pytest.mark.parametrize("name", list(OPERATIONS))
@given(x=values, rx=radii, y=values, ry=radii, p=shares, q=shares, rounding=shares)
def test_an_operation_contains_every_rounded_result_of_its_arguments(name, x, rx, y, ry, p, q, rounding):
    a, b = somewhere(x, rx, p), somewhere(y, ry, q)
    assume(name != "/" or (b != 0 and y != 0))
    operation = OPERATIONS[name]
    with np.errstate(all="ignore"):
        result = operation(ball(x, rx), ball(y, ry))
    rounded = operation(a, b) * (1 + Fraction(rounding) * Fraction(U32))
    # The rounding is relative to the exact result, the ball's to its midpoint: equal but for u times the radius
    assert inside(rounded, result, Fraction(2) * Fraction(U32))


@given(x=st.floats(0, 1e3, allow_subnormal=False), rx=radii, p=shares)
def test_a_root_contains_the_root_of_every_positive_part(x, rx, p):
    with localcontext() as context:
        context.prec = 50
        value = max(somewhere(x, rx, p), Fraction(0))
        root = (Decimal(value.numerator) / Decimal(value.denominator)).sqrt()
        assert inside(Fraction(root), numbers.sqrt0(ball(x, rx)))


@given(
    x=st.lists(values, min_size=3, max_size=3),
    r=st.lists(radii, min_size=3, max_size=3),
    p=st.lists(shares, min_size=3, max_size=3),
)
def test_a_unit_vector_contains_the_direction_of_every_vector_of_the_ball(x, r, p):
    r = [0.01 * part for part in r]
    with localcontext() as context:
        context.prec = 50
        vector = [somewhere(*part) for part in zip(x, r, p, strict=True)]
        exact = [Decimal(part.numerator) / Decimal(part.denominator) for part in vector]
        size = sum(part * part for part in exact).sqrt()
        assume(size > 0)
        result = numbers.unit3(*(ball(mid, rad) for mid, rad in zip(x, r, strict=True)))
        for part, enclosure in zip(exact, result, strict=True):
            assert inside(Fraction(part / size), enclosure)


@given(x=st.floats(0, 1.0), rx=st.floats(0, 0.1), p=shares, n=st.integers(1, 200))
def test_a_power_contains_the_power_of_every_value(x, rx, p, n):
    value = max(somewhere(x, rx, p), Fraction(0))
    result = numbers.power(ball(x, rx), n)
    assert inside(value**n, result) or value**n < Fraction(1, 10**299)


@given(x=values, rx=radii, p=shares)
def test_the_positive_part_contains_the_positive_part_of_every_value(x, rx, p):
    assert inside(max(somewhere(x, rx, p), Fraction(0)), numbers.clamp0(ball(x, rx)))


@given(x=values, rx=radii, p=shares, y=values, ry=radii, q=shares)
def test_a_sure_comparison_holds_for_all_values(x, rx, p, y, ry, q):
    found = numbers.less(ball(x, rx), ball(y, ry))
    if found.sure[0]:
        assert (somewhere(x, rx, p) < somewhere(y, ry, q)) == found.value[0]


@given(x=values, rx=radii, y=values, ry=radii, z=values, rz=st.floats(0.5, 10), choice=st.booleans(), p=shares)
def test_an_undecided_selection_is_the_hull_of_both_branches(x, rx, y, ry, z, rz, choice, p):
    condition = numbers.less(ball(z, abs(z) + rz), ball(0.0, 0.0))
    assert not condition.sure[0]
    result = numbers.select(condition, ball(x, rx), ball(y, ry))
    assert inside(somewhere(x, rx, p) if choice else somewhere(y, ry, p), result)


def test_the_midpoint_is_the_float_result():
    a, b = np.random.default_rng(0).standard_normal((2, 100))
    for operation in OPERATIONS.values():
        assert (operation(Ball(a, a * 0, FLOAT32), Ball(b, b * 0, FLOAT32)).mid == operation(a, b)).all()


def test_without_widening_balls_lose_float32_results():
    a, b = np.random.default_rng(0).standard_normal((2, 1000)).astype(np.float32)
    exact = Ball(a.astype(float), np.zeros(1000), EXACT) * Ball(b.astype(float), np.zeros(1000), EXACT)
    widened = Ball(a.astype(float), np.zeros(1000), FLOAT32) * Ball(b.astype(float), np.zeros(1000), FLOAT32)
    got = (a * b).astype(float)
    assert (np.abs(got - exact.mid) > exact.rad).any()
    assert (np.abs(got - widened.mid) <= widened.rad).all()


POSSIBLE = {(True, True): {True}, (False, True): {False}, (True, False): {True, False}, (False, False): {True, False}}


@pytest.mark.parametrize(("a", "b"), list(itertools.product(POSSIBLE, repeat=2)))
@pytest.mark.parametrize("name", ["and", "or"])
def test_three_valued_logic_is_sure_just_where_all_possibilities_agree(name, a, b):
    together = {"and": lambda p, q: p & q, "or": lambda p, q: p | q}[name]
    x, y = (Doubtful(np.array([value]), np.array([sure])) for value, sure in (a, b))
    result = together(x, y)
    outcomes = {together(p, q) for p in POSSIBLE[a] for q in POSSIBLE[b]}
    assert bool(result.sure[0]) == (len(outcomes) == 1)
    assert bool(result.value[0]) in outcomes


def test_an_undecided_comparison_has_no_truth_value():
    with pytest.raises(TypeError, match="no truth value"):
        bool(numbers.less(ball(0.0, 1.0), ball(0.5, 0.0)))


def test_a_tie_of_exact_values_is_decided():
    assert numbers.less(ball(0.0, 0.0), ball(0.0, 0.0)).sure[0]
