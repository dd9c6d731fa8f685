"""The lines of the probe protocol: questions out, answers in (docs/attaching.md, "Probes")."""

from __future__ import annotations

import math

from oracles.laws import NoAnswerError
from reference_tracer.operations import ANSWERS

VERSION = 1
HELLO = f"hello {VERSION}"
NOTHING = {"sphere": "miss", "plane": "miss", "refract": "tir"}
"""The word that an operation may answer instead of numbers."""

LINE_LIMIT = 4096
"""Bytes of an answer; three numbers need some 80."""

Numbers = tuple[float, ...]


def question(operation: str, arguments: Numbers) -> str:
    """A request; %.17g tells any two doubles apart."""
    return " ".join([operation, *(f"{value:.17g}" for value in arguments)])


def template(operation: str, count: int) -> str:
    """The request of an operation with places for `%`."""
    return operation + " %.17g" * count + "\n"


def answer(operation: str, line: bytes) -> Numbers:
    """The numbers of an answer, NaN for miss and tir; raise NoAnswerError where the line is no answer."""
    words = line.split()
    if len(words) == 1 and not words[0][:1].isdigit():
        word = words[0].decode("ascii", "replace")
        if word == NOTHING.get(operation):
            return (math.nan,) * ANSWERS[operation]
        if word == "unsupported":
            raise NoAnswerError("unsupported", f"the tracer does not answer {operation}")
    if len(words) != ANSWERS[operation]:
        raise NoAnswerError("invalid", f"{shown(line)} has {_words(len(words))}; {expected(operation)}")
    try:
        values = tuple(map(float, words))
    except ValueError:
        raise NoAnswerError("invalid", f"{shown(line)} is not an answer; {expected(operation)}") from None
    if not all(map(math.isfinite, values)) or b"_" in line:
        raise NoAnswerError("invalid", f"{shown(line)} is not finite; {expected(operation)}")
    return values


def expected(operation: str) -> str:
    """What an answer to this operation looks like, in words."""
    count = ANSWERS[operation]
    numbers = f"{count} finite number{'s' if count > 1 else ''}"
    word = NOTHING.get(operation)
    return f"expected {numbers} or {word}" if word else f"expected {numbers}"


def hello(line: bytes, precision: str) -> frozenset[str]:
    """The operations of a greeting; raise NoAnswerError where it is none, or of another precision."""
    words = line.decode("utf-8", "replace").split()
    if len(words) < 4 or words[0] != "raycheck" or words[3] not in ("float32", "float64"):
        raise NoAnswerError(
            "invalid", f"{shown(line)} does not answer {HELLO!r}; expected raycheck 1 NAME float32|float64 OP OP ..."
        )
    if words[1] != str(VERSION):
        raise NoAnswerError("invalid", f"the tracer speaks version {words[1][:20]!r}; expected {VERSION}")
    if words[3] != precision:
        raise NoAnswerError("invalid", f"the probe computes in {words[3]}; raycheck.toml says {precision}")
    return frozenset(words[4:]) & frozenset(ANSWERS)


def shown(line: bytes) -> str:
    """A line of a stranger for a message: quoted and short."""
    return repr(line[:60].decode("utf-8", "replace")) + ("..." if len(line) > 60 else "")


def _words(count: int) -> str:
    return "no words" if count == 0 else f"{count} word{'s' if count > 1 else ''}"
