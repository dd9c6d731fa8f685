"""Known failures: listed with a reason, held to it, and reported as soon as they are fixed."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from oracles.verdict import Verdict
from raycheck.errors import UsageError
from scenes.disk import read_bounded

MAX_BYTES = 2**20
PEERS = Path(__file__).resolve().parent / "peers"
Said = Annotated[str, Field(min_length=1)]


class Entry(BaseModel):
    """One line of the file: the check, why it fails, where that is discussed."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    check: str
    reason: Said
    url: Said


class _File(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    known: tuple[Entry, ...] = ()


@dataclass(frozen=True)
class Known:
    """The entries by check."""

    entries: dict[str, Entry]

    def apply(self, verdict: Verdict) -> Verdict:
        """A listed failure is `known`; a listed pass is `fixed`, until its line is removed."""
        entry = self.entries.get(verdict.check)
        if entry is None:
            return verdict
        if verdict.verdict == "pass":
            message = f"passes, although listed as known ({entry.reason}); remove its line"
            return verdict.model_copy(update={"verdict": "fixed", "message": message})
        if verdict.verdict in ("fail", "invalid", "crash", "timeout", "error"):
            message = f"known: {entry.reason} ({entry.url}); {verdict.message}"
            return verdict.model_copy(update={"verdict": "known", "message": message})
        return verdict


@dataclass(frozen=True)
class Shipped(Known):
    """Our own list for a peer: it holds at each scene's own size, so at others a listed pass is a pass."""

    def apply(self, verdict: Verdict) -> Verdict:
        """A listed failure is `known`."""
        return verdict if verdict.verdict == "pass" else super().apply(verdict)


def shipped(spec: str, checks: set[str]) -> Known:
    """The list of the peer that `spec` attaches; an empty one for other tracers."""
    name, *options = spec.removeprefix("builtin:").split("/")
    path = PEERS / f"{'-'.join([name, *options[1:]])}.toml"
    return Shipped(load(path, checks).entries) if spec.startswith("builtin:") and path.is_file() else Known({})


def load(path: Path | None, checks: set[str]) -> Known:
    """Read a known-failures file; every entry must name a check of the suite."""
    if path is None:
        return Known({})
    try:
        data = read_bounded(path, MAX_BYTES)
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}", "a TOML file of [[known]] entries") from None
    try:
        entries = _File.model_validate(tomllib.loads(data.decode("utf-8"))).known
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(part) for part in first["loc"])
        raise UsageError(f"{path}: {place}: {first['msg']}", "[[known]] with check, reason and url") from None
    except (ValueError, RecursionError) as error:  # ValueError: TOML's and Unicode's own, and integers without end
        raise UsageError(f"{path}: not TOML: {error}") from None
    for entry in entries:
        if entry.check not in checks:
            raise UsageError(
                f"{path}: no check is called {entry.check!r}", "names as in the report: image/SCENE, law/NAME"
            )
    return Known({entry.check: entry for entry in entries})
