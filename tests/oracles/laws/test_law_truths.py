"""What the judge of the laws takes for true, held to rational and interval arithmetic."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx

from oracles.laws.crossings import crossings
from oracles.laws.dice import Dice, seeded
from oracles.laws.phong import lamps
from oracles.laws.plane import meetings
from oracles.laws.rays import Rays, rays, roots

ROUNDOFF = {"float32": 2.0**-24, "float64": 2.0**-53}


@pytest.fixture(autouse=True)
def bits() -> Any:
    before, ctx.prec = ctx.prec, 400
    yield
    ctx.prec = before


def dot(a: Any, b: Any) -> Any:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def exact(row: Any) -> list[Fraction]:
    return [Fraction(float(x)) for x in row]


def drawn(precision: str, miss: bool = False) -> Rays:
    dice = seeded(400, precision, 11)
    return rays(dice, 1.0, 3.0, ("ordinary", "far", "grazing", "huge floor")) if miss else rays(dice)


@pytest.mark.parametrize("miss", [False, True])
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_hit_and_miss_are_decided_as_rational_arithmetic_does(precision: str, miss: bool) -> None:
    given = drawn(precision, miss)
    truth = roots(given, ROUNDOFF[precision])
    seen = 0
    for k in range(len(given.r)):
        b = [o - c for o, c in zip(exact(given.o[k]), exact(given.c[k]), strict=True)]
        v, r = exact(given.v[k]), Fraction(float(given.r[k]))
        D = dot(b, v) ** 2 - dot(v, v) * (dot(b, b) - r * r)
        seen += bool(truth.inside[k] or truth.outside[k])
        assert not (truth.inside[k] and D <= 0)
        assert not (truth.outside[k] and D >= 0)
    assert seen > 200


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_roots_lie_within_a_tenth_of_the_tolerance_of_the_true_ones(precision: str) -> None:
    given = drawn(precision)
    truth = roots(given, ROUNDOFF[precision])
    for k in np.flatnonzero(truth.inside):
        b = [arb(o) - arb(c) for o, c in zip(given.o[k].tolist(), given.c[k].tolist(), strict=True)]
        v, r = [arb(x) for x in given.v[k].tolist()], arb(float(given.r[k]))
        bv, vv = dot(b, v), dot(v, v)
        root = (bv * bv - vv * (dot(b, b) - r * r)).sqrt()
        for computed, true in ((truth.near[k], (-bv - root) / vv), (truth.far[k], (-bv + root) / vv)):
            share = 0.1 if precision == "float32" else 0.5
            assert abs(float(arb(float(computed)) - true)) <= share * truth.dt[k]


@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_snells_sine_is_that_of_the_given_numbers(precision: str) -> None:
    given = crossings(seeded(400, precision, 2))
    for k in range(400):
        v, n = ([arb(x) for x in part[k].tolist()] for part in (given.v, given.n))
        cosine2 = dot(v, n) ** 2 / (dot(v, v) * dot(n, n))
        sine = (1 - cosine2).nonnegative_part().sqrt()
        index = arb(float(given.index[k]))
        eta = 1 / index if dot(v, n) > 0 else index
        assert bool(given.leaving[k]) == bool(dot(v, n) > 0)
        assert abs(float(sine / eta) - given.sin2[k]) <= 8 * 2.0**-53 / float(eta)


def test_planes_are_met_where_rational_arithmetic_says() -> None:
    given = meetings(seeded(400, "float32", 4))
    for k in range(400):
        n, o, v = (exact(part[k]) for part in (given.n, given.o, given.v))
        toward = dot(n, v)
        if toward and (given.meets[k] or given.misses[k]):
            root = (Fraction(float(given.offset[k])) - dot(n, o)) / toward
            assert bool(given.meets[k]) == (root > 0)
            assert abs(float(root) - given.distance[k]) <= 0.01 * given.bound[k]


def test_the_lobes_closed_form_is_the_exact_product_of_mirror_and_eye() -> None:
    given = lamps(seeded(400, "float64", 6))
    for k in range(400):
        i, n, v = ([arb(x) for x in part[k].tolist()] for part in (given.i, given.n, given.v))
        mirrored = [2 * dot(i, n) * a - b for a, b in zip(n, i, strict=True)]
        assert abs(float(-dot(mirrored, v)) - given.x[k]) < 20 * 2.0**-53


class TestDice:
    def test_plain_coordinates_make_the_plainest_ray(self) -> None:
        given = rays(Dice(1, "float32", lambda: np.zeros(1)))
        assert given.c.tolist() == [[0.0, 0.0, 0.0]]
        assert given.r.tolist() == [1.0]
        assert given.v.tolist() == [[0.0, 0.0, 1.0]]

    def test_inputs_are_exact_for_the_tracers_precision(self) -> None:
        given = rays(seeded(500, "float32", 0))
        for part in (given.o, given.v, given.c, given.r):
            assert np.array_equal(part, part.astype(np.float32).astype(np.float64))

    def test_the_same_seed_makes_the_same_cases_and_another_makes_others(self) -> None:
        first, again, other = (rays(seeded(50, "float64", seed)).o for seed in (1, 1, 2))
        assert np.array_equal(first, again)
        assert not np.array_equal(first, other)

    def test_the_hard_places_are_reached(self) -> None:
        dice = seeded(20000, "float64", 0)
        given = rays(dice)
        b = given.o - given.c
        D = np.linalg.norm(b, axis=1) / given.r
        s = np.linalg.norm(np.cross(b, given.v), axis=1) / given.r
        assert D.max() > 5e8
        assert np.abs(1.0 - s).min() < 1e-11
        assert (D < 1.0).any()
        assert np.linalg.norm(given.c, axis=1).max() > 1e6
        assert given.r.max() > 1e5
        crossed = crossings(seeded(20000, "float64", 0))
        assert (crossed.sin1 == 0.0).any()
        assert np.abs(1.0 - crossed.sin2).min() < 1e-11
        assert crossed.cos1.min() < 3e-3
