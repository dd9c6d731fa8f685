"""What a score rests on beyond the pictures: laws, stability and speed, asked where the rubric has them."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Iterable, Sequence
from pathlib import Path

from oracles.verdict import Verdict
from raycheck.errors import StartError
from raycheck.grading import speed
from raycheck.grading.formulas import foreign_laws, law_verdicts, stability_verdicts
from raycheck.grading.mistakes import Explained
from raycheck.grading.patience import Patience
from raycheck.grading.rubric import Rubric
from raycheck.grading.score import Evidence
from raycheck.subjects.command import CommandSubject


def number(text: str) -> int:
    """A number that follows from the text and does not tell it."""
    return int.from_bytes(hashlib.sha256(text.encode()).digest()[:6])


def beside_others(rubric: Rubric) -> contextlib.AbstractContextManager[None]:
    """For what must not run while another submission is timed; of no concern where nothing is timed."""
    return speed.machine(alone=False) if rubric.speeds else contextlib.nullcontext()


def formulas(
    rubric: Rubric, seed: int, subject: CommandSubject, patience: Patience, shown: Sequence[Verdict], student: Path
) -> list[Verdict]:
    """Laws and stability; shown: the verdicts on pictures, on which laws of pictures build."""
    own = number(f"laws {seed}") % 2**31
    laws = law_verdicts(subject, patience, rubric.laws, own, shown, student) if rubric.laws else []
    holds = stability_verdicts(subject, rubric.reaches, own) if rubric.reaches else ()
    return [*laws, *holds]


def timing(rubric: Rubric, seed: int, size: tuple[int, int], patience: Patience) -> speed.Timing:
    """How fast the tracer is, timed while nothing else is asked on this machine."""
    if not rubric.speeds:
        return speed.Timing(None)
    scene = speed.timed_scene(number(f"timed {seed}"), size)
    try:
        with speed.machine(alone=True):
            return speed.timing(patience, scene)
    except StartError:
        return speed.Timing(None, "error", "it started before and does no longer")


def gathered(rubric: Rubric, subject: CommandSubject, verdicts: Iterable[Verdict], explained: Explained) -> Evidence:
    """A verdict for each check that counts; what was not asked is blocked."""
    by_name = {verdict.check: verdict for verdict in verdicts}
    for group in rubric.group:
        for check in group.checks:
            message = "not asked, no usable picture came"
            by_name.setdefault(check, Verdict(check=check, verdict="blocked", message=message))
    return Evidence(by_name, explained.covered, explained.named, foreign_laws(subject, rubric.laws))


def of_conformance(verdict: Verdict) -> bool:
    """Does it belong on a page about what conforms: no steps of speed and reach, no law that was not asked."""
    if verdict.check.startswith("image/"):
        return True
    return verdict.check.startswith(("law/", "probe/")) and verdict.verdict != "unsupported"


def outside(pictures: Sequence[Verdict]) -> float | None:
    """Mean share of wrong pixels, all of a picture that did not come; None where nothing was judged by pixel."""
    shares = [v.judged.outside / v.judged.pixels if v.judged else 1.0 for v in pictures if v.sampled is None]
    return sum(shares) / len(shares) if shares else None
