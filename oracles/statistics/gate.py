"""The verdict on a stochastic tracer: whether its mean is the right one.

Three questions share the false-alarm rate alpha equally, and each corrects for its number of tests (Šidák; among
dependent tests Bonferroni's bound is within alpha/2 of it at these rates):

- the whole image, each channel: Welch's t of the renders' means against the reference's;
- each tile of TILE x TILE pixels, each channel: the same;
- each value of each pixel: Hoeffding's inequality (1963, theorem 1), which holds for any distribution on a known
  range, where t fails: a pixel lit by one path in fifty often shows no variance at all. The range is the brightest
  colour a ray of the scene can have, and a path may carry up to twice its worth a generation (a coin for each branch).

Float32 rounding is a bias, not noise: a difference counts only beyond the mean tolerance of the decided pixels and what
adding up the samples may lose.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from oracles.statistics.student import Welch, critical, sidak, two_sided, welch
from oracles.truth import ROUNDOFF, Truth
from oracles.verdict import Sampled
from reference_tracer.lanes import span
from reference_tracer.rulebook import LECTURE

Reals = NDArray[np.float64]
ALPHA = 0.01
"""Rate at which a right tracer fails, in all."""
POWER = 0.9
TILE = 8
BINS = 10


@dataclass(frozen=True)
class Samples:
    """A tracer's renders (runs, height, width, 3), each of `spp` samples a pixel, of seeds of their own."""

    values: Reals
    spp: int


@dataclass(frozen=True)
class Found:
    """The outcome and its numbers."""

    word: Literal["pass", "fail"]
    message: str
    sampled: Sampled
    outside: NDArray[np.bool_]
    """Pixels (height, width) of tiles or values that failed."""


def judge(samples: Samples, reference: Reals, truth: Truth) -> Found:
    """Compare a tracer's renders with units of the reference; both of at least two."""
    decided = truth.doubts == 0
    allowed = truth.tolerance[decided].mean(axis=0) if decided.any() else np.zeros(3)
    # Adding up n samples in the tracer's precision may lose n u of the sum
    allowed = allowed + samples.spp * ROUNDOFF[truth.precision] * np.abs(truth.pixels).max(axis=(0, 1))
    share = ALPHA / 3.0
    whole = welch(samples.values.mean(axis=(1, 2)), reference.mean(axis=(1, 2)))
    tiles = welch(_tiled(samples.values), _tiled(reference))
    p_whole, p_tiles = _p_values(whole, allowed), _p_values(tiles, allowed)
    bad_tiles = np.any(p_tiles < sidak(share, p_tiles.size), axis=-1)
    spots = _spots(samples, reference, truth, share)
    image_is_off = bool(np.any(p_whole < sidak(share, p_whole.size)))
    sampled = Sampled(
        runs=len(samples.values),
        spp=samples.spp,
        alpha=ALPHA,
        p_image=float(p_whole.min()),
        p_tile=float(p_tiles.min()),
        tiles=int(bad_tiles.size),
        tiles_outside=int(np.count_nonzero(bad_tiles)),
        spots=int(np.count_nonzero(spots)),
        histogram=tuple(int(n) for n in np.histogram(p_tiles[tiles.error > allowed], bins=BINS, range=(0.0, 1.0))[0]),
        smallest_bias=_power(whole, reference, allowed, share),
    )
    wrong = image_is_off or bool(bad_tiles.any()) or bool(spots.any())
    outside = spots | np.kron(bad_tiles, np.ones((TILE, TILE), dtype=bool))[: spots.shape[0], : spots.shape[1]]
    return Found("fail" if wrong else "pass", _message(sampled, image_is_off), sampled, outside)


def _tiled(values: Reals) -> Reals:
    """Means (units, tile rows, tile columns, 3); tiles at the right and lower edge may be smaller."""
    rows, columns = (np.arange(0, size, TILE) for size in values.shape[1:3])
    sums = np.add.reduceat(np.add.reduceat(values, rows, axis=1), columns, axis=2)
    heights, widths = (
        np.diff(np.append(starts, size)) for starts, size in zip((rows, columns), values.shape[1:3], strict=True)
    )
    return np.asarray(sums / (heights[:, None] * widths)[None, :, :, None])


def _p_values(found: Welch, allowed: Reals) -> Reals:
    """Two-sided, of what the difference exceeds the allowed one by."""
    beyond = np.maximum(np.abs(found.difference) - allowed, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.where(beyond > 0.0, beyond / found.error, 0.0)
    flat = [two_sided(float(x), float(v)) for x, v in zip(t.ravel(), found.freedom.ravel(), strict=True)]
    return np.array(flat).reshape(t.shape)


def _spots(samples: Samples, reference: Reals, truth: Truth, alpha: float) -> NDArray[np.bool_]:
    """Pixels with a value farther from the reference than any lawful mean of that many samples."""
    top = np.array([high for _, high in span.colours(truth.scene, LECTURE, 0.0)[0]])
    each = sidak(alpha / 2.0, samples.values[0].size)
    reach = top * 2.0**truth.scene.depth * _hoeffding(each, len(samples.values) * samples.spp)
    reach = reach + top * _hoeffding(each, len(reference))
    away = np.abs(samples.values.mean(axis=0) - reference.mean(axis=0))
    return np.asarray(np.any(away > reach + truth.tolerance, axis=-1))


def _hoeffding(p: float, n: int) -> float:
    """How far the mean of n independent values in [0, 1] may lie from its expectation at rate p."""
    return math.sqrt(math.log(2.0 / p) / (2.0 * n))


def _power(whole: Welch, reference: Reals, allowed: Reals, alpha: float) -> float:
    """Smallest relative bias of the whole image that this run would have seen with probability POWER."""
    means = reference.mean(axis=(0, 1, 2))
    seen = []
    for error, freedom, mean, least in zip(whole.error, whole.freedom, means, allowed, strict=True):
        needed = critical(sidak(alpha, 3), float(freedom)) + critical(2.0 * (1.0 - POWER), float(freedom))
        if mean > 0.0:
            seen.append(float(error * needed + least) / float(mean))
    return min(seen, default=math.inf)


def _message(s: Sampled, image_is_off: bool) -> str:
    power = f"a bias of {100.0 * s.smallest_bias:.2g} % would have been seen"
    if not (image_is_off or s.tiles_outside or s.spots):
        return f"no bias found in {s.runs} renders of {s.spp} samples; {power} ({100.0 * POWER:.0f} %)"
    parts = [f"the image's mean is off (p = {s.p_image:.2g})"] if image_is_off else []
    if s.tiles_outside:
        parts.append(f"{s.tiles_outside} of {s.tiles} tiles are off (least p = {s.p_tile:.2g})")
    if s.spots:
        parts.append(f"{s.spots} pixels lie where no lawful mean lies")
    return f"{'; '.join(parts)}; {s.runs} renders of {s.spp} samples"
