"""Which conventions a tracer follows, found from its pictures alone.

A convention is a hypothesis like any other: under the right one the pictures lie inside their bounds. The search
only chooses what to try, from some clear pixels of each picture; what it finds is accepted by the same rigorous
comparison as any verdict (`worth_saying`), so a wrong guess costs time and nothing else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.compare import bounds
from oracles.conventions import SLIPS, Convention, Slip, transfer_of
from oracles.images.picture import Picture
from oracles.truth import Truth
from reference_tracer.dialects import CHOICES, SCENE_MODEL, Dialect
from reference_tracer.lanes.render import render_pixels
from scenes.model import Scene

Reals = NDArray[np.float64]
TELLING, OTHERS = 300, 200
"""Pixels of a picture that the search looks at: of those that are wrong as declared, and of all."""
SIMPLEST = 12
"""Scenes by which slips of the picture are told: the first of the ladder, which ask for little else."""
ROUNDS = 6
"""Conventions found one after the other before the search gives up."""

Told = Callable[[str], Any]


@dataclass(frozen=True)
class Exhibit:
    """The picture that a tracer made of a scene, its truth as declared, and which pixels are wrong, (height, width)."""

    picture: Picture
    declared: Truth
    wrong: NDArray[np.bool_]

    @property
    def scene(self) -> Scene:
        """What the picture shows."""
        return self.declared.scene

    @cached_property
    def reach(self) -> float:
        """A tolerance that 99 % of the pixels keep."""
        return float(np.quantile(self.declared.tolerance.max(axis=-1), 0.99, method="higher"))

    def pixels(self) -> NDArray[np.int64]:
        """The pixels to look at, counted row by row: clear ones, most of them wrong."""
        clear = self.clear()
        telling = _spread(clear[self.wrong.ravel()[clear]], TELLING)
        return np.union1d(telling, _spread(clear, OTHERS))

    def clear(self) -> NDArray[np.int64]:
        """All pixels that are in no doubt and of no wide tolerance, counted row by row."""
        return np.flatnonzero((self.declared.doubts == 0) & (self.declared.tolerance.max(axis=-1) <= self.reach))


def _spread(indices: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """At most so many of them, evenly."""
    return indices[np.linspace(0, indices.size - 1, min(indices.size, most)).astype(np.int64)]


class _Search:
    """Shares of pixels inside their bounds, by exhibit and hypothesis."""

    def __init__(self, exhibits: Sequence[Exhibit], precision: str) -> None:
        self.exhibits = exhibits
        self.precision = precision
        self.pixels = {exhibit.scene.name: exhibit.pixels() for exhibit in exhibits}
        self.predicted: dict[tuple[str, Dialect, str], Reals] = {}

    def share(self, exhibit: Exhibit, convention: Convention) -> float:
        """Of the pixels that are looked at, the share inside their bounds."""
        pixels = self.pixels[exhibit.scene.name]
        if pixels.size == 0:
            return 1.0
        picture = convention.slip.undone(exhibit.picture)
        flat = replace(picture, values=picture.values.reshape(1, -1, 3)[:, pixels])
        linear = self._predicted(exhibit, convention)
        reach, doubts = np.full(linear.shape, exhibit.reach), np.zeros(linear.shape[:2], dtype=np.int64)
        expected = Truth(exhibit.scene, self.precision, linear, reach, doubts, transfer_of(convention.slip))
        lawful = bounds(flat, expected)
        inside = (flat.values >= lawful.low) & (flat.values <= lawful.high)
        return float(inside.all(axis=-1).mean())

    def score(self, exhibits: Iterable[Exhibit], convention: Convention) -> float:
        """How many pictures' worth of pixels are inside."""
        return sum(self.share(exhibit, convention) for exhibit in exhibits)

    def right(self, convention: Convention) -> int:
        """How many pictures have all their pixels inside."""
        return sum(self.share(exhibit, convention) == 1.0 for exhibit in self.exhibits)

    def _predicted(self, exhibit: Exhibit, convention: Convention) -> Reals:
        scene = exhibit.scene
        convention = replace(convention, dialect=_asked(scene, convention.dialect))
        key = (scene.name, convention.dialect, convention.slip.pixel)
        if key not in self.predicted:
            # On NumPy: another convention would be another kernel to compile, for a few hundred rays
            self.predicted[key] = render_pixels(scene, self.pixels[scene.name], convention.rules())
        return self.predicted[key]


