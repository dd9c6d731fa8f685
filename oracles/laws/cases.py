"""One law put to one tracer: a batch of cases, and of those that break it the plainest that can be found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracles.laws.dice import Dice, repeated, seeded
from oracles.laws.law import Ask, Law, Reading
from scenes.model import Scene

Reals = NDArray[np.float64]
CASES = 2000
"""Cases of a batch: some hundred for each regime of a law."""

BITS = (0, 1, 2, 4, 8, 16)
"""Fraction bits to which a coordinate is cut in search of a plainer case."""

ROUNDS = 200
"""Most steps of that search; each takes bits away, so it ends by itself long before."""


@dataclass(frozen=True)
class Question:
    """One question of a case: the operation, its numbers, and the scene that it is about."""

    operation: str
    arguments: tuple[float, ...]
    scene: Scene | None = None


@dataclass(frozen=True)
class Example:
    """A case of a law: what was asked, what came back, what was expected within which bound.

    excess: error in tolerances; coordinates: what the case is made from.
    """

    questions: tuple[Question, ...]
    quantity: str
    expected: float
    bound: float
    got: float
    excess: float
    regime: str
    coordinates: tuple[float, ...]


@dataclass(frozen=True)
class Finding:
    """What came of a law.

    Cases asked, cases in which it could tell, the worst excess, and a plain case that breaks it.
    """

    law: Law
    cases: int
    decided: int
    worst: float
    example: Example | None = None


def reading(law: Law, dice: Dice, ask: Ask) -> Reading:
    """The law's reading of these cases; numbers that overflow or are missing are the law's to judge."""
    with np.errstate(all="ignore"):
        return law.test(dice, ask)


def examine(law: Law, ask: Ask, precision: str, seed: int, count: int = CASES) -> Finding:
    """Put a seeded batch of cases to the tracer."""
    dice = seeded(count, precision, seed)
    found = reading(law, dice, ask)
    excess = found.excess()
    k = int(np.argmax(excess))
    decided = int(np.count_nonzero(found.decided()))
    if not excess[k] > 1.0:
        return Finding(law, count, decided, float(excess[k]))
    plain = simplest(law, ask, precision, np.array([column[k] for column in dice.columns]))
    return Finding(law, count, decided, float(excess[k]), example(law, ask, precision, plain))


def simplest(law: Law, ask: Ask, precision: str, coordinates: Reals) -> Reals:
    """Coordinates with fewer fraction bits that still break the law.

    All single simplifications at once, again and again.
    """
    best = coordinates
    for _ in range(ROUNDS):
        candidates = _simpler(best)
        if not len(candidates):
            return best
        broken = reading(law, repeated(candidates, precision), ask).excess() > 1.0
        if not broken.any():
            return best
        best = min(candidates[broken], key=_bits)
    return best


def _simpler(coordinates: Reals) -> Reals:
    """Candidates (n, k): one coordinate cut to fewer bits, or all from some place on set to 0."""
    found = []
    for k, value in enumerate(coordinates):
        for bits in BITS:
            cut = np.floor(value * 2.0**bits) / 2.0**bits
            if cut != value:
                found.append(np.concatenate([coordinates[:k], [cut], coordinates[k + 1 :]]))
        if coordinates[k:].any():
            found.append(np.where(np.arange(len(coordinates)) < k, coordinates, 0.0))
    return np.array(found).reshape(len(found), len(coordinates))


def _bits(coordinates: Reals) -> int:
    """Fraction bits in all."""
    return sum(value.as_integer_ratio()[1].bit_length() for value in coordinates.tolist())


def example(law: Law, ask: Ask, precision: str, coordinates: Reals) -> Example:
    """The case of these coordinates, asked once more and written down."""
    questions: list[Question] = []

    def written(operation: str, arguments: Reals, scene: Scene | None = None) -> Reals:
        questions.append(Question(operation, tuple(arguments[0].tolist()), scene))
        return ask(operation, arguments, scene)

    dice = repeated(coordinates[None, :], precision)
    return describe(reading(law, dice, written), dice, tuple(questions))


def describe(found: Reading, dice: Dice, questions: tuple[Question, ...]) -> Example:
    """The worst number of a reading of one case."""
    ratios = found.ratios()[0]
    k = int(np.argmax(ratios))
    parts = np.broadcast_arrays(
        *(part[:, None] if part.ndim == 1 else part for part in (found.expected, found.bound, found.got))
    )
    expected, bound, got = (float(part[0, k]) for part in parts)
    regime = dice.regimes[int(dice.regime_of[0])] if dice.regime_of is not None else ""
    coordinates = tuple(float(column[0]) for column in dice.columns)
    return Example(questions, found.quantity, expected, bound, got, float(ratios[k]), regime, coordinates)
