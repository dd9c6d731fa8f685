"""A page for each known mistake, and an index: what is written, what one sees, how to mend it."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

from oracles.verdict import Frozen
from reports import measured
from reports.power import SceneKill
from scenes.disk import write_whole

INDEX = "index.html"


class Pair(Frozen):
    """A scene with and without the mistake: PNG files, and how many of their pixels are wrong.

    finite: whether the wrong picture holds numbers only.
    """

    scene: str
    teaches: str
    width: int
    height: int
    right: bytes
    wrong: bytes
    difference: bytes
    thumbnail: bytes
    outside: int
    finite: bool

    def uri(self, kind: str) -> str:
        """One of the pictures, to embed."""
        return f"data:image/png;base64,{b64encode(getattr(self, kind)).decode()}"


class Lesson(Frozen):
    """One mistake as the dictionary has it, the scenes that notice it, and the one that shows it; None: none does.

    formula: of the slide that it comes from, empty where it comes from elsewhere; entries: of the rulebook that are
    wrong, none where writing the file is.
    """

    name: str
    group: str
    source: str
    formula: str
    wrong: str
    right: str
    seen: str
    mend: str
    fate: str
    reason: str
    entries: tuple[str, ...]
    kills: tuple[SceneKill, ...]
    pair: Pair | None
    again: str

    @property
    def look(self) -> str:
        """What one sees, as a sentence."""
        return sentence(self.seen)

    @property
    def remedy(self) -> str:
        """How to mend it, as a sentence."""
        return sentence(self.mend)

    @property
    def file(self) -> str:
        """Where its page is."""
        return f"{self.name}.html"


@dataclass(frozen=True)
class Course:
    """How the lessons were made: of how many scenes, at which size, by which suite."""

    suite: str
    scenes: int
    size: str


def sentence(said: str) -> str:
    """With a capital letter, unless it begins with a formula, and a full stop."""
    first = said.split(maxsplit=1)[0]
    word = first.rstrip(",;:").isalpha() and first.isascii() and (len(first) > 1 or first == "a")
    return f"{said[0].upper() if word else said[0]}{said[1:]}."


def write(lessons: Sequence[Lesson], course: Course, folder: Path) -> Path:
    """Write a page for each lesson, and the index; return the index's path."""
    for k, lesson in enumerate(lessons):
        before = lessons[k - 1] if k else None
        after = lessons[k + 1] if k + 1 < len(lessons) else None
        _write(
            folder / lesson.file, "lesson.html", lesson=lesson, course=course, before=before, after=after, index=INDEX
        )
    groups = [(name, list(found)) for name, found in groupby(lessons, key=lambda lesson: lesson.group)]
    _write(folder / INDEX, "lessons.html", lessons=lessons, groups=groups, course=course)
    return folder / INDEX


def write_one(lesson: Lesson, course: Course, folder: Path) -> Path:
    """Write the page of one lesson, which leads nowhere; return its path."""
    path = folder / lesson.file
    _write(path, "lesson.html", lesson=lesson, course=course, before=None, after=None, index="")
    return path


def _write(path: Path, template: str, **told: object) -> None:
    write_whole(path, measured.page(template, **told).encode())
