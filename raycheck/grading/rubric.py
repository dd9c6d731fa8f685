"""rubric.toml: what a class is asked, and what it is worth."""

from __future__ import annotations

import hashlib
import tomllib
from importlib import resources
from pathlib import Path
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from raycheck.errors import UsageError
from raycheck.manifest import Manifest
from raycheck.sandbox.limits import Limits
from scenes.catalogue import ladder
from scenes.disk import read_bounded

MAX_BYTES = 2**20
Points = Annotated[float, Field(ge=0, le=100_000, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=200)]


class Frozen(BaseModel):
    """Base: no unknown keys, no mutation."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Group(Frozen):
    """Rungs of one idea, and the points of them all."""

    name: Name
    points: Points
    rungs: Annotated[tuple[str, ...], Field(min_length=1)]


class Hidden(Frozen):
    """Scenes drawn from the run's seed. reveal: do students see their expected values."""

    points: Points
    scenes: Annotated[int, Field(ge=1, le=100)] = 6
    reveal: bool = False


class Rubric(Frozen):
    """Groups of rungs, hidden scenes, limits; `tracer` stands in for a submission's missing raycheck.toml."""

    name: Name
    group: Annotated[tuple[Group, ...], Field(min_length=1)]
    hidden: Hidden | None = None
    limits: Limits = Limits()
    tracer: Manifest | None = None

    @model_validator(mode="after")
    def _each_rung_once(self) -> Self:
        known = {rung.name for rung in ladder()}
        seen: set[str] = set()
        for group in self.group:
            for rung in group.rungs:
                if rung not in known:
                    raise ValueError(f"group {group.name!r}: no rung is called {rung!r}; see `raycheck scenes`")
                if rung in seen:
                    raise ValueError(f"group {group.name!r}: {rung!r} is counted twice")
                seen.add(rung)
        return self

    @property
    def rungs(self) -> frozenset[str]:
        """All rungs that count."""
        return frozenset(rung for group in self.group for rung in group.rungs)

    def digest(self) -> str:
        """Equal rubrics, equal digest."""
        return hashlib.sha256(self.model_dump_json().encode()).hexdigest()


def load(path: Path | None) -> Rubric:
    """Read a rubric, or the one that ships; raise UsageError naming file, key and value."""
    shown = str(path) if path else "the default rubric"
    try:
        data = read_bounded(path, MAX_BYTES) if path else default().encode()
    except OSError as error:
        raise UsageError(f"{shown}: {error.strerror}", "a TOML file, see docs/grading.md") from None
    try:
        return Rubric.model_validate(tomllib.loads(data.decode("utf-8")))
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"]) or "rubric"
        raise UsageError(f"{shown}: {key} = {first['input']!r:.60}: {first['msg']}", "see docs/grading.md") from None
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{shown}: not TOML: {error}") from None


def default() -> str:
    """The text of the rubric that ships."""
    return resources.files("raycheck.grading").joinpath("rubric.toml").read_text("utf-8")
