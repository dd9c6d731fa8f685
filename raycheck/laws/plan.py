"""Which laws are put to a subject, and the form of their verdicts."""

from __future__ import annotations

import difflib
import shlex
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from oracles.laws import Law, formula_laws
from oracles.laws.pictures import PictureLaw, picture_laws
from oracles.verdict import Verdict
from raycheck.errors import UsageError
from raycheck.known import Known
from raycheck.probes import prober_of
from raycheck.subjects import Subject
from raycheck.subjects.images import ImagesSubject
from reference_tracer.dialects import CHOICES, Dialect

AnyLaw = Law | PictureLaw
HELLO = "probe/hello"
"""The check that the formula laws build on."""
GROUND = "image/background"
"""The check that the picture laws build on: the tracer writes a picture that can be read."""


@dataclass(frozen=True)
class LawPlan:
    """Which laws to ask, how many cases beyond the fixed ones, and how to ask again.

    named: the user chose them, so those that the subject cannot answer are told too; repeat: the command line that asks
    one law again, {law} stands for its name.
    """

    laws: Sequence[AnyLaw] = ()
    named: bool = False
    seed: int = 0
    explore: int = 0
    block: bool = True
    known: Known = field(default_factory=lambda: Known({}))
    repeat: str = ""

    def asked(self, subject: Subject) -> list[AnyLaw]:
        """The laws that are put to this subject."""
        if self.named:
            return list(self.laws)
        return [law for law in self.laws if answerable(subject, law)]

    def planned(self, subject: Subject) -> int:
        """Number of checks; the greeting counts as one."""
        asked = self.asked(subject)
        greets = prober_of(subject) is not None and any(isinstance(law, Law) for law in asked)
        return len(asked) + greets


def all_laws() -> tuple[AnyLaw, ...]:
    """Those of formulas, then those of pictures."""
    return (*formula_laws(), *picture_laws())


def check_names() -> set[str]:
    """The checks that this module makes, as they are named in reports."""
    return {HELLO, *(f"law/{law.name}" for law in all_laws())}


def chosen(names: Sequence[str]) -> list[AnyLaw]:
    """The laws of these names, or of the groups before the first /; raise UsageError with the nearest names."""
    found: list[AnyLaw] = []
    for name in names:
        plain = name.removeprefix("law/")
        fitting = [law for law in all_laws() if plain in (law.name, law.name.split("/")[0])]
        if not fitting:
            known = [law.name for law in all_laws()]
            close = ", ".join(difflib.get_close_matches(plain, known, 3) or known[:3])
            raise UsageError(f"--laws {name}: no such law", f"for example {close}; docs/laws.md lists them")
        found += [law for law in fitting if law not in found]
    return found


def answerable(subject: Subject, law: AnyLaw) -> bool:
    """Whether this kind of subject can be asked at all: pictures of any scene, or formulas."""
    if isinstance(law, PictureLaw):
        return not isinstance(subject, ImagesSubject) and subject.spp is None
    return prober_of(subject) is not None


_CONVENTIONS: dict[str, tuple[str, ...]] = {
    "phong": ("specular", "specular_needs_light_in_front", "lambert"),
    "camera": ("sample",),
    "trace": tuple(CHOICES),
}
"""By operation, the conventions that its laws take to be the scene model's."""


def spoken_otherwise(law: Law, dialect: Dialect) -> str:
    """The dialect's conventions under which this law says nothing, as the lines of a manifest; empty: none."""
    touched = {key for operation in law.asks for key in _CONVENTIONS.get(operation, ())}
    lines = [line for line in dialect.lines() if line.split(" ")[0] in touched]
    return ", ".join(lines)


def verdict_on(law: AnyLaw, plan: LawPlan, word: str, message: str, **more: Any) -> Verdict:
    """A verdict with what the law says of itself."""
    return Verdict.model_validate(
        {
            "check": f"law/{law.name}",
            "verdict": word,
            "message": message,
            "slide": law.slide,
            "teaches": law.statement,
            "formula": law.formula,
            "reproduce": plan.repeat.format(law=shlex.quote(law.name)),
        }
        | more
    )
