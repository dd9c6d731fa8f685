"""A law under Hypothesis: cases beyond the fixed ones, and a failing one made as small as Hypothesis can."""

from __future__ import annotations

import numpy as np
from hypothesis import HealthCheck, Phase, Verbosity, given, settings
from hypothesis import seed as seeded
from hypothesis import strategies as st
from hypothesis.errors import Flaky

from oracles.laws.cases import Finding, example, reading
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Law

COORDINATES = st.one_of(st.integers(0, 4).map(lambda k: k / 4.0), st.integers(0, 2**20).map(lambda k: k / 2.0**20))
"""Quarters, which make axes and powers of two, or any of a million steps; both shrink to 0, the plainest."""


class _BrokenError(Exception):
    """This case breaks the law."""


def explore(law: Law, ask: Ask, precision: str, seed: int, count: int) -> Finding:
    """Put count cases to the tracer, one at a time; of a broken law the smallest case that Hypothesis finds."""
    broken: list[tuple[float, ...]] = []
    seen = [0, 0]
    worst = [0.0]

    @seeded(seed)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        phases=(Phase.generate, Phase.shrink),
        suppress_health_check=list(HealthCheck),
        verbosity=Verbosity.quiet,
    )
    @given(st.data())
    def once(data: st.DataObject) -> None:
        dice = Dice(1, precision, lambda: np.array([data.draw(COORDINATES)]))
        found = reading(law, dice, ask)
        excess = float(found.excess()[0])
        seen[0] += 1
        seen[1] += int(found.decided()[0])
        worst[0] = max(worst[0], excess)
        if excess > 1.0:
            broken.append(tuple(float(column[0]) for column in dice.columns))
            raise _BrokenError

    try:
        once()
    except (_BrokenError, Flaky):  # Flaky: asked again it answered otherwise; the case stands all the same
        return Finding(law, seen[0], seen[1], worst[0], example(law, ask, precision, np.array(broken[-1])))
    return Finding(law, seen[0], seen[1], worst[0])
