"""What the gates of other suites say of two pictures of 8-bit codes: nothing here decides a verdict of ours.

Each gate takes the expected and the got picture, (height, width, 3) codes of 0..255, and says whether it fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from oracles.metrics import flip

Codes = NDArray[np.int64]
Reals = NDArray[np.float64]
Gate = Callable[[Codes, Codes], bool]

TOLERATED, SHARE = 0.016, 0.01
"""Blender, tests/python/modules/render_report.py: `--fail 0.016 --failpercent 1`."""
MEAN_FLIP = 0.05
"""MaterialX, diff_test_runs/diff_images.py."""
REACH = 10
"""Pixels that FLIP's widest filter reaches at 67 a degree: 3·sqrt(0.04/2π²)·67 = 9.05 (Andersson et al. 2020)."""
PEAK = 40.0
"""dB."""
YIQ = np.array(
    [
        [0.29889531, 0.58662247, 0.11448223],
        [0.59597799, -0.27417610, -0.32180189],
        [0.21147017, -0.52261711, 0.31114694],
    ]
)
"""Of gamma-encoded R, G, B (NTSC)."""
YIQ_WEIGHTS = np.array([0.5053, 0.299, 0.1957])
YIQ_LARGEST = 35215.0
"""Weighted square of the largest difference of two colours: Kotsarenko & Ramos, Measuring perceived color difference
using YIQ NTSC transmission color space in mobile applications, 2010."""
THRESHOLD = 0.1
"""pixelmatch's default."""


def blender(expected: Codes, got: Codes) -> bool:
    """More than 1 % of the pixels have a channel that is off by more than 0.016 of white."""
    off = np.abs(expected - got).max(axis=-1) > TOLERATED * 255.0
    return float(np.mean(off)) > SHARE


def mean_flip(expected: Codes, got: Codes) -> bool:
    """The mean of FLIP's map exceeds 0.05; not asked where the map is 0 in more than 95 % of the picture."""
    if np.mean(_widened(np.any(expected != got, axis=-1))) <= MEAN_FLIP:
        return False
    found = flip(expected / 255.0, got / 255.0)
    if found is None:
        raise ImportError("flip-evaluator is missing: pip install 'raycheck[peers]'")
    return found > MEAN_FLIP


def _widened(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask and all pixels so near to it that FLIP's filters carry a difference there."""
    for axis in (0, 1):
        held = np.pad(mask, [(REACH, REACH) if k == axis else (0, 0) for k in range(2)])
        views = np.lib.stride_tricks.sliding_window_view(held, 2 * REACH + 1, axis=axis)
        mask = np.asarray(np.any(views, axis=-1))
    return mask


def psnr(expected: Codes, got: Codes) -> bool:
    """The peak signal-to-noise ratio is below 40 dB."""
    squared = float(np.mean(((expected - got) / 255.0) ** 2))
    return squared > 0.0 and -10.0 * math.log10(squared) < PEAK


def pixelmatch(expected: Codes, got: Codes) -> bool:
    """A pixel differs by more than the default threshold and is not an anti-aliased one.

    The algorithm is that of pixelmatch's README: squared distance in YIQ, and V. Vyšniauskas, Anti-aliased Pixel and
    Intensity Slope Detector, 2009.
    """
    distance = ((expected - got) @ YIQ.T) ** 2 @ YIQ_WEIGHTS
    places = np.argwhere(distance > YIQ_LARGEST * THRESHOLD * THRESHOLD)
    return any(not _smoothed(expected, got, j, i) and not _smoothed(got, expected, j, i) for j, i in places.tolist())


def _smoothed(picture: Codes, other: Codes, j: int, i: int) -> bool:
    """Whether the pixel lies between a darker and a brighter neighbour of which one stands in a flat area of both."""
    around = _around(picture, j, i)
    steps = [float((picture[j, i] - picture[place]) @ YIQ[0]) for place in around]
    if steps.count(0.0) + (len(around) < 8) > 2 or min(steps) >= 0.0 or max(steps) <= 0.0:
        return False
    ends = (around[steps.index(min(steps))], around[steps.index(max(steps))])
    return any(_flat(picture, *end) and _flat(other, *end) for end in ends)


def _flat(picture: Codes, j: int, i: int) -> bool:
    """Whether three neighbours or more have the very colour; the border counts as one."""
    around = _around(picture, j, i)
    same = sum(bool(np.array_equal(picture[place], picture[j, i])) for place in around)
    return same + (len(around) < 8) > 2


def _around(picture: Codes, j: int, i: int) -> list[tuple[int, int]]:
    """The neighbours of a pixel in the picture, column by column."""
    height, width = picture.shape[:2]
    return [
        (y, x)
        for x in range(max(i - 1, 0), min(i + 2, width))
        for y in range(max(j - 1, 0), min(j + 2, height))
        if (y, x) != (j, i)
    ]


GATES: dict[str, Gate] = {
    "Blender, 0.016 and 1 %": blender,
    "mean FLIP 0.05": mean_flip,
    "pixelmatch, 0.1": pixelmatch,
    "PSNR 40 dB": psnr,
}
"""By the words of the table."""
