"""From verdicts to points.

A check that passes is earned, one that fails is lost, unless a rung it builds on failed: then it is
excused, so that one fault is not charged again by everything that stands on it. A group is worth
points × earned / (earned + lost), and nothing where all its checks are excused: what could not be shown
earns nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction

from oracles.verdict import USABLE, Verdict
from raycheck.grading.rubric import Rubric
from reports.grades import GroupScore, Line
from scenes.catalogue import Rung

HIDDEN = "Hidden scenes"
CENT = Decimal("0.01")


def score(rubric: Rubric, verdicts: Mapping[str, Verdict], hidden: Iterable[Rung]) -> tuple[GroupScore, ...]:
    """The rubric's groups, with the verdicts (by name of the rung) that they rest on."""
    groups = [_group(group.name, group.points, group.rungs, verdicts) for group in rubric.group]
    if rubric.hidden:
        groups.append(_group(HIDDEN, rubric.hidden.points, [rung.name for rung in hidden], verdicts))
    return tuple(groups)


def nothing(rubric: Rubric) -> tuple[GroupScore, ...]:
    """The rubric's groups of a submission that could not be asked."""
    groups = [GroupScore(name=group.name, points=group.points, earned=0.0) for group in rubric.group]
    if rubric.hidden:
        groups.append(GroupScore(name=HIDDEN, points=rubric.hidden.points, earned=0.0))
    return tuple(groups)


def _group(name: str, points: float, rungs: Iterable[str], verdicts: Mapping[str, Verdict]) -> GroupScore:
    lines = tuple(_line(verdicts[rung], verdicts) for rung in rungs)
    earned = sum(line.counts == "earned" for line in lines)
    counted = sum(line.counts != "excused" for line in lines)
    worth = Fraction(points) * earned / counted if counted else Fraction(0)
    return GroupScore(name=name, points=points, earned=_cents(worth), lines=lines)


def _line(verdict: Verdict, verdicts: Mapping[str, Verdict]) -> Line:
    if verdict.verdict in USABLE:
        return Line(check=verdict.check, verdict=verdict.verdict, counts="earned", why=verdict.message)
    below = [name for name in verdict.requires if name in verdicts and verdicts[name].verdict not in USABLE]
    if below and verdict.verdict != "unsupported":
        why = f"builds on image/{below[0]}, which is {verdicts[below[0]].verdict}: not charged again"
        return Line(check=verdict.check, verdict=verdict.verdict, counts="excused", why=why)
    return Line(check=verdict.check, verdict=verdict.verdict, counts="lost", why=verdict.message)


def _cents(x: Fraction) -> float:
    exact = Decimal(x.numerator) / Decimal(x.denominator)
    return float(exact.quantize(CENT, ROUND_HALF_UP))
