"""A run in a terminal: plain lines, no colours."""

from __future__ import annotations

from oracles.verdict import Diagnosis, Verdict
from reports import conclusion, plain
from reports.results import Results


def lines(results: Results) -> list[str]:
    """A line for each verdict that is not a pass, the counts, the conclusion."""
    clean = plain.results(results)
    told = [verdict for verdict in conclusion.ordered(clean.verdicts) if verdict.verdict != "pass"]
    word = max((len(verdict.verdict) for verdict in told), default=0)
    check = max((len(verdict.check) for verdict in told), default=0)
    return [
        *(f"{v.verdict:{word}}  {v.check:{check}}  {_message(v)}".rstrip() for v in told),
        ", ".join(f"{n} {name}" for name, n in conclusion.counts(clean)) or "0 checks",
        f"{clean.subject.name} {conclusion.sentence(clean)}",
        *(_diagnosis(clean.diagnosis) if clean.diagnosis else ()),
    ]


def _diagnosis(found: Diagnosis) -> list[str]:
    """The sentence, and of each fault the line as it is written and as it should be."""
    lines = [f"diagnosis: {found.sentence}"]
    for fault in found.faults:
        lines += [f"  {fault.name}: {fault.seen} ({fault.source})"]
        lines += [f"    wrong: {fault.wrong}", f"    right: {fault.right}", f"    mend:  {fault.mend}"]
    return lines


def _message(verdict: Verdict) -> str:
    """The message on one line; of a blocked check at least its blocker."""
    blocker = f"blocked by {verdict.blocked_by}" if verdict.blocked_by else ""
    return plain.line(verdict.message) or blocker
