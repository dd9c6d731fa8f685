"""rubric.toml: what a class is asked, and what it is worth."""

from __future__ import annotations

import hashlib
import tomllib
from importlib import resources
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from oracles.stability.frontiers import span
from raycheck.errors import UsageError
from raycheck.laws import chosen
from raycheck.laws.plan import AnyLaw
from raycheck.manifest import Manifest
from raycheck.sandbox.limits import Limits
from scenes.catalogue import ladder
from scenes.disk import read_bounded

MAX_BYTES = 2**20
Points = Annotated[float, Field(ge=0, le=100_000, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=200)]
Amount = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Times = Annotated[float, Field(gt=0, le=1e6, allow_inf_nan=False)]


class Frozen(BaseModel):
    """Base: no unknown keys, no mutation."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class Reach(Frozen):
    """How far a formula must hold, by the tracer's precision; question and unit as `raycheck stability` has them."""

    question: Literal["distance", "decision", "height", "bending"]
    float32: Amount
    float64: Amount

    @model_validator(mode="after")
    def _measurable(self) -> Self:
        for precision in ("float32", "float64"):
            low, high = sorted(span(self.question, precision))
            asked = getattr(self, precision)
            if not low <= asked <= high:
                raise ValueError(f"{self.question} {precision} = {asked:g} is not measured: {low:.3g} to {high:.3g}")
        return self

    @property
    def check(self) -> str:
        """The name of its verdict."""
        return f"stability/{self.question}/{self.float32:g}"


def speed_check(times: float) -> str:
    """The name of the verdict on being so many times as fast as the reference tracer."""
    return f"speed/{times:g}"


class Group(Frozen):
    """Checks of one idea, and the points that they share.

    laws: by name or by the word before the /; speed: multiples of the reference tracer's; unsupported: what a
    check costs that the tracer does not offer, for example a law without a probe.
    """

    name: Name
    points: Points
    rungs: tuple[str, ...] = ()
    laws: tuple[str, ...] = ()
    stability: tuple[Reach, ...] = ()
    speed: tuple[Times, ...] = ()
    unsupported: Literal["lost", "left out"] = "lost"

    @property
    def checks(self) -> tuple[str, ...]:
        """Its checks as verdicts name them."""
        return (
            *(f"image/{name}" for name in self.rungs),
            *(f"law/{law.name}" for law in self.chosen_laws()),
            *(reach.check for reach in self.stability),
            *(speed_check(times) for times in self.speed),
        )

    def chosen_laws(self) -> list[AnyLaw]:
        """The laws that it names; raise UsageError where there is no such law."""
        return chosen(self.laws)


class Hidden(Frozen):
    """Scenes drawn from the run's seed. reveal: do students see their expected values."""

    points: Points
    scenes: Annotated[int, Field(ge=1, le=100)] = 6
    reveal: bool = False


class Mistakes(Frozen):
    """What a known fault costs, once, where known faults explain every wrong picture."""

    points: Points


class Rubric(Frozen):
    """Groups of rungs, hidden scenes, limits; `tracer` stands in for a submission's missing raycheck.toml.

    mistakes: None: nothing is diagnosed.
    """

    name: Name
    group: Annotated[tuple[Group, ...], Field(min_length=1)]
    hidden: Hidden | None = None
    mistakes: Mistakes | None = None
    limits: Limits = Limits()
    tracer: Manifest | None = None

    @model_validator(mode="after")
    def _each_check_once(self) -> Self:
        known = {rung.name for rung in ladder()}
        seen: set[str] = set()
        for group in self.group:
            for rung in group.rungs:
                if rung not in known:
                    raise ValueError(f"group {group.name!r}: no rung is called {rung!r}; see `raycheck scenes`")
            try:
                checks = group.checks
            except UsageError as error:
                raise ValueError(f"group {group.name!r}: {error}") from None
            if not checks:
                raise ValueError(f"group {group.name!r}: no rungs, laws, stability or speed")
            for check in checks:
                if check in seen:
                    raise ValueError(f"group {group.name!r}: {check!r} is counted twice")
                seen.add(check)
        return self

    @property
    def rungs(self) -> frozenset[str]:
        """All rungs that count."""
        return frozenset(rung for group in self.group for rung in group.rungs)

    @property
    def laws(self) -> list[AnyLaw]:
        """All laws that count."""
        return [law for group in self.group for law in group.chosen_laws()]

    @property
    def reaches(self) -> list[Reach]:
        """How far formulas must hold."""
        return [reach for group in self.group for reach in group.stability]

    @property
    def speeds(self) -> list[float]:
        """How many times as fast as the reference tracer; empty: nothing is timed."""
        return [times for group in self.group for times in group.speed]

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
