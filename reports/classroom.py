"""A class: grades.csv, a page of it all, and a page for each student."""

from __future__ import annotations

import csv
import io
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from oracles.verdict import Frozen
from reports import class_chart, page, plain, platforms, results
from reports.grades import WORDS, Graded
from reports.stored import ResultsError
from scenes.disk import write_whole

CSV = "grades.csv"
STUDENTS = "students"
BARS = 10
STYLES = ("page.css", "class.css")
BANDS = {"full": "full score", "part": "part of it", "none": "no points", "ungraded": "not graded"}
FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""A cell that begins so is run as a formula by spreadsheets (OWASP, "CSV Injection")."""
HIDDEN = "image/hidden-"
"""How checks begin whose scenes are each run's own."""
SHOWN = 6
"""Checks named in a row of the class."""


class Classroom(Frozen):
    """All submissions graded so far, of those expected."""

    name: str
    suite: str
    catalogue: str
    seed: int
    size: str
    expected: int
    graded: tuple[Graded, ...]

    @property
    def complete(self) -> bool:
        return len(self.graded) == self.expected


@dataclass(frozen=True)
class Rate:
    """How a check fared in the class."""

    check: str
    earned: int
    lost: int
    excused: int
    away: int = 0

    @property
    def asked(self) -> int:
        return self.earned + self.lost + self.excused

    @property
    def percent(self) -> float:
        return round(100.0 * self.earned / self.asked, 1)


@dataclass(frozen=True)
class Bar:
    """One bar of the histogram, in units of its picture."""

    x: float
    width: float
    height: float
    count: int
    label: str
    words: str

    @property
    def y(self) -> float:
        return round(120.0 - self.height, 2)

    @property
    def middle(self) -> float:
        return round(self.x + self.width / 2, 2)


@dataclass(frozen=True)
class Histogram:
    """The distribution of the scores."""

    bars: tuple[Bar, ...]

    @property
    def words(self) -> str:
        return "; ".join(bar.words for bar in self.bars if bar.count)


def write(classroom: Classroom, out: Path) -> None:
    """Each student's files, then the class's."""
    for graded in classroom.graded:
        folder = out / STUDENTS / graded.record.slug
        folder.mkdir(parents=True, exist_ok=True)
        write_whole(folder / page.FILE, student(graded, folder).encode())
        platforms.write(graded, folder)
    write_whole(out / CSV, table(classroom).encode())
    write_whole(out / page.FILE, overview(classroom).encode())


def table(classroom: Classroom) -> str:
    """grades.csv: a row a submission, a column a group."""
    groups = [group.name for group in classroom.graded[0].record.groups] if classroom.graded else []
    written = io.StringIO(newline="")
    sheet = csv.writer(written, lineterminator="\n")
    sheet.writerow(["submission", "score", "of", "outcome", *map(_cell, groups), "by hand"])
    for graded in classroom.graded:
        record = graded.record
        hand = sum(entry.points for entry in graded.adjustments)
        earned = ["" if group.left_out else f"{group.earned:g}" for group in record.groups]
        head = [_cell(record.name), f"{graded.score:g}", f"{record.points:g}", record.outcome]
        sheet.writerow([*head, *earned, f"{hand:g}"])
    return written.getvalue()


def _cell(text: str) -> str:
    """Text that no spreadsheet takes for a formula."""
    line = plain.line(text)
    return f"'{line}" if line.startswith(FORMULA) else line


def student(graded: Graded, folder: Path) -> str:
    """A student's page: the score, and below it the check's own page where there is one."""
    told = {"graded": cleaned(graded), "policy": page.policy(STYLES), "words": WORDS}
    try:
        found = results.read(folder)
    except ResultsError:
        return page.environment().get_template("ungraded.html").render(**told)
    return page.render(found, folder, "student.html", **told)


def overview(classroom: Classroom) -> str:
    """The class's page."""
    clean = classroom.model_copy(update={"graded": tuple(map(cleaned, classroom.graded))})
    counted = Counter(graded.band for graded in clean.graded)
    return (
        page.environment()
        .get_template("class.html")
        .render(
            classroom=clean,
            rows=[(graded, losses(graded)) for graded in clean.graded],
            tiles=_tiles(clean),
            histogram=histogram(clean),
            rates=rates(clean),
            chart=class_chart.scatter(dots(clean)),
            faults=faults(clean),
            bands=[(band, words, counted[band]) for band, words in BANDS.items()],
            words=WORDS,
            policy=page.policy(STYLES, "class.js"),
        )
    )


