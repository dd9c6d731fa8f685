"""Numbers beside the verdict: known values, and the traps that other tools fall into."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracles.metrics import appearance

pytest.importorskip("colour")
pytest.importorskip("flip_evaluator")
U = 2.0**-53
GREY = np.full((16, 24, 3), 0.5)


def test_equal_pictures_differ_in_nothing() -> None:
    found = appearance(GREY, GREY, GREY, GREY)
    assert (found.rmse, found.flip, found.psnr) == (0.0, 0.0, math.inf)
    assert (found.delta_e_2000, found.delta_e_itp) == (0.0, 0.0)


def test_black_against_white_is_a_hundred_of_lightness_and_zero_decibels() -> None:
    black, white = np.zeros_like(GREY), np.ones_like(GREY)
    found = appearance(black, white, black, white)
    assert (found.rmse, found.psnr) == (1.0, 0.0)
    # IEC 61966-2-1 gives its matrix to four decimals: white is off by up to three halves of the last one, and L* = 116
    # f - 16, a* = 500 Δf, b* = 200 Δf with f' = 1/3 make of that less than 500/3 times as much
    assert found.delta_e_2000 == pytest.approx(100.0, abs=500 / 3 * 1.5 * 10.0**-4)
    assert found.flip is not None
    assert found.flip > 0.9


def test_a_hundredth_is_forty_decibels() -> None:
    found = appearance(GREY, GREY + 0.01, GREY, GREY + 0.01)
    # 0.5 + 0.01 is rounded to u/2, a 25 u of the hundredth; the squares, mean, root or logarithm add some u
    assert found.psnr == pytest.approx(40.0, abs=20 / math.log(10) * 32 * U)
    assert found.rmse == pytest.approx(0.01, rel=32 * U, abs=0.0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_a_value_that_is_not_finite_is_refused(value: float) -> None:
    bad = GREY.copy()
    bad[3, 3, 1] = value
    with pytest.raises(ValueError, match="not finite"):
        appearance(GREY, bad, GREY, bad)


@pytest.mark.parametrize("shape", [(1, 1, 3), (16, 1, 3), (24, 16, 3), (16, 24, 1), (16, 24)])
def test_pictures_of_unlike_sizes_are_refused_though_they_may_broadcast(shape: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="shapes"):
        appearance(GREY, np.full(shape, 0.5), GREY, GREY)
