"""The laws, asked of one subject after the pictures: verdicts like those of the ladder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from oracles.conventions import Convention
from oracles.laws import Law
from oracles.laws.pictures import PictureLaw
from oracles.verdict import Verdict
from raycheck.laws.by_formula import formula_verdicts
from raycheck.laws.by_picture import picture_verdicts
from raycheck.laws.plan import LawPlan, all_laws, check_names, chosen
from raycheck.subjects import Subject


def judge_laws(
    subject: Subject, plan: LawPlan, convention: Convention, before: Sequence[Verdict], folder: Path
) -> Iterator[Verdict]:
    """Verdicts in the book's order.

    convention: what the subject's pictures follow; before: the verdicts so far; scenes of probes are kept in
    folder/laws.
    """
    asked = plan.asked(subject)
    formulas = [law for law in asked if isinstance(law, Law)]
    pictures = [law for law in asked if isinstance(law, PictureLaw)]
    for verdict in formula_verdicts(subject, plan, formulas, convention.dialect, folder):
        yield plan.known.apply(verdict)
    for verdict in picture_verdicts(subject, plan, pictures, convention, before):
        yield plan.known.apply(verdict)


__all__ = ["LawPlan", "all_laws", "check_names", "chosen", "judge_laws"]
