"""The scene that shows a fault best, and its picture pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles import kept
from oracles.compare import compare, difference
from oracles.faults.fault import Fault
from oracles.faults.power import PRECISION, Bench, Kill, picture
from oracles.images import Picture
from reference_tracer.formulas.display import encode
from scenes.model import Scene

Codes = NDArray[np.integer[Any]]

NEARLY = 0.5
"""An earlier scene of the ladder is simpler: it is preferred if it shows this share of what the clearest shows."""
BLANK = 0.25
"""What a wrong picture of a single colour counts: it shows that something is missing, but not what became of it."""


@dataclass(frozen=True)
class Exhibit:
    """One scene rendered rightly and wrongly, as 8-bit codes (height, width, 3), and where these differ.

    outside: pixels outside their bound; finite: whether the wrong picture holds numbers only (others are shown black).
    """

    scene: Scene
    right: Codes
    wrong: Codes
    difference: Codes
    outside: int
    finite: bool


def clearest(benches: Sequence[Bench], fault: Fault, kills: Sequence[Kill]) -> str | None:
    """Name of the first scene that shows the fault nearly as clearly as any; None where no scene notices it."""
    wanted = {kill.scene for kill in kills}
    seen = {bench.scene.name: _seen(bench, fault) for bench in benches if bench.scene.name in wanted}
    if not seen:
        return None
    top = max(seen.values())
    return next(name for name, clear in seen.items() if clear >= NEARLY * top)


def _seen(bench: Bench, fault: Fault) -> float:
    """How much edges change, in codes: a wall that is shifted or a little brighter shows nobody anything."""
    shown = _shown(_finite(picture(bench.scene, fault)), bench.scene)
    off = shown - encode(bench.truth.pixels, bench.scene.display)
    edges = float(sum(np.abs(np.diff(off, axis=axis)).sum() for axis in (0, 1)))
    return edges * BLANK if (shown == shown[0, 0]).all() else edges


def exhibit(scene: Scene, fault: Fault, lanes: str = "numpy") -> Exhibit:
    """The picture pair of a scene."""
    expected = kept.truth(scene, PRECISION, lanes)
    raw = picture(scene, fault)
    holes = ~np.isfinite(raw.values).all(axis=-1)
    found = _finite(raw)
    outside = compare(found, expected).outside | holes
    return Exhibit(
        scene,
        encode(expected.pixels, scene.display),
        _shown(found, scene),
        difference(found, expected, outside),
        int(np.count_nonzero(outside)),
        not holes.any(),
    )


def _finite(found: Picture) -> Picture:
    return replace(found, values=np.nan_to_num(found.values, nan=0.0, posinf=0.0, neginf=0.0))


def _shown(found: Picture, scene: Scene) -> Codes:
    """As a viewer shows it."""
    if found.maximum is None:
        return encode(found.values, scene.display)
    codes: Codes = np.clip(found.values * 255 // found.maximum, 0, 255).astype(np.int64)
    return codes
