"""index.html: a run on one page, in one file, offline; with scripts off it still tells everything.

Its Content-Security-Policy admits nothing but this page's own style and script, by their hashes, and
embedded pictures. What came from the tracer is text: made plain, bounded, escaped.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from jinja2 import Environment

from oracles.verdict import Pixel, Verdict, Word
from reports import conclusion, format, plain, templating
from reports.pictures import Picture, gallery
from reports.results import Results
from scenes.disk import write_whole

FILE = "index.html"

SYMBOLS: dict[Word, str] = {
    "pass": "✓",
    "fail": "✗",
    "invalid": "✗",
    "crash": "✗",
    "timeout": "✗",
    "error": "✗",
    "fixed": "↑",
    "blocked": "⊘",
    "undecided": "?",
    "unsupported": "–",
    "known": "k",
}
"""Colour never tells alone: each word has a sign."""


@dataclass(frozen=True)
class Entry:
    """A verdict on the page: its place to link to, and its pictures by kind."""

    anchor: str
    verdict: Verdict
    pictures: dict[str, Picture]

    @property
    def mark(self) -> Pixel | None:
        """The worst pixel, where the verdict's pictures show it one to one."""
        judged = self.verdict.judged
        if judged is None or judged.worst is None:
            return None
        sizes = [(p.width, p.height) for p in self.pictures.values() if not p.missing]
        worst = judged.worst
        shown = all(w * h == judged.pixels and 0 <= worst.i < w and 0 <= worst.j < h for w, h in sizes)
        return worst if shown else None


def write(results: Results, folder: Path) -> Path:
    """Write index.html whole or not at all; return its path."""
    path = folder / FILE
    write_whole(path, render(results, folder).encode())
    return path


def render(results: Results, folder: Path, template: str = FILE, **more: object) -> str:
    """The page's text; the pictures are read from folder. A template that extends this page's may be told more."""
    clean = plain.results(results)
    entries = _entries(clean, folder)
    return (
        environment()
        .get_template(template)
        .render(
            results=clean,
            sentence=conclusion.sentence(clean),
            counts=conclusion.counts(clean),
            ladder=entries,
            against=_with(entries, *conclusion.AGAINST),
            blocked=_with(entries, "blocked"),
            open=_with(entries, *conclusion.OPEN),
            passed=_with(entries, "pass"),
            diagnosed=_diagnosed(clean, folder),
            anchors={entry.verdict.check: entry.anchor for entry in reversed(entries)},
            **({"policy": policy()} | more),
        )
    )


def _entries(results: Results, folder: Path) -> list[Entry]:
    """Every verdict in the run's order; the pictures are spent on the worst first."""
    wanted = [name for verdict in conclusion.ordered(results.verdicts) for _, name in _pictures(verdict)]
    found = gallery(folder, wanted)
    return [
        Entry(_anchor(index, verdict.check), verdict, {kind: found[name] for kind, name in _pictures(verdict)})
        for index, verdict in enumerate(results.verdicts, start=1)
    ]


def _diagnosed(results: Results, folder: Path) -> dict[str, Picture]:
    """The picture pair of the diagnosis, and what the faults that it names make of the scene."""
    found = results.diagnosis
    verdict = next((v for v in results.verdicts if found and v.check == found.check), None)
    if found is None or verdict is None:
        return {}
    names = {"expected": verdict.pictures.expected, "got": verdict.pictures.got, "with the fault": found.picture}
    shown = gallery(folder, [name for name in names.values() if name])
    return {kind: shown[name] for kind, name in names.items() if name}


def _pictures(verdict: Verdict) -> Iterator[tuple[str, str]]:
    """(kind, path) of the pictures that the page shows: of a pass only what it got."""
    kinds = ("got",) if verdict.verdict == "pass" else ("expected", "got", "difference")
    for kind in kinds:
        name = getattr(verdict.pictures, kind)
        if name is not None:
            yield kind, name


def _with(entries: list[Entry], *words: Word) -> list[Entry]:
    return [entry for entry in entries if entry.verdict.verdict in words]


def _anchor(index: int, check: str) -> str:
    """An id of harmless letters, unique by its number."""
    return f"check-{index}-{re.sub('[^a-z0-9]+', '-', check.lower())[:60].strip('-')}"


@cache
def environment() -> Environment:
    """The templates of the report, with its filters."""
    shown = ("value", "measure", "count", "share", "seconds", "excess", "off", "unit", "doubtful", "kinds", "shell")
    named = (*shown, "slide", "points", "signed", "times", "triple")
    environment = templating.templates({name: getattr(format, name) for name in named})
    environment.globals["symbols"] = SYMBOLS
    return environment


@cache
def policy(styles: tuple[str, ...] = ("page.css",), script: str = "page.js") -> str:
    """A page's Content-Security-Policy."""
    return templating.policy(environment(), styles, script)