def cleaned(graded: Graded) -> Graded:
    """The same grade with every string plain."""
    record = graded.record
    groups = tuple(
        group.model_copy(
            update={"lines": tuple(line.model_copy(update={"why": plain.line(line.why)}) for line in group.lines)}
        )
        for group in record.groups
    )
    update = {
        "name": plain.line(record.name),
        "tracer": plain.line(record.tracer),
        "message": plain.tail(record.message),
        "faults": tuple(plain.line(fault) for fault in record.faults),
        "groups": groups,
    }
    hand = tuple(e.model_copy(update={"reason": plain.paragraph(e.reason)}) for e in graded.adjustments)
    return Graded(record=record.model_copy(update=update), adjustments=hand)


def rates(classroom: Classroom) -> list[Rate]:
    """How each check fared, most losses first."""
    counted: dict[str, Counter[str]] = {}
    for graded in classroom.graded:
        for group in graded.record.groups:
            for line in () if group.charges else group.lines:
                # Hidden scenes have names that mean nothing to a class
                name = group.name if line.check.startswith(HIDDEN) else line.check
                counted.setdefault(name, Counter())[line.counts] += 1
    found = [
        Rate(name, n["earned"], n["lost"] + n["explained"], n["excused"], n["left out"]) for name, n in counted.items()
    ]
    return sorted((rate for rate in found if rate.asked), key=lambda rate: -rate.lost)


def dots(classroom: Classroom) -> list[class_chart.Dot]:
    """The submissions that were timed."""
    return [
        class_chart.Dot(record.name, f"{STUDENTS}/{record.slug}/{page.FILE}", record.speed, record.outside)
        for record in (graded.record for graded in classroom.graded)
        if record.speed is not None and record.outside is not None
    ]


def faults(classroom: Classroom) -> list[tuple[str, int]]:
    """The faults found in the class and in how many submissions, the most common first."""
    counted = Counter(name for graded in classroom.graded for name in dict.fromkeys(graded.record.faults))
    return counted.most_common()


def histogram(classroom: Classroom) -> Histogram:
    """Scores in BARS classes from 0 to the rubric's points, more than that in the last."""
    points = max((graded.record.points for graded in classroom.graded), default=0.0) or 1.0
    places = [min(BARS - 1, int(BARS * graded.score / points)) for graded in classroom.graded]
    counts = [places.count(k) for k in range(BARS)]
    most = max([1, *counts])
    step = 400.0 / BARS
    bars = []
    for k, count in enumerate(counts):
        low, high = points * k / BARS, points * (k + 1) / BARS
        words = f"{low:g} to {high:g} points: {count}"
        bars.append(Bar(20.0 + step * k + 2.0, step - 4.0, round(100.0 * count / most, 2), count, f"{low:g}", words))
    return Histogram(tuple(bars))


def _tiles(classroom: Classroom) -> list[tuple[str, str]]:
    scores = sorted(graded.score for graded in classroom.graded)
    if not scores:
        return [("submissions", "0")]
    middle = len(scores) // 2
    median = scores[middle] if len(scores) % 2 else (scores[middle - 1] + scores[middle]) / 2
    away = sum(graded.record.outcome != "graded" for graded in classroom.graded)
    return [
        ("points to earn", f"{classroom.graded[0].record.points:g}"),
        ("median", f"{median:.4g}"),
        ("mean", f"{sum(scores) / len(scores):.4g}"),
        ("not graded", str(away)),
    ]


def losses(graded: Graded) -> str:
    """The checks that cost points, the first few by name."""
    lost = [
        "a hidden scene" if line.check.startswith(HIDDEN) else line.check.removeprefix("image/").removeprefix("fault/")
        for group in graded.record.groups
        for line in group.lines
        if line.counts in ("lost", "charged")
    ]
    names = list(dict.fromkeys(lost))
    more = f" and {len(names) - SHOWN} more" if len(names) > SHOWN else ""
    return ", ".join(names[:SHOWN]) + more or "none"