def _asked(scene: Scene, dialect: Dialect) -> Dialect:
    """The dialect without the choices that this scene does not ask for."""
    used = [scene.materials[thing.material] for thing in scene.objects]
    glass = any(any(m.transmit) for m in used)
    asks = {
        "specular": any(any(m.specular) for m in used),
        "specular_in_shadow": scene.shadows,
        "glass_shadow": glass and scene.shadows,
        "limit": glass or any(any(m.reflect) for m in used),
        "tir": glass,
        "fresnel": glass or scene.fresnel,
        "ambient": any(any(m.ambient) for m in used),
    }
    asks["mix"] = asks["limit"]
    asks["specular_in_shadow"] &= asks["specular"]
    asks["specular_needs_light_in_front"] = asks["specular"]
    plain = {key: getattr(SCENE_MODEL, key) for key, needed in asks.items() if not needed}
    return replace(dialect, **plain)


def infer(
    exhibits: Sequence[Exhibit],
    precision: str,
    declared: Dialect,
    told: Told = lambda words: None,
) -> Convention:
    """The convention under which most pictures are right; the declared one where no other does better.

    First the slips of the picture with what touches every scene, on the simplest scenes, in all combinations; then
    one dialect choice after the other on the pictures that are still wrong; last, whatever is not needed is
    taken back.
    """
    search = _Search(exhibits, precision)
    start = Convention(declared)
    told("looking for other conventions")
    found = _slips(search, exhibits[:SIMPLEST], start)
    for _ in range(ROUNDS):
        wrong = [e for e in exhibits if search.share(e, found) < 1.0]
        better = _best(search, wrong, found, _steps(found))
        if better == found:
            break
        told(f"trying {', '.join(better.dialect.lines() + better.slip.words())}")
        found = better
    return _needed(search, found, start)


def _slips(search: _Search, simplest: Sequence[Exhibit], start: Convention) -> Convention:
    """The best combination of slips, with the conventions that no scene is free of."""
    wrong = [e for e in simplest if search.share(e, start) < 1.0]
    if not wrong:
        return start
    candidates: list[Convention] = []
    for sample in dict.fromkeys((start.dialect.sample, *CHOICES["sample"])):
        for lambert in CHOICES["lambert"]:
            dialect = replace(start.dialect, sample=sample, lambert=lambert)
            candidates += [Convention(dialect, slip) for slip in _all_slips() if not (sample and slip.pixel)]
    return _best(search, simplest, start, sorted(candidates, key=_departures))


def _departures(convention: Convention) -> int:
    """Slips count more than dialect choices: where both explain the same, the lawful one is said."""
    return 3 * len(convention.slip.words()) + len(convention.dialect.lines())


def _all_slips() -> list[Slip]:
    found = [Slip()]
    for name, words in SLIPS.items():
        found = [replace(slip, **{name: word}) for slip in found for word in words]
    return found


def _steps(found: Convention) -> list[Convention]:
    """All conventions that differ in one choice of the dialect or one slip."""
    steps = [
        replace(found, dialect=replace(found.dialect, **{key: value}))
        for key, values in CHOICES.items()
        for value in values
        if value != getattr(found.dialect, key)
    ]
    steps += [
        replace(found, slip=replace(found.slip, **{name: word}))
        for name, words in SLIPS.items()
        for word in words
        if word != getattr(found.slip, name)
    ]
    return steps


def _best(
    search: _Search, exhibits: Sequence[Exhibit], start: Convention, candidates: Iterable[Convention]
) -> Convention:
    """The candidate with the highest score; the start where none is higher."""
    best, most = start, search.score(exhibits, start)
    for candidate in candidates:
        score = search.score(exhibits, candidate)
        if score > most:
            best, most = candidate, score
    return best


def _needed(search: _Search, found: Convention, start: Convention) -> Convention:
    """Without the choices whose loss makes no right picture wrong: what only shifts a fault is no convention."""
    most = search.right(found)
    for key in CHOICES:
        less = replace(found, dialect=replace(found.dialect, **{key: getattr(start.dialect, key)}))
        if less != found and search.right(less) >= most:
            found = less
    for field in fields(Slip):
        less = replace(found, slip=replace(found.slip, **{field.name: ""}))
        if less != found and search.right(less) >= most:
            found = less
    return found


def worth_saying(before: Mapping[str, bool], after: Mapping[str, bool]) -> bool:
    """Whether a convention explains a tracer's pictures.

    Before and after: which scenes are right under the declared and under the found convention. No picture may
    become wrong, and most must be right.
    """
    right = sum(after.values())
    return (
        right > sum(before.values())
        and 2 * right > len(after)
        and not any(before[name] and not after[name] for name in after)
    )
