"""What an entry of the dictionary is: a mistake as a student makes it, and the rulebook that makes it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any, Literal

from numpy.typing import NDArray

from oracles.images import Picture
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

Written = Callable[[NDArray[Any], Scene], Picture]
"""From linear pixels (height, width, 3) of a scene to what stands in the file."""


Fate = Literal["killed", "survives", "equivalent"]


@dataclass(frozen=True)
class Fault:
    """One known mistake.

    source: the slide of L11 by title, or a citation; wrong and right: the line as it is written and as it should be;
    seen: what the picture shows; mend: where to look; rules: the lecture's with the wrong entry; picture: what writing
    the file does wrong, None: nothing. fate: `killed` by a scene of the catalogue at 48x36 or more, `survives` all of
    them for the `reason`, or `equivalent` to the right formula by the proof in `reason`.
    """

    name: str
    group: str
    source: str
    wrong: str
    right: str
    seen: str
    mend: str
    rules: Rulebook = LECTURE
    picture: Written | None = None
    fate: Fate = "killed"
    reason: str = ""

    @property
    def entries(self) -> frozenset[str]:
        """Names of the rulebook's entries that differ from the lecture's."""
        return changed(self.rules)


@dataclass(frozen=True)
class Twin:
    """A correct tracer that differs from the reference: `how`, by which rules, what it writes, which scene it reads."""

    name: str
    how: str
    rules: Rulebook = LECTURE
    precision: int = 32
    picture: Written | None = None
    scene: Callable[[Scene], Scene] = lambda scene: scene

    @property
    def entries(self) -> frozenset[str]:
        """Names of the rulebook's entries that differ from the lecture's."""
        return changed(self.rules)


def changed(rules: Rulebook) -> frozenset[str]:
    """Names of the entries that differ from the lecture's."""
    names = (field.name for field in fields(Rulebook) if field.name != "name")
    return frozenset(name for name in names if getattr(rules, name) is not getattr(LECTURE, name))


def instead(name: str, **entries: Any) -> Rulebook:
    """The lecture's rulebook with these entries in the place of its own."""
    return replace(LECTURE, name=name, **entries)


def maker(group: str, *cited: str) -> Callable[..., Fault]:
    """What makes the entries of a group: by name, source, wrong and right line, what is seen, and where to mend it.

    The source is a slide of L11, unless it is one of those cited in full.
    """

    def entry(
        name: str,
        source: str,
        wrong: str,
        right: str,
        seen: str,
        mend: str,
        fate: Fate = "killed",
        reason: str = "",
        **entries: Any,
    ) -> Fault:
        said = source if source in cited else f'L11 "{source}"'
        return Fault(name, group, said, wrong, right, seen, mend, instead(name, **entries), None, fate, reason)

    return entry
