"""What a synthetic submission must score: derived from the scenes that its faults amount to, without running it.

The rule of docs/grading.md is written anew here, so that `raycheck.grading.score` is not checked against itself.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from oracles import kept
from oracles.compare import compare
from oracles.images import Picture
from raycheck.grading.one import Asked
from raycheck.grading.synthetic import Member
from raycheck.lanes import best_lanes
from reference_tracer.lanes import render as lanes
from scenes.catalogue import Rung, rung
from scenes.model import Scene


class Expectation:
    """A run's questions, and which of them a member of the class answers wrongly."""

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self._touched: dict[tuple[str, str, str], bool] = {}

    def points(self, member: Member, precision: str) -> list[float]:
        """Points by group of the rubric, the hidden scenes last; precision: what the member's manifest says."""
        rubric = self.asked.rubric
        found = [self._group(g.points, [rung(name) for name in g.rungs], member, precision) for g in rubric.group]
        if rubric.hidden:
            found.append(self._group(rubric.hidden.points, self.asked.hidden, member, precision))
        return found

    def _group(self, points: float, rungs: Sequence[Rung], member: Member, precision: str) -> float:
        right = wrong = 0
        for one in rungs:
            if not self.touched(member, self._scene(one), precision):
                right += 1
            elif not any(self.touched(member, self._scene(rung(below)), precision) for below in self._asked_below(one)):
                wrong += 1
        return round(points * right / (right + wrong), 2) if right + wrong else 0.0

    def _asked_below(self, one: Rung) -> list[str]:
        """What a rung builds on, as far as it was asked: a hidden scene may build on rungs that no group needs."""
        asked = {known.name for known in self.asked.rungs}
        return [name for name in one.requires if name in asked]

    def _scene(self, one: Rung) -> Scene:
        known = {known.name for known in self.asked.rungs}
        return one.scene().resized(*self.asked.size) if one.name in known else one.scene()

    def touched(self, member: Member, scene: Scene, precision: str) -> bool:
        """Does the member draw a wrong picture of this scene."""
        key = (member.name, scene.content_hash(), precision)
        if key not in self._touched:
            backend = best_lanes()
            drawn = lanes.render(member.as_scene(scene), lanes.backend(backend, 64)).pixels
            picture = Picture(drawn.astype(np.float32).astype(np.float64), roundoff=2.0**-24)
            self._touched[key] = compare(picture, kept.truth(scene, precision, backend)).word == "fail"
        return self._touched[key]
