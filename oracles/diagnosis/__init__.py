"""Diagnosis: which known mistakes explain a tracer's pictures, or else where its error lives.

A fault is a hypothesis like a convention: under the right one the pictures lie inside their bounds. What is named
was held against every pixel that is in no doubt, of every picture, wrong or right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from oracles.diagnosis.evidence import Evidence, Witness, composed, rendered
from oracles.diagnosis.located import TERMS, Place, located
from oracles.diagnosis.search import Standing, explained, standing
from oracles.faults import Fault
from oracles.images import Picture
from oracles.inference import Exhibit
from oracles.verdict import Diagnosis, Located, Suspect
from reference_tracer.rulebook import LECTURE, Rulebook

SURE = 3
"""Faults named with confidence; more could explain much by chance."""
OTHERS = 3
"""Next best faults told."""


@dataclass(frozen=True)
class Answers:
    """What a tracer's answers to single formulas say: laws broken and kept, by operation of the probe protocol."""

    broken: Mapping[str, tuple[str, ...]]
    kept: frozenset[str]

    @property
    def cleared(self) -> frozenset[str]:
        """Entries of the rulebook of which every operation keeps its laws."""
        return frozenset().union(
            *(term.entries for term in TERMS if term.probes and all(name in self.kept for name in term.probes))
        )


SILENT = Answers({}, frozenset())


def diagnose(
    exhibits: Sequence[Exhibit],
    base: Rulebook = LECTURE,
    answers: Answers = SILENT,
    told: Callable[[str], Any] = lambda words: None,
) -> Diagnosis | None:
    """What explains the wrong pictures, in the ladder's order; None where none is wrong and no law is broken."""
    evidence = Evidence(exhibits, base, answers.cleared)
    if not evidence.failing:
        return _by_answers(answers) if answers.broken else None
    best, alone = explained(evidence, told)
    if best.faults and _holds(evidence, best):
        return _named(evidence, best, alone)
    told("looking for where the error lives")
    place = _place(located(evidence), answers)
    return _likely(evidence, best, alone, place) if best.wrong_explained else _unknown(evidence, alone, place)


def disturbs(known: Fault, operation: str) -> bool:
    """Whether a fault is in a formula that this operation of the probe protocol asks for."""
    return any(known.entries & term.entries for term in TERMS if operation in term.probes)


def predicted(exhibit: Exhibit, faults: Sequence[Fault], base: Rulebook = LECTURE) -> Picture:
    """What a tracer with these faults would write of the scene."""
    pixels = rendered(exhibit.scene, composed(base, faults))
    write = next((fault.picture for fault in faults if fault.picture), None)
    return write(pixels, exhibit.scene) if write else Picture(pixels)


def _holds(evidence: Evidence, best: Standing) -> bool:
    """Whether the faults, few enough, explain every picture, at all of its clear pixels."""
    if best.right < len(evidence.witnesses) or len(best.faults) > SURE:
        return False
    return all(witness.whole(best.faults).right for witness in evidence.failing)


def _named(evidence: Evidence, best: Standing, alone: Sequence[Standing]) -> Diagnosis:
    names = " and ".join(fault.name for fault in best.faults)
    alike = _alike(best, alone)
    several = (
        f"{len(best.faults)} known faults together explain" if len(best.faults) > 1 else "One known fault explains"
    )
    pictures = _pictures(len(evidence.failing), "wrong picture")
    says = f"{several} the tracer's {pictures}: {names}"
    if alike:
        says += f", or {', '.join(alike)}, which makes the same of them"
    return _diagnosis(evidence, best, alone, kind="named", sentence=says + ".", alike=alike)


def _likely(evidence: Evidence, best: Standing, alone: Sequence[Standing], place: Located) -> Diagnosis:
    names = " and ".join(fault.name for fault in best.faults)
    says = (
        f"Most like the known {names}, which explains {best.wrong_explained} of "
        f"{_pictures(len(evidence.failing), 'wrong picture')}: either there is another fault besides, or it is another "
        f"that looks alike there. As a whole the wrong pictures look like an error of the {_terms(place)}."
    )
    return _diagnosis(evidence, best, alone, kind="likely", sentence=says, located=place)


