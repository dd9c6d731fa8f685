"""Which known faults explain a tracer's pictures best: alone, and several together.

All is computed anew from the dictionary's rulebooks at the pixels of the tracer's own pictures, so it holds for any
scene, size and precision. What is found is what remains after every alternative was tried, not a first match.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracles.diagnosis.evidence import Evidence, Reading, Witness, composable
from oracles.faults import FAULTS, Fault

MOST = 5
"""Faults named together."""
SAMPLE = 6
"""Wrong pictures, from the simplest scene to the richest, on which every fault is tried alone."""
KEPT = 16
"""Faults that are tried on all pictures, and to which a further one is sought."""
FOLLOWED = 4
"""Sets of faults to which a further one is sought."""
BRANCHES = 6
"""Further faults that are tried on all pictures, for each set of faults."""
CLUES = 2
"""Pictures, the simplest that a set of faults leaves unexplained, by which a further one is sought."""

Told = Callable[[str], Any]


@dataclass(frozen=True)
class Standing:
    """How a set of faults explains all pictures.

    right: pictures explained, those that are right included; share: of the residual of the wrong ones, each counting
    alike, less what is spoilt of the right ones; contradicted: faults whose formulas answer rightly when asked;
    offset: mean distance from what is predicted.
    """

    faults: tuple[Fault, ...]
    right: int
    wrong_explained: int
    share: float
    contradicted: int
    offset: float

    @property
    def key(self) -> tuple[int, float, int, int, float]:
        """By this the best is the greatest."""
        return self.right, round(self.share, 6), -len(self.faults), -self.contradicted, -self.offset


def standing(evidence: Evidence, faults: Sequence[Fault]) -> Standing:
    """Of one set of faults."""
    readings = [(witness, evidence.read(witness, faults)) for witness in evidence.witnesses]
    wrong = [(w, r) for w, r in readings if w.failing]
    spoilt = sum(1.0 - r.share for w, r in readings if not w.failing)
    gained = sum(_gain(w, r) for w, r in wrong)
    return Standing(
        faults=tuple(faults),
        right=sum(r.right for _, r in readings),
        wrong_explained=sum(_explains(w, r) for w, r in wrong),
        share=max(0.0, (gained - spoilt) / max(1, len(wrong))),
        contradicted=sum(bool(fault.entries) and fault.entries <= evidence.cleared for fault in faults),
        offset=sum(r.offset for _, r in readings),
    )


def _gain(witness: Witness, reading: Reading) -> float:
    """The share of a wrong picture's residual that goes away."""
    before = witness.plain.residual
    return 1.0 - min(reading.residual / before, 1.0) if before > 0.0 else float(reading.right)


def _explains(witness: Witness, reading: Reading) -> bool:
    return witness.failing and reading.right and reading.residual < witness.plain.residual


def explained(evidence: Evidence, told: Told = lambda words: None) -> tuple[Standing, list[Standing]]:
    """The best set of at most MOST faults, empty where none helps, and the best ones alone, in order."""
    faults = FAULTS  # those that change nothing by themselves too: they may beside another
    alone = _best_first(standing(evidence, (fault,)) for fault in _promising(evidence, faults))
    nothing = standing(evidence, ())
    best = alone[0] if alone and alone[0].key[:2] > nothing.key[:2] else nothing
    # Codes hide: a wrong way to write them may be seen only beside another fault, as a negative colour that wraps
    starts = [*alone, *(standing(evidence, (fault,)) for fault in _writers(evidence, faults, alone))]
    for count in range(2, MOST + 1):
        if best.right == len(evidence.witnesses):
            break
        told(f"looking for {count} faults together")
        starts = _best_first(_extended(evidence, starts, faults))[:FOLLOWED]
        if not starts or not _further(starts[0], best):
            break
        best = starts[0]
    return _needed(evidence, best), alone


def _writers(evidence: Evidence, faults: Sequence[Fault], alone: Sequence[Standing]) -> list[Fault]:
    """Faults of writing codes, if these pictures are of codes, those aside that are among the best already."""
    best = {found.faults[0].name for found in alone}
    coded = [witness for witness in evidence.failing[:1] if witness.got.maximum is not None]
    return [fault for fault in faults if fault.name not in best and any(w.writes(fault) for w in coded)]


def _further(more: Standing, less: Standing) -> bool:
    """Whether a set of faults is worth its additional one: a picture more, or half of what was left of the rest."""
    return more.right > less.right or (more.right == less.right and 1.0 - more.share <= (1.0 - less.share) / 2)


def _best_first(standings: Iterable[Standing]) -> list[Standing]:
    return sorted(standings, key=lambda found: found.key, reverse=True)


def _promising(evidence: Evidence, faults: Sequence[Fault]) -> list[Fault]:
    """The faults that explain most of a sample of the wrong pictures."""
    wrong = sorted(evidence.failing, key=lambda witness: witness.cost)
    sample = [wrong[k] for k in sorted({round(x) for x in np.linspace(0, len(wrong) - 1, SAMPLE)})] if wrong else []
    scores = {}
    for fault in faults:
        readings = [(witness, evidence.read(witness, (fault,))) for witness in sample]
        scores[fault.name] = sum(_explains(w, r) for w, r in readings), sum(_gain(w, r) for w, r in readings)
    return sorted(faults, key=lambda fault: scores[fault.name], reverse=True)[:KEPT]


def _extended(evidence: Evidence, starts: Sequence[Standing], faults: Sequence[Fault]) -> Iterator[Standing]:
    """Each start with one fault more, of those that help most with pictures which the start leaves unexplained.

    The starts after one that leads to a set which explains everything are not tried.
    """
    tried: set[frozenset[str]] = set()
    for start in starts:
        everything = False
        for fault in _helpful(evidence, start, faults):
            together = (*start.faults, fault)
            names = frozenset(f.name for f in together)
            if names not in tried:
                tried.add(names)
                found = standing(evidence, together)
                everything |= found.right == len(evidence.witnesses)
                yield found
        if everything:
            return


def _helpful(evidence: Evidence, start: Standing, faults: Sequence[Fault]) -> list[Fault]:
    """The faults that, with the start's, explain its clues or take half of what is left of them, the best first."""
    clues = [(clue, evidence.read(clue, start.faults)) for clue in _clues(evidence, start.faults)]
    scores: list[tuple[tuple[int, float], int, Fault]] = []
    for place, fault in enumerate(faults):
        if all(composable(fault, f) for f in start.faults):
            readings = [(evidence.read(clue, (*start.faults, fault)), before) for clue, before in clues]
            if any(after.right or after.residual <= before.residual / 2 for after, before in readings):
                gain = sum(
                    1.0 - min(after.residual / before.residual, 1.0) for after, before in readings if before.residual
                )
                scores.append(((sum(after.right for after, _ in readings), gain), -place, fault))
    return [fault for _, _, fault in sorted(scores, key=lambda score: score[:2], reverse=True)[:BRANCHES]]


def _clues(evidence: Evidence, faults: Sequence[Fault]) -> list[Witness]:
    """Some pictures that these faults do not explain, the simplest scenes first."""
    left = [witness for witness in evidence.witnesses if not evidence.read(witness, faults).right]
    return sorted(left, key=lambda witness: witness.cost)[:CLUES]


def _needed(evidence: Evidence, best: Standing) -> Standing:
    """Without the faults whose loss leaves as many pictures explained."""
    for fault in best.faults:
        rest = tuple(f for f in best.faults if f is not fault)
        less = standing(evidence, rest)
        if rest and not _further(best, less):
            return _needed(evidence, less)
    return best
