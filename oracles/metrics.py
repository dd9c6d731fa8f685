"""Numbers that people compare pictures by. They stand beside the verdict and never decide it.

Each is taken of the pictures as a screen shows them (display codes read as sRGB), but for `rmse`, which is linear. A
NaN barely moves FLIP's mean (1.7: 0.0003 for one in a 160x120 picture) and pictures of unlike sizes may broadcast, so
both are refused first.
"""

from __future__ import annotations

import math
import warnings
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from oracles.verdict import Appearance

Reals = NDArray[np.float64]
WHITE = 100.0
"""Luminance of white in cd/m², as ITU-R BT.2124 takes ΔE ITP of absolute light."""


def appearance(expected: Reals, got: Reals, shown_expected: Reals, shown_got: Reals) -> Appearance:
    """How alike two pictures (height, width, 3) look: linear values, and what is shown of them in 0..1.

    Raises ValueError for pictures of unlike sizes or with values that are not finite.
    """
    pictures = (expected, got, shown_expected, shown_got)
    if any(p.shape != expected.shape for p in pictures) or expected.ndim != 3 or expected.shape[2] != 3:
        raise ValueError(f"pictures of shapes {', '.join(str(p.shape) for p in pictures)}")
    if not all(np.isfinite(p).all() for p in pictures):
        raise ValueError("pictures with values that are not finite")
    squared = float(np.mean((shown_expected - shown_got) ** 2))
    e2000, itp = _colour_differences(shown_expected, shown_got)
    return Appearance(
        rmse=math.sqrt(float(np.mean((expected - got) ** 2))),
        psnr=10.0 * math.log10(1.0 / squared) if squared > 0.0 else math.inf,
        flip=flip(shown_expected, shown_got),
        delta_e_2000=e2000,
        delta_e_itp=itp,
    )


def flip(expected: Reals, got: Reals) -> float | None:
    """Mean FLIP (Andersson et al. 2020) at the default viewing distance; None without the package."""
    if find_spec("flip_evaluator") is None:
        return None
    import flip_evaluator

    pictures = (np.ascontiguousarray(p, dtype=np.float32) for p in (expected, got))
    return float(flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False)[1])


def _colour_differences(expected: Reals, got: Reals) -> tuple[float | None, float | None]:
    """Mean CIEDE2000 and mean ΔE ITP; None without colour-science."""
    if find_spec("colour") is None:
        return None, None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it tells of parts of itself that are not needed here
        import colour

        linear = [colour.cctf_decoding(p, function="sRGB") for p in (expected, got)]
        lab = [colour.XYZ_to_Lab(colour.RGB_to_XYZ(p, "sRGB")) for p in linear]
        wide = [colour.RGB_to_RGB(p, "sRGB", "ITU-R BT.2020") for p in linear]
        ictcp = [colour.RGB_to_ICtCp(np.maximum(p, 0.0) * WHITE) for p in wide]
        e2000 = colour.delta_E(lab[0], lab[1], method="CIE 2000")
        itp = colour.delta_E(ictcp[0], ictcp[1], method="ITP")
    return float(np.mean(e2000)), float(np.mean(itp))
