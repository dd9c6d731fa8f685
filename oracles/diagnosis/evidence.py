"""What a tracer's pictures say for and against a set of faults, pixel by pixel."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from oracles.compare import Bounds, bounds
from oracles.faults import Fault
from oracles.faults.fault import Written
from oracles.faults.power import touches
from oracles.inference import Exhibit
from oracles.truth import Truth
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render, render_pixels
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

Reals = NDArray[np.float64]
Faults = frozenset[str]
RIGHT, MENDED = 0.99, 0.9
"""Shares of the pixels looked at, all and wrong ones, inside their bounds, from which a picture counts as explained.

Not all: a tracer's own rounding decides differently on outlines that a fault has moved, where no doubt is known.
"""

REMAINS = 1 / 8
"""Of a wrong value's error, the most that may remain where a fault explains it."""

STRETCH = 256.0
"""A wrong way to write makes errors larger by this at most: a float that should have been one of 0 to 1."""
ROOM = 2**26
"""Bytes of whole pictures kept for each scene."""


@dataclass(frozen=True)
class Reading:
    """A picture under a hypothesis.

    share: of the pixels looked at, how many are inside their bounds; mended: of the wrong ones among them; residual:
    sum of what lies outside; offset: mean distance from the predicted value, for choosing among hypotheses that
    explain all alike.
    """

    share: float
    mended: float
    residual: float
    offset: float

    @property
    def right(self) -> bool:
        """Whether the hypothesis explains the picture."""
        return self.share >= RIGHT and self.mended >= MENDED


def composed(base: Rulebook, faults: Iterable[Fault]) -> Rulebook:
    """The rulebook with the wrong entries of all these faults."""
    entries = {name: getattr(fault.rules, name) for fault in faults for name in fault.entries}
    return replace(base, name="diagnosis", **entries)


def composable(first: Fault, second: Fault) -> bool:
    """Whether both can be in one tracer: they are in different formulas, and one at most in the writing."""
    return not first.entries & second.entries and not (first.picture and second.picture)


def rendered(scene: Scene, rules: Rulebook) -> Reals:
    """The whole picture in float64, (height, width, 3), linear."""
    return np.asarray(render(scene, NumPyBackend(64), rules).pixels, dtype=np.float64)


