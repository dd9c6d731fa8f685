"""Known faults that explain a submission's wrong pictures: found once, charged once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from oracles.diagnosis import disturbs
from oracles.faults import Fault, fault
from oracles.inference import Exhibit
from oracles.verdict import Diagnosis, Verdict
from raycheck.diagnosis import LAW, OF_PICTURES, explained
from raycheck.grading.rubric import Rubric
from raycheck.suite import Hearing


@dataclass(frozen=True)
class Explained:
    """What is told of a submission's mistakes.

    covered: failed checks that named faults explain, and by which; named: these faults, and what each is.
    """

    diagnosis: Diagnosis | None = None
    covered: Mapping[str, str] = field(default_factory=dict)
    named: Mapping[str, str] = field(default_factory=dict)


def sought(rubric: Rubric, shown: Hearing, hidden: Hearing, verdicts: Sequence[Verdict], folder: Path) -> Explained:
    """What explains the wrong pictures, shown and hidden; nothing where the rubric does not ask.

    Of hidden scenes nothing is told but that they are wrong.
    """
    if rubric.mistakes is None:
        return Explained()
    pictures = shown.exhibits | hidden.exhibits
    found = explained(pictures, shown.convention, verdicts, folder)
    if found and found.check.removeprefix("image/") in hidden.exhibits:
        if found.picture:
            (folder / found.picture).unlink()
        found = found.model_copy(update={"check": "", "pixel": None, "reproduce": "", "picture": None})
    return Explained(found, covered(found, pictures, verdicts), named(found))


def covered(found: Diagnosis | None, pictures: Mapping[str, Exhibit], verdicts: Sequence[Verdict]) -> dict[str, str]:
    """Failed checks that the named faults explain, and by which; none where the diagnosis is not sure.

    A law of a formula is explained by a fault in that formula, a law of pictures by what explains all pictures.
    """
    if found is None or found.kind != "named":
        return {}
    faults = [fault(suspect.name) for suspect in found.faults]
    names = " and ".join(known.name for known in faults)
    reason = f"explained by {names}, charged once under known mistakes"
    return {v.check: reason for v in verdicts if v.verdict == "fail" and _covers(faults, pictures, v.check)}


def _covers(faults: Sequence[Fault], pictures: Mapping[str, Exhibit], check: str) -> bool:
    kind, _, name = check.partition("/")
    if check.startswith(OF_PICTURES) or (kind == "image" and name in pictures):
        return True
    return check.startswith(LAW) and any(disturbs(known, name.split("/")[0]) for known in faults)


def named(found: Diagnosis | None) -> dict[str, str]:
    """The faults that are sure, and what each is."""
    if found is None or found.kind != "named":
        return {}
    return {s.name: f"{s.seen}; {s.source}; wrong: {s.wrong} right: {s.right}" for s in found.faults}
