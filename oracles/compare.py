"""One image against its truth: inside the bound of every pixel, or not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from oracles.images.picture import Picture
from oracles.truth import ROUNDOFF, Truth
from oracles.verdict import Judged, Pixel
from reference_tracer.formulas.display import encode

Reals = NDArray[np.float64]
CHANNELS: tuple[Literal["red", "green", "blue"], ...] = ("red", "green", "blue")

ENCODING_ROUNDINGS = 8.0
"""Relative error, in units of u, that encoding a value for display may add to it: the product with
the maximum code (1u), or for sRGB a power function good to 3u whose exponent 1/2.4 makes an error
of e in the result out of 2.4 e in the argument (7.2u), and a product."""


@dataclass(frozen=True)
class Bounds:
    """Lowest and highest lawful value of each channel of each pixel, linear or in codes."""

    low: Reals
    high: Reals
    middle: Reals
    unit: Literal["linear", "code"]


@dataclass(frozen=True)
class Comparison:
    """The outcome: conforms, undecided or not; the numbers; which pixels lie outside."""

    word: Literal["pass", "fail", "undecided"]
    message: str
    judged: Judged
    outside: NDArray[np.bool_]


def bounds(picture: Picture, truth: Truth) -> Bounds:
    """The lawful range of every value, in the form in which the picture stores it."""
    if truth.transfer is not None:
        return _transferred(picture, truth, truth.transfer)
    if picture.maximum is None:
        # Storing rounds once more: relative to the value, or to the least subnormal of its format
        stored = np.abs(truth.pixels) * picture.roundoff + _least(picture.roundoff)
        reach = np.where(truth.pixels == 0.0, truth.tolerance, truth.tolerance + stored)
        return Bounds(truth.pixels - reach, truth.pixels + reach, truth.pixels, "linear")
    reach = truth.tolerance + np.abs(truth.pixels) * ENCODING_ROUNDINGS * ROUNDOFF[truth.precision]
    low, middle, high = (
        encode(value, truth.scene.display, picture.maximum).astype(np.float64)
        for value in (truth.pixels - reach, truth.pixels, truth.pixels + reach)
    )
    return Bounds(low, high, middle, "code")


def _transferred(picture: Picture, truth: Truth, transfer: Callable[[Reals], Reals]) -> Bounds:
    """The range of values that went through a transfer function; values above 1 may have been cut before it."""
    ends = (np.minimum(truth.pixels - truth.tolerance, 1.0), truth.pixels, truth.pixels + truth.tolerance)
    low, middle, high = (transfer(end) for end in ends)
    u = ENCODING_ROUNDINGS * ROUNDOFF[truth.precision] + picture.roundoff
    low, high = low - np.abs(low) * u, high + np.abs(high) * u + _least(picture.roundoff)
    if picture.maximum is None:
        return Bounds(low, high, middle, "linear")
    # Cut off or rounded to a code: nobody says which
    down, near, up = (np.clip(end, 0.0, 1.0) * picture.maximum for end in (low, middle, high))
    return Bounds(np.floor(down), np.floor(up + 0.5), np.floor(near), "code")


def _least(roundoff: float) -> float:
    """Half the spacing of subnormals of the format with that roundoff."""
    return {2.0**-24: 2.0**-150, 2.0**-11: 2.0**-25}.get(roundoff, 0.0)


def compare(picture: Picture, truth: Truth) -> Comparison:
    """Judge every pixel; nothing is exempt, doubtful pixels are held to what they may be."""
    lawful = bounds(picture, truth)
    got = picture.values
    wrong = (got < lawful.low) | (got > lawful.high)
    outside: NDArray[np.bool_] = np.any(wrong, axis=-1)
    count = int(np.count_nonzero(outside))
    decided = int(np.count_nonzero(truth.doubts == 0))
    worst = _worst(got, lawful)
    judged = Judged(
        pixels=int(outside.size),
        outside=count,
        doubtful=truth.doubtful(),
        decided=decided,
        worst=worst,
        **_sight(lawful),
    )
    if count:
        return Comparison("fail", _failure(worst, count, outside.size), judged, outside)
    if decided == 0:
        return Comparison("undecided", f"no pixel can be decided in {truth.precision}", judged, outside)
    return Comparison("pass", "every pixel lies inside its bound", judged, outside)


def _worst(got: Reals, lawful: Bounds) -> Pixel:
    """The value that lies farthest out, measured in its own tolerance."""
    error = np.abs(got - lawful.middle)
    reach = np.where(got >= lawful.middle, lawful.high - lawful.middle, lawful.middle - lawful.low)
    with np.errstate(divide="ignore", invalid="ignore"):
        excess = np.where(error == 0.0, 0.0, error / reach)
    # Among values of tolerance 0 the excess is infinite: let the larger error win
    k = int(np.lexsort((error.ravel(), excess.ravel()))[-1])
    j, i, channel = (int(x) for x in np.unravel_index(k, error.shape))
    return Pixel(
        i=i,
        j=j,
        channel=CHANNELS[channel],
        expected=float(lawful.middle[j, i, channel]),
        tolerance=float(reach[j, i, channel]),
        got=float(got[j, i, channel]),
        excess=float(excess[j, i, channel]),
        unit=lawful.unit,
    )


def _sight(lawful: Bounds) -> dict[str, Any]:
    """How small a difference the comparison sees: quantiles of the pixels' widest tolerances."""
    reach = np.maximum(lawful.high - lawful.middle, lawful.middle - lawful.low).max(axis=-1)
    median, most, worst = np.quantile(reach, [0.5, 0.99, 1.0], method="higher")
    return {"tolerance_median": float(median), "tolerance_99": float(most), "tolerance_worst": float(worst)}


def _failure(worst: Pixel, count: int, total: int) -> str:
    times = f"{worst.excess:.3g} times its tolerance" if np.isfinite(worst.excess) else "where none is tolerated"
    unit = "" if worst.unit == "linear" else " codes"
    return (
        f"{count} of {total} pixels lie outside their bound; worst is pixel ({worst.i}, {worst.j}) {worst.channel}: "
        f"expected {worst.expected:.9g} ± {worst.tolerance:.3g}{unit}, got {worst.got:.9g}, {times}"
    )


def difference(picture: Picture, truth: Truth, outside: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Codes (height, width, 3) of a difference picture.

    Pixels outside their bound: yellow to red by the size of the error; doubtful ones: blue; the
    rest black.
    """
    middle = bounds(picture, truth).middle
    error = np.abs(picture.values - middle).max(axis=-1)
    top = error[outside].max(initial=0.0)
    share = np.sqrt(np.clip(error / top, 0.0, 1.0)) if top > 0.0 else np.zeros_like(error)
    codes = np.zeros((*error.shape, 3), dtype=np.int64)
    codes[truth.doubts != 0] = (40, 60, 150)
    heat = np.stack([np.full_like(share, 255.0), 230.0 * (1.0 - share), 60.0 * (1.0 - share)], axis=-1)
    codes[outside] = heat[outside].astype(np.int64)
    return codes
