"""Which laws notice which fault, and by how many tolerances."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from oracles import kept
from oracles.faults.fault import Fault, Twin
from oracles.faults.power import PRECISION, picture, touches
from oracles.images import ImageError, Picture
from oracles.images.picture import check
from oracles.laws import Law, formula_laws
from oracles.laws.cases import CASES, reading
from oracles.laws.dice import repeated, seeded
from oracles.laws.law import NoAnswerError
from oracles.laws.pictures import PictureLaw, Sight, picture_laws, sight
from oracles.needs import FEATURES
from oracles.truth import Truth
from reference_tracer.operations import formulas
from scenes.model import Scene

Entry = Fault | Twin

ENTRIES = {
    "sphere": {"sphere_distances", "sphere_hit"},
    "plane": {"plane_hit"},
    "normal": {"sphere_normal"},
    "reflect": {"reflect"},
    "refract": {"face", "refract"},
    "phong": {"lambert", "phong", "reflect"},
    "camera": {"plane_point", "camera_ray"},
}
"""The rulebook's entries that an operation of the probe asks; `trace` asks them all."""


@dataclass(frozen=True)
class LawKill:
    """A law that a fault breaks, and by how many tolerances (inf: none was allowed, or nothing was answered)."""

    law: str
    excess: float


class LawBench:
    """All laws, put to faults in float32: the fixed cases of `raycheck check`; no picture of the reference twice."""

    def __init__(self, lanes: str = "numpy") -> None:
        self.lanes = lanes
        self.formulas: tuple[Law, ...] = formula_laws()
        self.pictures: tuple[PictureLaw, ...] = picture_laws()
        self.truths: dict[str, Truth] = {}
        self.right: dict[str, Sight] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """All laws, in the book's order."""
        return (*(law.name for law in self.formulas), *(law.name for law in self.pictures))

    def kills(self, entry: Entry) -> Iterator[LawKill]:
        """Every law that the fault or twin breaks, in the book's order."""
        for law in self.formulas:
            excess = formula_excess(law, entry)
            if excess > 1.0:
                yield LawKill(law.name, excess)
        studio = FaultyStudio(entry, self)
        for shown in self.pictures:
            excess = studio.excess(shown)
            if excess > 1.0:
                yield LawKill(shown.name, excess)

    def truth(self, scene: Scene, name: str) -> Truth:
        """The scene's truth; name: its content hash."""
        if name not in self.truths:
            self.truths[name] = kept.truth(scene, PRECISION, self.lanes)
        return self.truths[name]


def formula_excess(law: Law, entry: Entry) -> float:
    """By how many tolerances the law of formulas is broken; 0 where it does not ask what the entry changes."""
    if not asks(law, entry.entries):
        return 0.0
    ask = formulas("numpy", _bits(entry), entry.rules)
    return float(reading(law, seeded(CASES, PRECISION, 0), ask).excess().max())


def asks(law: Law, entries: frozenset[str]) -> bool:
    """Whether the law's questions can depend on these entries of a rulebook."""
    return bool(entries) and any(operation == "trace" or ENTRIES[operation] & entries for operation in law.asks)


class FaultyStudio:
    """A tracer with this entry of the dictionary, as laws of pictures ask it; it draws no scene twice."""

    features = frozenset(FEATURES)

    def __init__(self, entry: Entry, bench: LawBench) -> None:
        self.entry, self.bench = entry, bench
        self.shown: dict[str, Sight] = {}

    def excess(self, law: PictureLaw) -> float:
        """By how many tolerances the plain case of the law is broken; inf where a picture is none."""
        try:
            with np.errstate(all="ignore"):
                return float(law.test(repeated(np.zeros((1, 0)), PRECISION), self).excess().max())
        except NoAnswerError:
            return inf

    def show(self, scene: Scene) -> Sight:
        """Its picture; the reference's where the entry cannot touch it. Raise NoAnswerError where it is none."""
        name = scene.content_hash()
        same = _is_reference(self.entry, scene)
        shown = self.bench.right if same else self.shown
        if name not in shown:
            try:
                found = check(self._picture(scene))
            except ImageError as error:
                raise NoAnswerError("invalid", str(error)) from None
            shown[name] = sight(found, self.bench.truth(scene, name))
        return shown[name]

    def _picture(self, scene: Scene) -> Picture:
        drawn = self.entry.scene(scene) if isinstance(self.entry, Twin) else scene
        return picture(drawn, self.entry, _bits(self.entry))


def _bits(entry: Entry) -> int:
    return entry.precision if isinstance(entry, Twin) else 32


def _is_reference(entry: Entry, scene: Scene) -> bool:
    """Whether the entry's picture of this scene is the reference's own, bit for bit."""
    return isinstance(entry, Fault) and entry.picture is None and not touches(scene, entry.entries)
