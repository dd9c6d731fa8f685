"""From verdicts to points.

A check that passes is earned, one that fails is lost, unless a rung it builds on failed: then it is
excused, so that one fault is not charged again by everything that stands on it. A group is worth
points × earned / (earned + lost), and nothing where all its checks are excused: what could not be shown
earns nothing. What does not concern a tracer is left out; a group of which all is left out does not count.

Where known faults explain every wrong picture, what they explain counts as earned, and each of them costs the
rubric's points for a mistake, once; never more than the failures would have.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from oracles.verdict import USABLE, Verdict
from raycheck.grading.rubric import Rubric
from reports.grades import EARNED, GroupScore, Line
from scenes.catalogue import Rung

HIDDEN, MISTAKES = "Hidden scenes", "Known mistakes"
CENT = Decimal("0.01")


@dataclass(frozen=True)
class Evidence:
    """What a score rests on: verdicts by check.

    explained: failed checks that the known faults explain, which are charged by themselves, and by which; mistakes:
    these faults, and what each is; foreign: checks that say nothing about this tracer, and why.
    """

    verdicts: Mapping[str, Verdict]
    explained: Mapping[str, str] = field(default_factory=dict)
    mistakes: Mapping[str, str] = field(default_factory=dict)
    foreign: Mapping[str, str] = field(default_factory=dict)


def score(rubric: Rubric, evidence: Evidence, hidden: Iterable[Rung]) -> tuple[GroupScore, ...]:
    """The rubric's groups, with the verdicts that they rest on."""
    checks = [f"image/{rung.name}" for rung in hidden]
    groups = _groups(rubric, evidence, checks)
    if rubric.mistakes is None:
        return groups
    charged = _groups(rubric, replace(evidence, explained={}), checks)
    relief = sum(group.earned for group in groups) - sum(group.earned for group in charged)
    if relief <= 0.0:
        return (*charged, _mistakes({}, 0.0))
    return (*groups, _mistakes(evidence.mistakes, min(relief, rubric.mistakes.points * len(evidence.mistakes))))


def _groups(rubric: Rubric, evidence: Evidence, hidden: Sequence[str]) -> tuple[GroupScore, ...]:
    groups = [_group(g.name, g.points, g.checks, evidence, g.unsupported) for g in rubric.group]
    if rubric.hidden:
        groups.append(_group(HIDDEN, rubric.hidden.points, hidden, evidence, "lost"))
    return tuple(groups)


def _mistakes(faults: Mapping[str, str], cost: float) -> GroupScore:
    lines = [Line(check=f"fault/{name}", verdict="fail", counts="charged", why=why) for name, why in faults.items()]
    return GroupScore(name=MISTAKES, points=0.0, earned=-round(cost, 2) or 0.0, lines=tuple(lines))


def nothing(rubric: Rubric) -> tuple[GroupScore, ...]:
    """The rubric's groups of a submission that could not be asked."""
    groups = [GroupScore(name=group.name, points=group.points, earned=0.0) for group in rubric.group]
    if rubric.hidden:
        groups.append(GroupScore(name=HIDDEN, points=rubric.hidden.points, earned=0.0))
    if rubric.mistakes:
        groups.append(_mistakes({}, 0.0))
    return tuple(groups)


def _group(name: str, points: float, checks: Iterable[str], evidence: Evidence, unsupported: str) -> GroupScore:
    lines = tuple(_line(check, evidence, unsupported) for check in checks)
    earned = sum(line.counts in EARNED for line in lines)
    counted = sum(line.counts in (*EARNED, "lost") for line in lines)
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
    if check in evidence.explained:
        return Line(check=check, verdict=verdict.verdict, counts="explained", why=evidence.explained[check])
    reason = _below(verdict, evidence.verdicts)
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
