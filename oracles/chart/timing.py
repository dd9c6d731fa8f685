"""Times taken side by side: round after round, all in turn, so that the machine's drift hits all alike."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Times:
    """Seconds a unit of work over all rounds: the least (what it costs where nothing disturbs), and the quartiles."""

    least: float
    quartiles: tuple[float, float, float]


@dataclass(frozen=True)
class Work:
    """Something to time; units: how many rays (or renders) one call does."""

    run: Callable[[], object]
    units: int


def interleaved(
    works: Mapping[str, Work],
    rounds: int,
    tell: Callable[[str], None] = lambda what: None,
    patience: float = float("inf"),
) -> dict[str, Times]:
    """Each once to warm up, then `rounds` rounds of all; what has taken `patience` seconds sits out the rest."""
    taken: dict[str, list[float]] = {name: [] for name in works}
    for k in range(rounds + 1):
        for name, work in works.items():
            if sum(taken[name]) * work.units > patience:
                continue
            begin = time.perf_counter()
            work.run()
            if k:
                taken[name].append((time.perf_counter() - begin) / work.units)
        tell(f"round {k} of {rounds}")
    return {name: summed(own) for name, own in taken.items()}


def summed(own: Sequence[float]) -> Times:
    """What the rounds of one say."""
    low, middle, high = statistics.quantiles([*own, *own], n=4, method="inclusive")
    return Times(min(own), (low, middle, high))
