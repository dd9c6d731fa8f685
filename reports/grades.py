"""A submission's grade: what was asked, what each answer earned, and why. All grading reports are written from it."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from oracles.verdict import Frozen, Word
from scenes.disk import read_bounded, write_whole

MAX_BYTES = 16 * 2**20
Outcome = Literal[
    "graded",
    "refused",  # the folder or archive holds what is not taken in
    "manifest",  # no usable raycheck.toml, and the rubric says nothing
    "build",  # the build command failed
    "start",  # the tracer could not be started
    "protocol",  # it ran, but not one usable picture came back
]
WORDS: dict[Outcome, str] = {
    "graded": "graded",
    "refused": "not taken in",
    "manifest": "no usable manifest",
    "build": "does not build",
    "start": "does not start",
    "protocol": "gives no usable picture",
}


EARNED = ("earned", "explained")
"""What a line may count as that earns points."""


class Line(Frozen):
    """One check of a group.

    counts: earned, lost, excused because what it builds on failed, left out as not its concern, explained by a known
    fault and so earned; or the fault itself, charged.
    """

    check: str
    verdict: Word
    counts: Literal["earned", "lost", "excused", "left out", "explained", "charged"]
    why: str


class GroupScore(Frozen):
    """A group of checks: points × earned / (earned + lost), to the hundredth."""

    name: str
    points: float
    earned: float
    lines: tuple[Line, ...] = ()

    @property
    def counted(self) -> int:
        """Checks that count, excused ones not among them."""
        return sum(line.counts in (*EARNED, "lost") for line in self.lines)

    @property
    def left_out(self) -> bool:
        """Does the group not count for this tracer."""
        return bool(self.lines) and all(line.counts == "left out" for line in self.lines)

    @property
    def passed(self) -> int:
        return sum(line.counts in EARNED for line in self.lines)

    @property
    def charges(self) -> bool:
        """Does it take points instead of giving them."""
        return not self.points and all(line.counts == "charged" for line in self.lines)

    @property
    def sum_in_words(self) -> str:
        """How the points came about."""
        if self.charges:
            once = f"{len(self.lines)} charged, once for all that it broke" if self.lines else "none charged"
            return f"{once}: {_points(self.earned)}"
        if self.left_out:
            return "left out: not asked of this tracer"
        excused = len(self.lines) - self.counted
        away = f", {excused} not counted" if excused else ""
        if not self.counted:
            return f"nothing could be shown: {_points(self.earned)} of {_points(self.points)}{away}"
        share = f"{self.passed} of {self.counted}"
        return f"{_points(self.points)} × {share}{away} = {_points(self.earned)}"


class Adjustment(Frozen):
    """Points added (or, below 0, taken) by hand, and why."""

    points: float
    reason: str


class Record(Frozen):
    """The grade of one submission; `key` names everything that it follows from.

    faults: names of the faults found in it; outside: mean share of wrong pixels in the pictures asked for, 1 where
    none came; speed: times as fast as the reference tracer. None: not measured.
    """

    schema_version: Literal[1] = 1
    name: str
    slug: str
    key: str
    tracer: str = ""
    outcome: Outcome
    message: str = ""
    groups: tuple[GroupScore, ...]
    faults: tuple[str, ...] = ()
    outside: float | None = None
    speed: float | None = None

    @property
    def points(self) -> float:
        return round(sum(group.points for group in self.groups if not group.left_out), 2)

    @property
    def earned(self) -> float:
        return round(sum(group.earned for group in self.groups), 2)

    def total(self, adjustments: tuple[Adjustment, ...]) -> float:
        """The score with what was added by hand; never below 0."""
        return max(0.0, round(self.earned + sum(entry.points for entry in adjustments), 2))


class Graded(Frozen):
    """A record with what was added to it by hand: a row of the class."""

    record: Record
    adjustments: tuple[Adjustment, ...] = ()

    @property
    def score(self) -> float:
        return self.record.total(self.adjustments)

    @property
    def band(self) -> str:
        """full, part, none or ungraded: what the class page filters by."""
        if self.record.outcome != "graded":
            return "ungraded"
        return "full" if self.score >= self.record.points else "part" if self.score > 0 else "none"


def _points(x: float) -> str:
    return f"{x:g}"


def write(record: Record, folder: Path) -> Path:
    """Write the record whole or not at all; return its path."""
    path = folder / f"{record.slug}.json"
    write_whole(path, (record.model_dump_json(indent=1) + "\n").encode())
    return path


def read(path: Path) -> Record | None:
    """The record of an earlier run, or None if there is none that this version reads."""
    try:
        return Record.model_validate_json(read_bounded(path, MAX_BYTES))
    except (OSError, ValidationError):
        return None


def explanation(graded: Graded) -> list[str]:
    """The score line by line."""
    record = graded.record
    lines = [f"{record.name}: {graded.score:g} of {record.points:g}"]
    if record.outcome != "graded":
        lines.append(f"  {WORDS[record.outcome]}: {record.message}")
    for group in record.groups:
        lines.append(f"  {group.name}: {group.sum_in_words}")
        for line in group.lines:
            lines.append(f"    {line.counts:8} {line.check}: {line.verdict}; {line.why}")
    lines += [f"  by hand: {entry.points:+g} ({entry.reason})" for entry in graded.adjustments]
    return lines
