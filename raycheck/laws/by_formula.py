"""The laws of formulas, put to a subject's prober."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from oracles.laws import Law, NoAnswerError
from oracles.laws.cases import Example, Finding, Question, examine
from oracles.verdict import Case, Verdict
from raycheck.laws.plan import HELLO, LawPlan, spoken_otherwise, verdict_on
from raycheck.probes import Prober, prober_of
from raycheck.subjects import Subject
from reference_tracer.dialects import Dialect


def formula_verdicts(
    subject: Subject, plan: LawPlan, laws: list[Law], dialect: Dialect, folder: Path
) -> Iterator[Verdict]:
    """The greeting, then the laws of formulas."""
    prober = prober_of(subject)
    if not laws:
        return
    if prober is None:
        for law in laws:
            yield verdict_on(law, plan, "unsupported", "the tracer has no probe; see `probe` in docs/attaching.md")
        return
    try:
        greeting, operations = _greeting(prober)
        yield greeting
        for law in laws:
            if greeting.verdict != "pass":
                yield verdict_on(
                    law, plan, "blocked", f"builds on {HELLO}, which is {greeting.verdict}", blocked_by=HELLO
                )
                continue
            other = spoken_otherwise(law, dialect)
            if other:
                message = f"asks for the scene model's conventions; the tracer's are {other}"
                yield verdict_on(law, plan, "unsupported", message)
                continue
            missing = [name for name in law.asks if name not in operations]
            if missing:
                yield verdict_on(law, plan, "unsupported", f"the tracer does not answer {', '.join(missing)}")
                continue
            begin = time.monotonic()
            verdict = _asked(law, prober, subject.precision, plan, folder / "laws")
            yield verdict.model_copy(update={"seconds": time.monotonic() - begin})
    finally:
        prober.close()


def _greeting(prober: Prober) -> tuple[Verdict, frozenset[str]]:
    """Whether the probe answers at all, and what it offers."""
    operations: frozenset[str] = frozenset()
    try:
        operations = prober.open()
        word, message = "pass", f"answers {', '.join(sorted(operations)) or 'no operation'}"
    except NoAnswerError as error:
        word, message = error.word, error.message
    teaches = "the probe greets and names its operations"
    return Verdict.model_validate({"check": HELLO, "verdict": word, "message": message, "teaches": teaches}), operations


def _asked(law: Law, prober: Prober, precision: str, plan: LawPlan, scenes: Path) -> Verdict:
    """The fixed cases, then the explored ones."""
    try:
        finding = examine(law, prober, precision, plan.seed)
        if plan.explore and finding.example is None:
            finding = _explored(law, prober, precision, plan, finding)
    except NoAnswerError as error:
        return _unanswered(law, prober, plan, error, scenes)
    if finding.example is None:
        if not finding.decided:
            return verdict_on(law, plan, "undecided", f"none of {finding.cases} cases can be decided in {precision}")
        told = f"{finding.cases} cases, {finding.decided} decided; the worst used {finding.worst:.2g} of its tolerance"
        return verdict_on(law, plan, "pass", told)
    case = _case(finding.example, prober, scenes).model_dump()
    return verdict_on(law, plan, "fail", _failure(finding.example), case=case)


def _explored(law: Law, prober: Prober, precision: str, plan: LawPlan, fixed: Finding) -> Finding:
    from oracles.laws.exploring import explore

    more = explore(law, prober, precision, plan.seed, plan.explore)
    return Finding(
        law, fixed.cases + more.cases, fixed.decided + more.decided, max(fixed.worst, more.worst), more.example
    )


def _failure(example: Example) -> str:
    times = f"{example.excess:.3g} times its tolerance" if np.isfinite(example.excess) else "beyond any tolerance"
    where = f" ({example.regime})" if example.regime else ""
    expected = f"expected {example.expected:.9g} ± {example.bound:.3g}"
    return f"{example.quantity}: {expected}, got {example.got:.9g}, {times}{where}"


def _case(example: Example, prober: Prober, scenes: Path) -> Case:
    return Case(
        quantity=example.quantity,
        expected=example.expected,
        bound=example.bound,
        got=example.got,
        excess=example.excess,
        regime=example.regime,
        run=prober.line(example.questions, scenes),
    )


def _unanswered(law: Law, prober: Prober, plan: LawPlan, error: NoAnswerError, scenes: Path) -> Verdict:
    """A question without a usable answer is the case to be shown."""
    case = None
    if error.arguments:
        question = Question(error.operation, error.arguments)
        case = Case(quantity=error.operation, run=prober.line((question,), scenes)).model_dump()
    return verdict_on(law, plan, error.word, error.message, case=case)
