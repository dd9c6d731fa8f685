"""Text from strangers made plain: a tracer's name and output end in a lecturer's browser and terminal.

Removed are terminal escape sequences, control characters, marks that reorder text, and what XML 1.0
forbids; what remains has a bounded length. Escaping is left to those who write HTML and XML.
"""

from __future__ import annotations

import re
from typing import Any

from reports.results import Results

LINE = 500  # characters of a name, a slide, a path
PARAGRAPH = 2000  # characters of a message or a command
TAIL = 8000  # characters of a process's last output
TAIL_LINES = 120

_ESCAPES = re.compile(
    r"\x1b\][^\x07\x1b\n]*(?:\x07|\x1b\\)?"  # operating system command, up to the line's end
    r"|\x1b[PX^_][^\x1b\n]*(?:\x1b\\)?"  # device control and private strings
    r"|(?:\x1b\[|\x9b)[0-?]*[ -/]*[@-~]?"  # control sequence: colours, cursor
    r"|\x1b[ -/]*[0-~]?"  # every other escape
)
_BREAKS = re.compile("\r\n|[\r\x0b\x0c\x85\u2028\u2029]")
_UNSEEN = re.compile(
    "[\x00-\x08\x0e-\x1f\x7f-\x9f"  # control characters but tab and newline
    "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"  # marks that reorder text
    "\ud800-\udfff\ufeff\ufffe\uffff]"  # no characters at all
)


def text(raw: str) -> str:
    """Printable characters, tabs and newlines of raw, in order."""
    return _UNSEEN.sub("", _BREAKS.sub("\n", _ESCAPES.sub("", raw)))


def clip(raw: str, limit: int) -> str:
    """At most limit characters; a cut end shows as an ellipsis."""
    return raw if len(raw) <= limit else raw[: limit - 1] + "…"


def line(raw: str) -> str:
    """One line of at most LINE characters."""
    return clip(_single(raw), LINE)


def command(raw: str) -> str:
    """One line of at most PARAGRAPH characters."""
    return clip(_single(raw), PARAGRAPH)


def paragraph(raw: str) -> str:
    """A message of one or more lines, at most PARAGRAPH characters."""
    return clip(text(raw).strip(), PARAGRAPH)


def tail(raw: str) -> str:
    """The last TAIL_LINES lines, at most TAIL characters; a cut start shows as an ellipsis."""
    clean = text(raw).strip("\n")
    kept = "\n".join(clean.split("\n")[-TAIL_LINES:])[-TAIL:]
    return kept if kept == clean else "…\n" + kept


def results(raw: Results) -> Results:
    """The same results with every string plain, keys of mappings included."""
    return Results.model_validate(walk(raw.model_dump()))


def walk(value: Any) -> Any:
    """Nested data with every string in it plain."""
    return _walk(value, "")


_FIELDS = dict.fromkeys(("reproduce", "command", "run", "judge"), command)
_FIELDS |= {"message": paragraph, "sentence": paragraph, "output_tail": tail, "text": tail}


def _single(raw: str) -> str:
    return text(raw).replace("\n", " ").replace("\t", " ").strip()


def _walk(value: Any, field: str) -> Any:
    """The value with its strings plain; field: the key under which it stands."""
    if isinstance(value, str):
        return _FIELDS.get(field, line)(value)
    if isinstance(value, dict):
        return {line(key): _walk(entry, key) for key, entry in value.items()}
    if isinstance(value, tuple):
        return tuple(_walk(entry, field) for entry in value)
    return value
