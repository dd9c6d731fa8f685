"""Checks of formulas for a rubric: laws, and how far formulas hold. Probes run where the submission's room is."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from oracles.conventions import Convention
from oracles.laws import Law, NoAnswerError
from oracles.laws.pictures import PictureLaw
from oracles.measurement import Precision, Question
from oracles.stability import frontiers
from oracles.verdict import Verdict
from raycheck.grading.patience import Patience
from raycheck.grading.rubric import Reach
from raycheck.laws.by_formula import formula_verdicts
from raycheck.laws.by_picture import picture_verdicts
from raycheck.laws.plan import AnyLaw, LawPlan, spoken_otherwise, verdict_on
from raycheck.probes import prober_of
from raycheck.probes.arrays import ArrayProbe, UnansweredError
from raycheck.subjects.command import CommandSubject

NO_PROBE = "the tracer has no probe; see `probe` in docs/attaching.md"
STOCHASTIC = "says nothing about pictures that are drawn by chance"


def law_verdicts(
    subject: CommandSubject,
    patience: Patience,
    laws: Sequence[AnyLaw],
    seed: int,
    before: Sequence[Verdict],
    folder: Path,
) -> list[Verdict]:
    """The laws asked of a subject, the greeting of its probe among them; what the pictures build on is in `before`."""
    plan = LawPlan(laws, named=True, seed=seed, repeat=f"raycheck check . --seed {seed} --laws {{law}}")
    formulas = [law for law in laws if isinstance(law, Law)]
    pictures = [law for law in laws if isinstance(law, PictureLaw)]
    found = list(formula_verdicts(subject, plan, formulas, subject.dialect, folder))
    if subject.spp is None:
        found += picture_verdicts(patience, plan, pictures, Convention(subject.dialect), before)
    else:
        found += (verdict_on(law, plan, "unsupported", STOCHASTIC) for law in pictures)
    return [_portable(verdict, folder) for verdict in found]


def foreign_laws(subject: CommandSubject, laws: Sequence[AnyLaw]) -> dict[str, str]:
    """Checks that say nothing about this tracer, and why: laws of conventions that are not its own."""
    found = {}
    for law in laws:
        if isinstance(law, PictureLaw):
            reason = STOCHASTIC if subject.spp is not None else ""
        else:
            other = spoken_otherwise(law, subject.dialect)
            reason = f"asks for the scene model's conventions; the tracer's are {other}" if other else ""
        if reason:
            found[f"law/{law.name}"] = reason
    return found


def _portable(verdict: Verdict, folder: Path) -> Verdict:
    """Its line to run again without the name of this machine's folder."""
    if verdict.case is None:
        return verdict
    run = verdict.case.run.replace(f"{folder}/", "")
    return verdict.model_copy(update={"case": verdict.case.model_copy(update={"run": run})})


def stability_verdicts(subject: CommandSubject, reaches: Sequence[Reach], seed: int) -> Iterator[Verdict]:
    """Whether formulas hold as far as asked at the subject's precision; the inputs follow from the seed."""
    prober = prober_of(subject)
    if prober is None:
        yield from (_told(reach, "unsupported", NO_PROBE) for reach in reaches)
        return
    precision: Precision = "float64" if subject.precision == "float64" else "float32"
    probe = ArrayProbe("the probe", precision, prober)
    try:
        operations = prober.open()
        for k, reach in enumerate(reaches):
            yield _measured(reach, probe, operations, seed + k)
    except NoAnswerError as error:
        yield from (_told(reach, error.word, error.message) for reach in reaches)
    finally:
        prober.close()


def _measured(reach: Reach, probe: ArrayProbe, operations: frozenset[str], seed: int) -> Verdict:
    operation = "refract" if reach.question == frontiers.BENDING.name else "sphere"
    if operation not in operations:
        return _told(reach, "unsupported", f"the tracer does not answer {operation}")
    limit = float(getattr(reach, probe.precision))
    try:
        found = frontiers.until(reach.question, limit, probe, np.random.default_rng(seed))
    except UnansweredError as error:
        return _told(reach, error.word, error.message)
    asked = f"{_question(reach).unit} = {limit:g} in {probe.precision}"
    if found.open:
        return _told(reach, "pass", f"holds as far as {asked}")
    held = "at none of the values asked before" if found.reach is None else f"as far as {found.reach:.3g}"
    return _told(reach, "fail", f"asked for as far as {asked}, holds {held}")


def _question(reach: Reach) -> Question:
    return next(question for question in frontiers.QUESTIONS if question.name == reach.question)


def _told(reach: Reach, word: str, message: str) -> Verdict:
    teaches = _question(reach).title
    return Verdict.model_validate({"check": reach.check, "verdict": word, "message": message, "teaches": teaches})
