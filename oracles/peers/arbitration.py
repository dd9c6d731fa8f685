"""N versions of one picture, and certified truth to say who is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from oracles.compare import compare
from oracles.images.picture import Picture
from oracles.peers.explain import Habit, explained
from oracles.truth import truth
from oracles.verdict import Pair, SceneStandings, Standing
from reference_tracer import certified
from reference_tracer.lanes import render as lanes_of
from scenes.model import Scene

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Party:
    """One version: who made it, in which precision, how long that took, and what they are known to do otherwise."""

    name: str
    precision: str
    picture: Picture | None
    seconds: float
    message: str = ""
    habits: tuple[Habit, ...] = ()


def arbitrate(scene: Scene, parties: Sequence[Party], lanes: str) -> SceneStandings:
    """Judge every version against certified truth."""
    proved = certified.render(scene, lanes_of.backend(lanes, 64))
    outsides: dict[str, NDArray[np.bool_]] = {}
    standings = []
    for party in parties:
        standing, outside = _standing(scene, party, proved, lanes)
        standings.append(standing)
        outsides[party.name] = outside
    there = [party for party in parties if party.picture is not None]
    return SceneStandings(
        scene=scene.name,
        certified=float(proved.bound[proved.decided].max(initial=0.0)),
        undecided=int(np.count_nonzero(~proved.decided)),
        standings=tuple(standings),
        pairs=tuple(_pair(a, b, outsides) for a, b in combinations(there, 2)),
    )


def _standing(
    scene: Scene, party: Party, proved: certified.Certified, lanes: str
) -> tuple[Standing, NDArray[np.bool_]]:
    start = Standing(party=party.name, precision=party.precision, seconds=party.seconds, message=party.message)
    if party.picture is None:
        return start, np.zeros(proved.decided.shape, dtype=bool)
    expected = truth(scene, party.precision, lanes)
    # The tolerance was taken about the lanes' value; the certified one lies within its own bound of it
    reach = expected.tolerance + np.abs(expected.pixels - proved.value) + proved.bound
    outside = compare(party.picture, replace(expected, pixels=proved.value, tolerance=reach)).outside
    accounted = np.zeros_like(outside)
    reasons: list[str] = []
    for habit in party.habits:
        more = explained(scene, party.picture, outside & ~accounted, habit, party.precision, lanes)
        accounted = accounted | more
        if more.any():
            reasons.append(habit.reason)
    # An upper bound of the error: our own float64 picture is the middle of the certified one
    off = (np.abs(party.picture.values - proved.value) + proved.bound).max(axis=-1)
    error = np.where(proved.decided, off, 0.0)
    p50, p99, worst = (float(q) for q in np.quantile(error, [0.5, 0.99, 1.0], method="higher"))
    return start.model_copy(
        update={
            "p50": p50,
            "p99": p99,
            "worst": worst,
            "at": _place(error),
            "outside": int(np.count_nonzero(outside)),
            "explained": int(np.count_nonzero(accounted)),
            "reason": ", ".join(reasons),
        }
    ), outside


def _pair(a: Party, b: Party, outsides: dict[str, NDArray[np.bool_]]) -> Pair:
    assert a.picture is not None  # noqa: S101
    assert b.picture is not None  # noqa: S101
    apart = np.abs(a.picture.values - b.picture.values).max(axis=-1)
    i, j = _place(apart)
    wrong = tuple(party.name for party in (a, b) if outsides[party.name][j, i])
    return Pair(first=a.name, second=b.name, worst=float(apart.max()), at=(i, j), wrong=wrong)


def _place(values: Reals) -> tuple[int, int]:
    j, i = np.unravel_index(int(np.argmax(values)), values.shape)
    return int(i), int(j)
