"""A comparison holds each value to its own tolerance, and says which one broke it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oracles.compare import Comparison, bounds, compare, difference
from oracles.images import Picture
from oracles.truth import ROUNDOFF, Truth, extent, lawful_offset, truth
from scenes.catalogue import rung

WIDTH, HEIGHT = 4, 3
SHAPE = (HEIGHT, WIDTH, 3)
LINEAR, SINGLE, HALF = 0.0, 2.0**-24, 2.0**-11


def made(pixels: Any, tolerance: Any, doubts: Any = 0, display: str = "lecture", precision: str = "float32") -> Truth:
    """A truth of given numbers; the scene only lends its display."""
    scene = rung("background").scene().model_copy(update={"display": display})
    return Truth(
        scene,
        precision,
        np.broadcast_to(np.asarray(pixels, float), SHAPE).copy(),
        np.broadcast_to(np.asarray(tolerance, float), SHAPE).copy(),
        np.broadcast_to(np.asarray(doubts, np.int64), SHAPE[:2]).copy(),
    )


def judge(values: NDArray[Any], against: Truth, maximum: int | None = None, roundoff: float = 0.0) -> Comparison:
    return compare(Picture(np.asarray(values, np.float64), maximum, roundoff), against)


@cache
def catalogue_truth(name: str) -> Truth:
    return truth(rung(name).scene().resized(80, 60), "float32")


NAMES = ["background", "phong-100", "shadow-hard", "glass-sphere", "facing-mirrors-3", "srgb-display", "lecture-final"]


def lecture_codes(linear: NDArray[Any], maximum: int) -> NDArray[Any]:
    return np.floor(maximum * np.clip(linear, 0.0, 1.0))


def srgb_codes(linear: NDArray[Any], maximum: int) -> NDArray[Any]:
    """IEC 61966-2-1, rounded to the nearest code."""
    c = np.clip(linear, 0.0, 1.0)
    low, high = 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055
    return np.rint(maximum * np.where(c <= 0.0031308, low, high))


STORED = {
    "float64": (lambda x: x, None, 0.0),
    "float32": (lambda x: x.astype(np.float32), None, SINGLE),
    "half": (lambda x: x.astype(np.float16), None, HALF),
}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("form", STORED)
def test_truth_against_itself_passes_in_every_linear_form(name: str, form: str) -> None:
    found = catalogue_truth(name)
    store, maximum, roundoff = STORED[form]
    outcome = judge(store(found.pixels), found, maximum, roundoff)
    assert outcome.word == "pass"
    assert outcome.judged.outside == 0
    assert not outcome.outside.any()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("maximum", [255, 65535])
def test_truth_against_itself_passes_in_codes(name: str, maximum: int) -> None:
    found = catalogue_truth(name)
    encode = srgb_codes if found.scene.display == "srgb" else lecture_codes
    assert judge(encode(found.pixels, maximum), found, maximum).word == "pass"


@pytest.mark.parametrize("name", ["srgb-display", "lecture-final"])
@pytest.mark.parametrize("maximum", [255, 65535])
def test_the_other_display_encoding_fails(name: str, maximum: int) -> None:
    found = catalogue_truth(name)
    encode = lecture_codes if found.scene.display == "srgb" else srgb_codes
    assert judge(encode(found.pixels, maximum), found, maximum).word == "fail"


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(("i", "j", "c", "channel"), [(0, 0, 0, "red"), (3, 1, 1, "green"), (2, 2, 2, "blue")])
def test_a_value_inside_its_tolerance_passes_and_is_the_worst(
    sign: float, i: int, j: int, c: int, channel: str
) -> None:
    against = made(0.5, 0.125)
    values = against.pixels.copy()
    values[j, i, c] += sign * 0.875 * 0.125
    outcome = judge(values, against)
    assert outcome.word == "pass"
    worst = outcome.judged.worst
    assert worst is not None
    assert (worst.i, worst.j, worst.channel) == (i, j, channel)
    assert worst.excess == 0.875


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(("i", "j", "c", "channel"), [(0, 0, 0, "red"), (3, 1, 1, "green"), (2, 2, 2, "blue")])
def test_a_value_outside_its_tolerance_fails_and_is_named(sign: float, i: int, j: int, c: int, channel: str) -> None:
    against = made(0.5, 0.125)
    values = against.pixels.copy()
    values[j, i, c] += sign * 1.1 * 0.125
    outcome = judge(values, against)
    assert outcome.word == "fail"
    assert np.argwhere(outcome.outside).tolist() == [[j, i]]
    assert f"1 of 12 pixels lie outside their bound; worst is pixel ({i}, {j}) {channel}: " in outcome.message
    assert f"expected 0.5 ± 0.125, got {0.5 + sign * 0.1375:.9g}, 1.1 times its tolerance" in outcome.message


@pytest.mark.parametrize(("share", "word"), [(0.9, "pass"), (1.1, "fail")])
@pytest.mark.parametrize("name", ["phong-100", "lecture-final", "facing-mirrors-3"])
def test_the_tolerance_of_a_real_scene_is_the_limit_of_its_every_value(name: str, share: float, word: str) -> None:
    found = catalogue_truth(name)
    moved = found.pixels + share * found.tolerance
    outcome = judge(moved, found)
    assert outcome.word == word
    some = (found.tolerance > 0.0).any(axis=-1)
    np.testing.assert_array_equal(outcome.outside, some & (share > 1.0))


@pytest.mark.parametrize("step", [5e-324, 1e-30, 1.0])
@pytest.mark.parametrize("roundoff", [0.0, SINGLE, HALF])
def test_a_black_pixel_of_tolerance_0_must_be_exact(step: float, roundoff: float) -> None:
    against = made(0.0, 0.0)
    values = against.pixels.copy()
    assert judge(values, against, roundoff=roundoff).word == "pass"
    values[1, 2, 0] = step
    outcome = judge(values, against, roundoff=roundoff)
    assert outcome.word == "fail"
    assert "pixel (2, 1) red: expected 0 ± 0" in outcome.message
    assert "times its tolerance" not in outcome.message


def test_a_value_of_tolerance_0_stored_in_float64_must_be_exact() -> None:
    against = made(0.3, 0.0)
    values = against.pixels.copy()
    assert judge(values, against).word == "pass"
    values[0, 0, 0] = np.nextafter(0.3, 1.0)
    assert judge(values, against).word == "fail"


@pytest.mark.parametrize(("dtype", "roundoff"), [(np.float32, SINGLE), (np.float16, HALF)])
@pytest.mark.parametrize("value", [0.3, 1.0, 100.7, 1e-5, 1e-7])
def test_a_value_of_tolerance_0_may_be_rounded_once_and_no_more(dtype: Any, roundoff: float, value: float) -> None:
    against = made(value, 0.0)
    stored = dtype(value)
    assert judge(np.full(SHAPE, stored, np.float64), against, roundoff=roundoff).word == "pass"
    further = [np.nextafter(np.nextafter(stored, dtype(way)), dtype(way)) for way in (0.0, np.inf)]
    assert all(judge(np.full(SHAPE, float(x)), against, roundoff=roundoff).word == "fail" for x in further)


@pytest.mark.parametrize("maximum", [255, 65535])
def test_the_codes_of_an_interval_are_those_of_its_ends(maximum: int) -> None:
    # 100.5 ± 1 codes of the lecture's floor: 99.5 .. 101.5, so 99, 100 and 101
    against = made(100.5 / maximum, 1.0 / maximum)
    for code, word in ((98, "fail"), (99, "pass"), (100, "pass"), (101, "pass"), (102, "fail")):
        outcome = judge(np.full(SHAPE, float(code)), against, maximum)
        assert outcome.word == word
    assert "expected 100 ± 1 codes, got 102, 2 times its tolerance" in outcome.message


def test_just_below_a_code_both_neighbours_are_lawful_and_only_they() -> None:
    against = made(100.0 / 255.0, 1e-7)
    words = [judge(np.full(SHAPE, float(code)), against, 255).word for code in (98, 99, 100, 101)]
    assert words == ["fail", "pass", "pass", "fail"]


def test_in_the_middle_of_a_code_no_other_is_lawful() -> None:
    against = made(100.5 / 255.0, 1e-7)
    words = [judge(np.full(SHAPE, float(code)), against, 255).word for code in (99, 100, 101)]
    assert words == ["fail", "pass", "fail"]


@pytest.mark.parametrize(("linear", "code"), [(7.0, 255.0), (1.001, 255.0), (-3.0, 0.0), (0.0, 0.0)])
def test_values_beyond_the_display_are_clamped(linear: float, code: float) -> None:
    assert judge(np.full(SHAPE, code), made(linear, 0.0), 255).word == "pass"
    assert judge(np.full(SHAPE, abs(code - 1.0)), made(linear, 0.0), 255).word == "fail"


def test_the_srgb_codes_of_an_interval_are_those_of_its_ends() -> None:
    # IEC 61966-2-1: the code 188 is the linear 0.5029, the slope there 255 · 1.055/2.4 · c^(-1.4/2.4) = 167.3 a unit
    against = made(0.5029, 1.0 / 167.3, display="srgb")
    words = [judge(np.full(SHAPE, float(code)), against, 255).word for code in (186, 187, 188, 189, 190)]
    assert words == ["fail", "pass", "pass", "pass", "fail"]


@pytest.mark.parametrize("doubts", [1, 2, 4])
def test_undecided_where_no_pixel_can_be_decided(doubts: int) -> None:
    outcome = judge(np.full(SHAPE, 0.5), made(0.5, 0.5, doubts))
    assert outcome.word == "undecided"
    assert outcome.message == "no pixel can be decided in float32"
    assert outcome.judged.decided == 0


def test_a_picture_without_a_decided_pixel_can_still_fail() -> None:
    assert judge(np.full(SHAPE, 2.0), made(0.5, 0.5, 1)).word == "fail"


def test_one_decided_pixel_is_enough_to_pass() -> None:
    against = made(0.5, 0.5, 1)
    against.doubts[0, 0] = 0
    outcome = judge(against.pixels, against)
    assert (outcome.word, outcome.judged.decided) == ("pass", 1)


def test_doubtful_pixels_are_counted_by_kind() -> None:
    against = made(0.5, 0.5)
    against.doubts[0] = [1, 1, 3, 4]
    outcome = judge(against.pixels, against)
    assert outcome.judged.doubtful == {"silhouette or depth order": 3, "shadow edge": 1, "critical angle": 1}
    assert outcome.judged.decided == 8


def test_the_sight_of_a_comparison_is_the_quantiles_of_the_widest_tolerances() -> None:
    against = made(0.5, 0.0)
    against.tolerance[..., 1] = np.arange(12).reshape(HEIGHT, WIDTH)
    judged = judge(against.pixels, against).judged
    # Of 0..11: the middle, rounded up, is 6; the 99th percentile and the maximum are 11
    assert (judged.tolerance_median, judged.tolerance_99, judged.tolerance_worst) == (6.0, 11.0, 11.0)


def test_an_unbounded_tolerance_lets_everything_pass_and_is_reported() -> None:
    against = made(0.5, np.inf, 1)
    against.tolerance[0, 0] = 0.125
    against.doubts[0, 0] = 0
    outcome = judge(np.where(np.isinf(against.tolerance), 1e300, 0.5), against)
    assert outcome.word == "pass"
    assert outcome.judged.tolerance_worst == np.inf


def test_the_worst_is_the_largest_error_among_those_without_tolerance() -> None:
    against = made(0.5, 0.0)
    values = against.pixels.copy()
    values[0, 0, 0], values[2, 3, 1] = 0.6, 0.9
    worst = judge(values, against).judged.worst
    assert worst is not None
    assert (worst.i, worst.j, worst.channel, worst.excess) == (3, 2, "green", np.inf)


def test_the_difference_picture_is_black_blue_and_yellow_to_red() -> None:
    against = made(0.5, 0.125)
    against.doubts[0, 1] = against.doubts[0, 2] = 1
    values = against.pixels.copy()
    values[0, 2, 0] += 1.0  # doubtful and wrong: the largest error
    values[1, 1, 2] += 0.25  # a quarter of the largest: its root is a half
    outcome = judge(values, against)
    codes = difference(Picture(values), against, outcome.outside)
    assert codes[0, 2].tolist() == [255, 0, 0]
    assert codes[1, 1].tolist() == [255, 115, 30]
    assert codes[0, 1].tolist() == [40, 60, 150]
    rest = np.ones(SHAPE[:2], bool)
    rest[0, 1] = rest[0, 2] = rest[1, 1] = False
    assert not codes[rest].any()


def test_the_difference_picture_of_a_passing_image_shows_doubts_only() -> None:
    against = made(0.5, 0.125)
    against.doubts[2, 3] = 2
    codes = difference(Picture(against.pixels), against, np.zeros(SHAPE[:2], bool))
    assert codes[2, 3].tolist() == [40, 60, 150]
    assert codes.sum() == 250


def test_bounds_of_codes_are_in_codes() -> None:
    found = bounds(Picture(np.zeros(SHAPE), 255), made(0.5, 0.0))
    assert found.unit == "code"
    assert (found.middle == 127.0).all()


def test_the_unit_roundoffs_are_those_of_ieee_754() -> None:
    for name, dtype in (("float32", np.float32), ("float64", np.float64)):
        assert ROUNDOFF[name] == np.finfo(dtype).eps / 2


def test_the_extent_of_a_scene_reaches_its_farthest_sphere_plane_or_the_eye() -> None:
    scene = rung("plane-scaled-normal").scene()
    assert extent(scene) == 2.0  # the eye; the plane is 2.5/|(0.3, 2.5, -0.4)| < 1 away
    assert extent(rung("inside-sphere").scene()) == pytest.approx(
        np.sqrt(0.34 + 2.25) + 2.5, rel=6 * 2.0**-53, abs=0.0
    )  # three of the length, one of the sum; two here


def test_the_lawful_offset_is_the_grazing_chord_of_a_float32_hit() -> None:
    # sqrt(2 · 4u·L · L) with L = 2, u = 2^-24
    assert lawful_offset(rung("background").scene()) == pytest.approx(
        2.0 * np.sqrt(8.0 * 2.0**-24), rel=4 * 2.0**-53, abs=0.0
    )  # a product and a root, here and there