def _unknown(evidence: Evidence, alone: Sequence[Standing], place: Located) -> Diagnosis:
    pictures = _pictures(len(evidence.failing), "wrong picture")
    says = f"No known fault explains any of the tracer's {pictures}. They look like an error of the {_terms(place)}."
    return _diagnosis(evidence, standing(evidence, ()), alone, kind="unknown", sentence=says, located=place)


def _terms(place: Located) -> str:
    return f"term {place.term}" + (f", or else {place.second}" if place.second else "")


def _diagnosis(evidence: Evidence, best: Standing, alone: Sequence[Standing], **told: Any) -> Diagnosis:
    first = _first(evidence, best)
    names = {fault.name for fault in best.faults} | set(told.get("alike", ()))
    others = [s for s in alone if s.faults[0].name not in names and s.share > 0.0][:OTHERS]
    return Diagnosis(
        failing=len(evidence.failing),
        explained=best.wrong_explained,
        share=best.share,
        faults=tuple(_suspect(standing(evidence, (fault,))) for fault in best.faults),
        others=tuple(_suspect(other) for other in others),
        check=f"image/{first.scene.name}",
        pixel=_pixel(first),
        **told,
    )


def _first(evidence: Evidence, best: Standing) -> Witness:
    """The first wrong picture that the faults explain, else the first."""
    for witness in evidence.failing if best.faults else ():
        reading = evidence.read(witness, best.faults)
        if reading.right and reading.residual < witness.plain.residual:
            return witness
    return evidence.failing[0]


def _pixel(witness: Witness) -> tuple[int, int]:
    """(i, j) of the first wrong pixel, row by row from the top."""
    j, i = np.argwhere(witness.exhibit.wrong)[0]
    return int(i), int(j)


def _alike(best: Standing, alone: Sequence[Standing]) -> tuple[str, ...]:
    """Other single faults that make the same pictures."""
    if len(best.faults) != 1:
        return ()
    same = [s for s in alone if s.faults != best.faults and s.key[:4] == best.key[:4] and s.share == best.share]
    return tuple(s.faults[0].name for s in same)


def _suspect(found: Standing) -> Suspect:
    (fault,) = found.faults
    words = {name: getattr(fault, name) for name in ("name", "group", "source", "wrong", "right", "seen", "mend")}
    return Suspect(**words, share=found.share, pictures=found.wrong_explained)


def _place(places: Sequence[Place], answers: Answers) -> Located:
    """The likeliest term; one whose formula is known to answer wrongly goes before all others."""
    ordered = sorted(places, key=lambda place: not _broken(place, answers))
    place, second = ordered[0], ordered[1]
    return Located(
        term=place.term.name,
        formula=place.term.formula,
        slide=place.term.slide,
        likeness=place.likeness,
        like=place.like.name,
        second="" if _broken(place, answers) else second.term.name,
        laws=_broken(place, answers),
    )


def _broken(place: Place, answers: Answers) -> tuple[str, ...]:
    return tuple(law for name in place.term.probes for law in answers.broken.get(name, ()))


def _by_answers(answers: Answers) -> Diagnosis:
    """Every picture is right, but not every formula when asked alone."""
    laws = tuple(law for found in answers.broken.values() for law in found)
    term = next((term for term in TERMS if any(name in answers.broken for name in term.probes)), TERMS[0])
    says = f"No picture is wrong, but the tracer's own answers break {_pictures(len(laws), 'law')}: {', '.join(laws)}."
    place = Located(term=term.name, formula=term.formula, slide=term.slide, likeness=0.0, like="", laws=laws)
    return Diagnosis(kind="unknown", sentence=says, failing=0, explained=0, share=0.0, located=place)


def _pictures(count: int, word: str) -> str:
    return f"{count} {word}{'' if count == 1 else 's'}"


__all__ = ["SILENT", "Answers", "diagnose", "disturbs", "predicted"]
