"""Points by hand: lateness, style. A CSV file with the columns submission, points, reason."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Collection
from pathlib import Path

from raycheck.errors import UsageError
from reports.grades import Adjustment
from scenes.disk import read_bounded

MAX_BYTES = 16 * 2**20
COLUMNS = ["submission", "points", "reason"]

Adjustments = dict[str, tuple[Adjustment, ...]]


def load(path: Path | None, names: Collection[str]) -> Adjustments:
    """The adjustments by submission; every line must name a submission and a number of points."""
    if path is None:
        return {}
    try:
        text = read_bounded(path, MAX_BYTES).decode("utf-8-sig")
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}", f"a CSV file with {', '.join(COLUMNS)}") from None
    except UnicodeError as error:
        raise UsageError(f"{path}: {error}", "a CSV file in UTF-8") from None
    rows = csv.reader(io.StringIO(text, newline=""))
    if next(rows, None) != COLUMNS:
        raise UsageError(f"{path}: line 1: not the columns {', '.join(COLUMNS)}", "in this order")
    found: Adjustments = {}
    for row in rows:
        if row:
            name, entry = _entry(row, f"{path}: line {rows.line_num}", names)
            found[name] = (*found.get(name, ()), entry)
    return found


def _entry(row: list[str], place: str, names: Collection[str]) -> tuple[str, Adjustment]:
    if len(row) != len(COLUMNS):
        raise UsageError(f"{place}: {len(row)} values", f"{', '.join(COLUMNS)}")
    name, points, reason = row
    if name not in names:
        raise UsageError(f"{place}: no submission is called {name!r}", "names as in grades.csv")
    try:
        number = float(points)
    except ValueError:
        number = math.nan
    if not math.isfinite(number) or not reason:
        raise UsageError(f"{place}: {points!r}, {reason!r}", "a number of points, for example -5, and a reason")
    return name, Adjustment(points=number, reason=reason)
