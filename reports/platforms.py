"""results.json as Gradescope and PrairieLearn read it.

Gradescope: "Autograder Specifications", section Output Format. PrairieLearn: "External grading", section
Grading results; a submission that is not gradable costs its author no attempt.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from reports import plain
from reports.grades import WORDS, Graded, GroupScore, Record
from scenes.disk import write_whole

GRADESCOPE, PRAIRIELEARN = "gradescope.json", "prairielearn.json"
MAX_BYTES = 2**20
"""PrairieLearn reads no larger file; outputs are cut far below it."""


def write(graded: Graded, folder: Path) -> None:
    """Write both files."""
    for name, data in ((GRADESCOPE, gradescope(graded)), (PRAIRIELEARN, prairielearn(graded))):
        write_whole(folder / name, (json.dumps(data, indent=1, ensure_ascii=False) + "\n").encode())


def gradescope(graded: Graded) -> dict[str, Any]:
    """The score, and a test a group."""
    record = graded.record
    return {
        "score": graded.score,
        "output": _said(graded),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": [
            {
                "number": str(number),
                "name": plain.line(group.name),
                "score": group.earned,
                "max_score": group.points,
                "status": "passed" if group.earned == group.points else "failed",
                "output": _output(group),
            }
            for number, group in enumerate(_counted(record), start=1)
        ],
    }


def prairielearn(graded: Graded) -> dict[str, Any]:
    """The share of the points; not gradable where nothing could be asked."""
    record = graded.record
    if record.outcome != "graded":
        return {"gradable": False, "score": 0.0, "message": _said(graded), "format_errors": [_said(graded)]}
    return {
        "gradable": True,
        "score": min(1.0, graded.score / record.points) if record.points else 0.0,
        "message": _said(graded),
        "tests": [
            {
                "name": plain.line(group.name),
                "points": group.earned,
                "max_points": group.points,
                "output": _output(group),
            }
            for group in _counted(record)
        ],
    }


def _counted(record: Record) -> list[GroupScore]:
    """The groups of which the points to earn are the sum."""
    return [group for group in record.groups if not group.left_out and not group.charges]


def _said(graded: Graded) -> str:
    record = graded.record
    parts = [f"{graded.score:g} of {record.points:g} points"]
    if record.outcome != "graded":
        parts.append(f"{WORDS[record.outcome]}: {record.message}")
    parts += [f"{group.name}: {_output(group)}" for group in record.groups if group.charges and group.lines]
    parts += [f"by hand: {entry.points:+g} ({entry.reason})" for entry in graded.adjustments]
    return plain.paragraph("\n".join(parts))


def _output(group: GroupScore) -> str:
    lines = [group.sum_in_words]
    lines += [f"{line.counts}: {line.check}: {line.verdict}; {line.why}" for line in group.lines]
    return plain.clip("\n".join(plain.line(line) for line in lines), 8000)
