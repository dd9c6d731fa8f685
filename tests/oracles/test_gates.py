"""Other suites' gates say what their rules say, to the threshold."""

from __future__ import annotations

import numpy as np
import pytest

from oracles import gates
from oracles.faults import fault
from oracles.faults.power import Bench, picture
from oracles.gates import GATES, Codes
from reference_tracer.formulas.display import encode
from scenes.catalogue import rung


def grey(height: int = 20, width: int = 20, code: int = 100) -> Codes:
    return np.full((height, width, 3), code)


@pytest.mark.parametrize("name", GATES)
def test_a_picture_passes_against_itself_and_black_fails_against_white(name: str) -> None:
    if name.startswith("mean FLIP"):
        pytest.importorskip("flip_evaluator")
    assert not GATES[name](grey(), grey())
    assert GATES[name](grey(code=0), grey(code=255))


@pytest.mark.parametrize(
    ("pixels", "step", "fails"), [(4, 255 - 100, False), (5, 5, True), (5, 4, False), (400, 4, False)]
)
def test_blender_fails_more_than_1_percent_of_pixels_off_by_more_than_4_codes(
    pixels: int, step: int, fails: bool
) -> None:
    got = grey()
    got.reshape(-1, 3)[:pixels, 1] += step
    assert gates.blender(grey(), got) is fails


@pytest.mark.parametrize(("step", "fails"), [(2, False), (3, True)])
def test_psnr_fails_where_all_is_off_by_a_hundredth(step: int, fails: bool) -> None:
    """40 dB is a root mean square of 0.01, 2.55 codes."""
    assert gates.psnr(grey(), grey(code=100 + step)) is fails


@pytest.mark.parametrize(("step", "fails"), [(26, False), (27, True)])
def test_pixelmatch_tolerates_a_tenth_of_the_largest_difference(step: int, fails: bool) -> None:
    """Grey has no I and Q: 0.5053·step² against 35215/100, so 26.4 codes."""
    got = grey()
    got[7, 7] += step
    assert gates.pixelmatch(grey(), got) is fails


def test_pixelmatch_takes_a_pixel_between_two_flat_areas_for_smoothed() -> None:
    expected, got = grey(code=0), grey(code=0)
    expected[:, 10:] = got[:, 10:] = 255
    got[:, 9] = 128
    assert not gates.pixelmatch(expected, got)
    got[5, 3] = 128  # in the middle of the dark, neither between nor smooth
    assert gates.pixelmatch(expected, got)


def test_pixelmatch_counts_a_border_as_one_flat_neighbour() -> None:
    expected, got = grey(code=0), grey(code=0)
    got[0, 0] = 200
    assert gates.pixelmatch(expected, got)


def test_flip_without_its_package_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("oracles.metrics.find_spec", lambda name: None)
    with pytest.raises(ImportError, match="pip install"):
        gates.mean_flip(grey(), grey(code=101))


def test_a_highlight_of_one_more_exponent_is_seen_by_us_only() -> None:
    """What the table is about: an exponent of 101 for 100 passes every one of the gates."""
    pytest.importorskip("flip_evaluator")
    scene, entry = rung("phong-100").scene(), fault("exponent-plus-1")
    bench = Bench(scene)
    got = encode(picture(scene, entry).values, scene.display)
    expected = encode(bench.truth.pixels, scene.display)
    assert bench.kill(entry)
    assert [name for name, gate in GATES.items() if gate(expected, got)] == []
