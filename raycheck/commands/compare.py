"""raycheck compare: one image against one golden."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import replace
from pathlib import Path

import numpy as np

from oracles.compare import compare
from oracles.golden import GoldenError, load
from oracles.golden.record import Golden
from oracles.images import ImageError, Picture, read
from oracles.metrics import appearance
from oracles.truth import DOUBTS, truth
from raycheck.errors import CONFORMS, DIFFERS, UsageError
from raycheck.lanes import best_lanes
from reference_tracer.dialects import rules
from reference_tracer.formulas.display import encode

PRECISIONS = {"32": "float32", "64": "float64", "8bit": "float32"}


def run(options: Namespace) -> int:
    """Judge, and tell every number."""
    try:
        golden = load(Path(options.golden))
        picture = read(Path(options.image), golden.scene.image.width, golden.scene.image.height)
    except GoldenError as error:
        raise UsageError(str(error)) from None
    except ImageError as error:
        print(f"invalid: {options.image}: {error}")
        return DIFFERS
    if options.precision == "8bit" and picture.maximum is None:
        picture = Picture(encode(picture.values, golden.scene.display).astype(np.float64), 255)
    expected = truth(golden.scene, PRECISIONS[options.precision], best_lanes(), rules(golden.dialect))
    # The tolerance was taken about the lanes' value; the golden lies within its own bound of it
    reach = expected.tolerance + np.abs(expected.pixels - golden.value) + golden.bound
    found = compare(picture, replace(expected, pixels=golden.value, tolerance=reach))
    judged, worst = found.judged, found.judged.worst
    print(f"{found.word}: {found.message}")
    if worst:
        place = f"pixel ({worst.i}, {worst.j}) {worst.channel}"
        numbers = f"expected {worst.expected:.9g} ± {worst.tolerance:.3g}, got {worst.got:.9g}"
        print(f"worst: {place}: {numbers} ({worst.unit}), {worst.excess:.3g} of its tolerance")
    doubts = ", ".join(f"{words} {judged.doubtful[words]}" for words in DOUBTS.values() if words in judged.doubtful)
    print(f"pixels: {judged.outside} of {judged.pixels} outside, in doubt: {doubts or 'none'}")
    seen = f"median {judged.tolerance_median:.3g}, 99 % {judged.tolerance_99:.3g}, worst {judged.tolerance_worst:.3g}"
    print(f"tolerance: {seen}")
    print(f"elsewhere: {_looks(picture, golden)}")
    return CONFORMS if found.word == "pass" else DIFFERS


def _looks(picture: Picture, golden: Golden) -> str:
    """What other tools would say; no part of the verdict."""
    display = golden.scene.display
    shown = encode(golden.value, display) / 255.0
    if picture.maximum is not None:
        got = picture.values / picture.maximum
        a = appearance(shown, got, shown, got)
    else:
        a = appearance(golden.value, picture.values, shown, encode(picture.values, display) / 255.0)
    words = {"RMSE": a.rmse, "PSNR": a.psnr, "FLIP": a.flip, "ΔE 2000": a.delta_e_2000, "ΔE ITP": a.delta_e_itp}
    return ", ".join(f"{word} {x:.3g}" for word, x in words.items() if x is not None)
