"""From verdicts to points.

A check that passes is earned, one that fails is lost, unless a rung it builds on failed: then it is
excused, so that one fault is not charged again by everything that stands on it. A group is worth
points × earned / (earned + lost), and nothing where all its checks are excused: what could not be shown
earns nothing. What does not concern a tracer is left out; a group of which all is left out does not count.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from oracles.verdict import USABLE, Verdict
from raycheck.grading.rubric import Rubric
from reports.grades import GroupScore, Line
from scenes.catalogue import Rung

HIDDEN = "Hidden scenes"
CENT = Decimal("0.01")


@dataclass(frozen=True)
class Evidence:
    """What a score rests on: verdicts by check.

    excused: failed checks that are not charged, and why, for example because a fault that is charged elsewhere
    explains them; foreign: checks that say nothing about this tracer, and why.
    """

    verdicts: Mapping[str, Verdict]
    excused: Mapping[str, str] = field(default_factory=dict)
    foreign: Mapping[str, str] = field(default_factory=dict)


def score(rubric: Rubric, evidence: Evidence, hidden: Iterable[Rung]) -> tuple[GroupScore, ...]:
    """The rubric's groups, with the verdicts that they rest on."""
    groups = [_group(g.name, g.points, g.checks, evidence, g.unsupported) for g in rubric.group]
    if rubric.hidden:
        checks = [f"image/{rung.name}" for rung in hidden]
        groups.append(_group(HIDDEN, rubric.hidden.points, checks, evidence, "lost"))
    return tuple(groups)


def nothing(rubric: Rubric) -> tuple[GroupScore, ...]:
    """The rubric's groups of a submission that could not be asked."""
    groups = [GroupScore(name=group.name, points=group.points, earned=0.0) for group in rubric.group]
    if rubric.hidden:
        groups.append(GroupScore(name=HIDDEN, points=rubric.hidden.points, earned=0.0))
    return tuple(groups)


def _group(name: str, points: float, checks: Iterable[str], evidence: Evidence, unsupported: str) -> GroupScore:
    lines = tuple(_line(check, evidence, unsupported) for check in checks)
    earned = sum(line.counts == "earned" for line in lines)
    counted = sum(line.counts in ("earned", "lost") for line in lines)
    worth = Fraction(points) * earned / counted if counted else Fraction(0)
    return GroupScore(name=name, points=points, earned=_cents(worth), lines=lines)


def _line(check: str, evidence: Evidence, unsupported: str) -> Line:
    verdict = evidence.verdicts[check]
    if verdict.verdict in USABLE:
        return Line(check=check, verdict=verdict.verdict, counts="earned", why=verdict.message)
    if check in evidence.foreign:
        return Line(check=check, verdict=verdict.verdict, counts="left out", why=evidence.foreign[check])
    if verdict.verdict == "unsupported":
        counts = "left out" if unsupported == "left out" else "lost"
        return Line(check=check, verdict=verdict.verdict, counts=counts, why=verdict.message)
    reason = evidence.excused.get(check) or _below(verdict, evidence.verdicts)
    if reason:
        return Line(check=check, verdict=verdict.verdict, counts="excused", why=reason)
    return Line(check=check, verdict=verdict.verdict, counts="lost", why=verdict.message)


def _below(verdict: Verdict, verdicts: Mapping[str, Verdict]) -> str:
    """Why a failure is not charged again; empty where it is charged."""
    if verdict.verdict == "blocked":
        return f"{verdict.message}: not charged again"
    for name in verdict.requires:
        below = verdicts.get(f"image/{name}")
        if below is not None and below.verdict not in USABLE:
            return f"builds on {below.check}, which is {below.verdict}: not charged again"
    return ""


def _cents(x: Fraction) -> float:
    exact = Decimal(x.numerator) / Decimal(x.denominator)
    return float(exact.quantize(CENT, ROUND_HALF_UP))
