"""What a law of pictures is: scenes that are related, and the sum of their images that must be black."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

from oracles.laws.dice import Dice
from oracles.laws.pictures.sight import Sight
from scenes.model import Scene


class Studio(Protocol):
    """A tracer that renders scenes; its features are what a scene may ask of it."""

    features: frozenset[str]

    def show(self, scene: Scene) -> Sight:
        """What the tracer draws; raise NoAnswerError where it draws nothing."""


class PictureLaw(NamedTuple):
    """One statement about pictures. The physics and the assumptions are the docstring of `test`.

    name: image/STATEMENT; needs: features without which it says nothing; test: from a case and a tracer to a sight
    that must be black.
    """

    name: str
    statement: str
    slide: str
    formula: str
    needs: tuple[str, ...]
    test: Callable[[Dice, Studio], Sight]

    @property
    def reason(self) -> str:
        """The docstring of the law's function."""
        return (self.test.__doc__ or "").strip()


_LAWS: dict[str, PictureLaw] = {}


def law(
    name: str, statement: str, slide: str, formula: str, *needs: str
) -> Callable[[Callable[[Dice, Studio], Sight]], Callable[[Dice, Studio], Sight]]:
    """Enter the function into the book of laws."""

    def enter(test: Callable[[Dice, Studio], Sight]) -> Callable[[Dice, Studio], Sight]:
        _LAWS[name] = PictureLaw(name, statement, slide, formula, needs, test)
        return test

    return enter


def entered() -> tuple[PictureLaw, ...]:
    """All laws entered so far, in order."""
    return tuple(_LAWS.values())