class Witness:
    """One exhibit, read at some of its clear pixels: where it is wrong, and all over."""

    def __init__(self, exhibit: Exhibit, base: Rulebook = LECTURE, pixels: NDArray[np.int64] | None = None) -> None:
        self.exhibit, self.base = exhibit, base
        self.pixels = exhibit.pixels() if pixels is None else pixels
        self.got = replace(exhibit.picture, values=self._flat(exhibit.picture.values))
        self.kept: dict[Rulebook, Reals] = {}
        self.alone: dict[Written, bool] = {}
        self.failing = bool(exhibit.wrong.ravel()[self.pixels].any())

    @property
    def scene(self) -> Scene:
        """What the picture shows."""
        return self.exhibit.scene

    @property
    def cost(self) -> int:
        """Grows with the rays of a picture: a measure of how simple a scene is."""
        scene = self.scene
        return scene.depth * len(scene.objects) * max(1, len(scene.lights))

    @cached_property
    def plain(self) -> Reading:
        """The picture as it should be."""
        return self.read(())

    def read(self, faults: Sequence[Fault]) -> Reading:
        """The picture if the tracer has these faults."""
        return self._reading(self.lawful(faults))

    def lawful(self, faults: Sequence[Fault]) -> Bounds:
        """What the pixels looked at may be if the tracer has these faults, (1, n, 3)."""
        with np.errstate(all="ignore"):  # a wrong formula may give anything
            return self._lawful(faults)

    def _lawful(self, faults: Sequence[Fault]) -> Bounds:
        rules = composed(self.base, faults)
        write = next((fault.picture for fault in faults if fault.picture), None)
        if write is not None:
            return self._written(write, rules if any(fault.entries for fault in faults) else None)
        if not faults:
            return self._right
        return self._bounds(render_pixels(self.scene, self.pixels, rules))

    @cached_property
    def _right(self) -> Bounds:
        truth = self.exhibit.declared
        return self._bounds(self._flat(truth.pixels), self._tolerance)

    def change(self, fault: Fault) -> tuple[Reals, NDArray[np.bool_]]:
        """How far a fault moves each pixel, (n, 3), and which pixels it moves out of their bounds."""
        if not touches(self.scene, fault.entries):
            return np.zeros((self.pixels.size, 3)), np.zeros(self.pixels.size, dtype=bool)
        right, wrong = self.lawful(()), self.lawful((fault,)).middle
        outside = (wrong < right.low) | (wrong > right.high)
        with np.errstate(all="ignore"):
            return np.nan_to_num(wrong - right.middle)[0], np.any(outside[0], axis=-1)

    def writes(self, fault: Fault) -> bool:
        """Whether the fault is one of writing files of this picture's form."""
        form = fault.picture(self.exhibit.declared.pixels, self.scene) if fault.picture else None
        return form is not None and form.maximum == self.got.maximum

    def whole(self, faults: Sequence[Fault]) -> Reading:
        """The picture at all its clear pixels, if the tracer has these faults."""
        return Witness(self.exhibit, self.base, self.exhibit.clear()).read(faults)

    def _written(self, write: Written, rules: Rulebook | None) -> Bounds:
        """What stands in the file; by the whole picture, unless each pixel is written by itself."""
        pointwise = self._pointwise(write)
        if rules is None:
            whole = self.exhibit.declared.pixels
            linear = self._flat(whole) if pointwise else whole
        else:
            linear = render_pixels(self.scene, self.pixels, rules) if pointwise else self._rendered(rules)
        reach = self.exhibit.reach
        pictures = [write(pixels, self.scene) for pixels in (linear - reach, linear, linear + reach)]
        low, middle, high = (picture.values if pointwise else self._flat(picture.values) for picture in pictures)
        if pictures[1].maximum is None:
            moved = np.maximum(np.abs(high - middle), np.abs(middle - low))  # a wrong way to write may stretch errors
            return self._bounds(middle, self._reach(np.nan_to_num(moved)))
        if pictures[1].maximum != self.got.maximum:
            return self.lawful(())  # another form of file than the tracer writes
        return self._codes(np.stack([low, middle, high]))

    def _pointwise(self, write: Written) -> bool:
        """Whether what is written of a pixel depends on that pixel alone, as far as the right picture shows."""
        if write not in self.alone:
            whole = self.exhibit.declared.pixels
            some, all_ = write(self._flat(whole), self.scene), write(whole, self.scene)
            self.alone[write] = np.array_equal(some.values, self._flat(all_.values))
        return self.alone[write]

    def _codes(self, codes: Reals) -> Bounds:
        """Of the codes that the lower end, the middle and the upper end of a value become, and all between neighbours.

        Where a byte wraps around, the ends are far apart, and nothing between them is lawful.
        """
        low, middle, high = codes.min(axis=0), codes[1], codes.max(axis=0)
        nearest = np.take_along_axis(codes, np.abs(codes - self.got.values).argmin(axis=0)[None], axis=0)[0]
        wraps = high - low > self.got.maximum / 2 if self.got.maximum else np.zeros(low.shape, dtype=bool)
        return Bounds(np.where(wraps, nearest, low), np.where(wraps, nearest, high), middle, "code")

    def _flat(self, picture: Reals) -> Reals:
        """The pixels looked at, (1, n, 3)."""
        return picture.reshape(1, -1, 3)[:, self.pixels]

    def _rendered(self, rules: Rulebook) -> Reals:
        """The whole picture; kept, while there is room, for the next way of writing it."""
        if rules not in self.kept:
            found = rendered(self.scene, rules)
            if len(self.kept) >= max(1, ROOM // found.nbytes):
                self.kept.clear()
            self.kept[rules] = found
        return self.kept[rules]

    def _bounds(self, linear: Reals, reach: Reals | None = None) -> Bounds:
        truth = self.exhibit.declared
        doubts = np.zeros(linear.shape[:2], dtype=np.int64)
        far = self._reach() if reach is None else reach
        return bounds(self.got, Truth(self.scene, truth.precision, linear, far, doubts, truth.transfer))

    def _reach(self, moved: Reals | None = None) -> Reals:
        """How far from what is predicted a value may lie, (1, n, 3); moved: what its tolerance becomes in the file.

        Tolerances are proven for the right formulas only; a wrong one may take another path, so what 99 % of the
        pixels keep is granted to all. But where the picture is wrong, no more than a part of the error may remain.
        """
        granted = self.exhibit.reach
        if moved is None:
            return np.maximum(self._tolerance, np.minimum(self._remains, granted))
        stretched = np.clip(moved, granted, STRETCH * granted)
        return np.maximum(self._tolerance, np.minimum(self._remains, stretched))

    @cached_property
    def _tolerance(self) -> Reals:
        return self._flat(self.exhibit.declared.tolerance)

    @cached_property
    def _remains(self) -> Reals:
        """The part of each value's error that may remain, inf where there is none."""
        lawful, got = self._right, self.got.values
        error = np.maximum(np.maximum(lawful.low - got, got - lawful.high), 0.0) / (self.got.maximum or 1.0)
        return np.where(error > 0.0, error * REMAINS, np.inf)

    def _reading(self, lawful: Bounds) -> Reading:
        got = self.got.values
        if not got.size:
            return Reading(1.0, 1.0, 0.0, 0.0)
        low, middle, high = lawful.low, lawful.middle, lawful.high
        inside = np.all((got >= low) & (got <= high), axis=-1).reshape(1, -1)
        worst = self._scale
        with np.errstate(invalid="ignore", over="ignore"):
            out = np.nan_to_num(np.maximum(np.maximum(low - got, got - high), 0.0), nan=worst, posinf=worst)
            off = np.nan_to_num(np.abs(got - middle), nan=worst, posinf=worst)
        outside = np.minimum(out.max(axis=-1), worst)
        wrong = inside[0][self.exhibit.wrong.ravel()[self.pixels]]
        mended = float(wrong.mean()) if wrong.size else 1.0
        return Reading(float(inside.mean()), mended, float(outside.sum()), float(np.minimum(off, worst).mean()))

    @cached_property
    def _scale(self) -> float:
        """The largest value that counts: what is farther off is as wrong as can be."""
        top = self.exhibit.picture.maximum or max(1.0, float(self.exhibit.declared.pixels.max(initial=0.0)))
        return 2.0 * float(top)


class Evidence:
    """All pictures of a tracer, and what each hypothesis makes of them.

    cleared: entries of the rulebook that the tracer's own answers, formula by formula, show to be right.
    """

    def __init__(
        self, exhibits: Iterable[Exhibit], base: Rulebook = LECTURE, cleared: frozenset[str] = frozenset()
    ) -> None:
        self.base, self.cleared = base, cleared
        self.witnesses = [Witness(exhibit, base) for exhibit in exhibits]
        self.readings: dict[tuple[str, Faults], Reading] = {}

    @property
    def failing(self) -> list[Witness]:
        """Those whose picture is wrong, at pixels that are in no doubt."""
        return [witness for witness in self.witnesses if witness.failing]

    def read(self, witness: Witness, faults: Sequence[Fault]) -> Reading:
        """One picture under a hypothesis; each is computed once."""
        live = [fault for fault in faults if touches(witness.scene, fault.entries)]
        if not live:
            return witness.plain
        key = (witness.scene.name, frozenset(fault.name for fault in live))
        if key not in self.readings:
            self.readings[key] = witness.read(live)
        return self.readings[key]
