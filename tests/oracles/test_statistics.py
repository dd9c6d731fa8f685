"""The statistical gate: its distributions, its rate, and what it must see."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.random import default_rng

from oracles.statistics import Samples, area_average, judge
from oracles.statistics.reference import GRID
from oracles.statistics.student import critical, sidak, two_sided, welch
from oracles.truth import truth
from scenes.catalogue import rung

U = 2.0**-53
SCENE = rung("point-light").scene().resized(24, 16)
TRUTH = truth(SCENE, "float32")
RUNS, UNITS, SPP, SIGMA = 16, 32, 64, 0.02


def samples(seed: int, change: float = 0.0) -> Samples:
    """Renders whose noise is normal, times 1 + change."""
    noise = SIGMA * default_rng(seed).normal(size=(RUNS, *TRUTH.pixels.shape))
    return Samples(TRUTH.pixels * (1.0 + change) + noise, SPP)


def reference(seed: int) -> np.ndarray:
    return np.asarray(TRUTH.pixels + 0.2 * SIGMA * default_rng(10_000 + seed).normal(size=(UNITS, *TRUTH.pixels.shape)))


@pytest.mark.parametrize(
    ("t", "decimals", "freedom", "p"),
    # Student's table: quantiles of 1, 10 and 30 degrees of freedom
    [
        (12.7062, 4, 1, 0.05),
        (2.22814, 5, 10, 0.05),
        (3.16927, 5, 10, 0.01),
        (2.04227, 5, 30, 0.05),
        (3.6460, 4, 30, 0.001),
    ],
)
def test_tails_are_students(t: float, decimals: int, freedom: float, p: float) -> None:
    half = 0.5 * 10.0**-decimals  # of the last digit
    assert two_sided(t + half, freedom) < p < two_sided(t - half, freedom)
    assert critical(p, freedom) == pytest.approx(t, abs=half)


def test_a_cauchy_tail_is_known_in_closed_form() -> None:
    """One degree of freedom: P(|T| >= t) = 1 - 2 atan(t)/π."""
    # 1 - 2 atan(t)/π = 2 atan(1/t)/π; arb at 53 bits and two quotients
    assert two_sided(1e6, 1.0) == pytest.approx(2.0 / np.pi * np.arctan(1e-6), rel=16 * U, abs=0.0)


def test_sidak_restores_the_rate() -> None:
    assert 1.0 - (1.0 - sidak(0.01, 900)) ** 900 == pytest.approx(
        0.01, abs=900 * 2 * U
    )  # the rounding of the rate and of its complement, in 900 factors


def test_welch_has_students_freedom_for_equal_variances_and_counts() -> None:
    a = np.array([[1.0], [2.0], [3.0], [4.0]])
    found = welch(a, a + 1.0)
    assert found.freedom[0] == pytest.approx(6.0, rel=16 * U, abs=0.0)  # a dozen operations
    assert found.difference[0] == -1.0
    assert found.error[0] == pytest.approx(np.sqrt(2 * (5.0 / 3.0) / 4), rel=16 * U, abs=0.0)


def test_a_right_tracer_fails_no_more_often_than_stated() -> None:
    """At 1 % of 60 checks, 5 alarms or more come once in 3000 runs of this test; its seeds are fixed."""
    alarms = sum(judge(samples(k), reference(k), TRUTH).word == "fail" for k in range(60))
    assert alarms < 5


def test_a_bias_of_the_stated_power_is_seen_and_a_tenth_of_it_is_not() -> None:
    smallest = judge(samples(1), reference(1), TRUTH).sampled.smallest_bias
    assert judge(samples(1, 2.0 * smallest), reference(1), TRUTH).word == "fail"
    assert judge(samples(1, 0.1 * smallest), reference(1), TRUTH).word == "pass"


def test_ten_pixels_wrong_by_a_thousand_sigma_are_seen() -> None:
    wrong = samples(2)
    wrong.values[:, 3:5, 4:9] += 1000.0 * SIGMA / np.sqrt(RUNS)
    found = judge(wrong, reference(2), TRUTH)
    assert found.word == "fail"
    assert found.outside[3:5, 4:9].all()


def test_one_pixel_that_no_mean_can_have_is_a_spot_even_without_variance() -> None:
    wrong = samples(3)
    wrong.values[:, 2, 2] = 50.0
    assert judge(wrong, reference(3), TRUTH).sampled.spots == 1


def test_a_uniform_bias_of_a_twelfth_of_a_sigma_is_seen() -> None:
    """What a rule that lets a fraction of a per cent of the pixels fail cannot see."""
    off = samples(4)
    assert judge(Samples(off.values + 0.08 * SIGMA, SPP), reference(4), TRUTH).word == "fail"


def test_rounding_is_no_bias() -> None:
    flat = np.repeat(TRUTH.pixels[None], RUNS, axis=0)
    rounded = flat.astype(np.float32).astype(np.float64)
    assert judge(Samples(rounded, SPP), flat, TRUTH).word == "pass"


def test_p_values_of_a_right_tracer_are_level() -> None:
    counts = np.sum([judge(samples(k), reference(k), TRUTH).sampled.histogram for k in range(30)], axis=0)
    # 30 checks of 18 tests in 10 bins: binomial, five standard deviations
    n = counts.sum()
    assert n == 30 * 18
    assert np.all(np.abs(counts - n / 10) < 5 * np.sqrt(n * 0.1 * 0.9))


def test_the_reference_averages_over_the_pixels_area() -> None:
    """A picture linear across a pixel has its middle as average: a plane seen from above in its own light."""
    scene = rung("background").scene().resized(8, 6)
    found = area_average(scene, 2, 5, "numpy")
    assert found.shape == (2, 6, 8, 3)
    assert found == pytest.approx(
        np.broadcast_to(np.array(scene.background), found.shape), abs=GRID**2 * U
    )  # a rounding each sample


def test_units_of_the_reference_are_reproducible_and_independent() -> None:
    scene = rung("headlight-sphere").scene().resized(8, 6)
    once, again, other = (area_average(scene, 2, seed, "numpy") for seed in (1, 1, 2))
    assert np.array_equal(once, again)
    assert not np.array_equal(once, other)
    assert not np.array_equal(once[0], once[1])
