"""What stops a command, with the exit code it ends in."""

from __future__ import annotations

from dataclasses import dataclass

CONFORMS, DIFFERS, MISUSE, CANNOT_START, BROKEN = 0, 1, 2, 3, 4
INTERRUPTED = 130


@dataclass
class RaycheckError(Exception):
    """Base: message, and what to do about it."""

    message: str
    hint: str = ""
    code: int = MISUSE

    def __str__(self) -> str:
        return f"{self.message}; {self.hint}" if self.hint else self.message


@dataclass
class UsageError(RaycheckError):
    """The call, scene or manifest is wrong (exit 2)."""


@dataclass
class StartError(RaycheckError):
    """The tracer could not be started at all (exit 3)."""

    code: int = CANNOT_START
