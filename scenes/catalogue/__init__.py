"""The catalogue: a ladder of scenes of one idea each, in the lecture's order."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from scenes.errors import SceneError
from scenes.json_form import from_json
from scenes.model import Scene


@dataclass(frozen=True)
class Needs:
    """The least model that draws a scene's picture: features in the manifest's words, generations after the eye ray.

    beyond: why the scene asks for more, empty where it does not.
    """

    features: frozenset[str]
    depth: int
    beyond: str = ""


@dataclass(frozen=True)
class Rung:
    """One scene of the ladder.

    slide: of L11, which the scene tests; teaches: its one idea; requires: rungs
    whose failure makes this one meaningless; needs: None where nobody has shown it.
    """

    name: str
    slide: str
    teaches: str
    requires: tuple[str, ...]
    needs: Needs | None = None

    def scene(self) -> Scene:
        """The scene itself, read and validated."""
        text = resources.files("scenes.catalogue").joinpath(f"{self.name}.json").read_text("utf-8")
        return from_json(text, f"catalogue/{self.name}.json")

    @property
    def asked(self) -> str:
        """What the command line calls it."""
        return self.name


def _needs(table: dict[str, Any]) -> Needs:
    return Needs(frozenset(table["features"]), table["depth"], table.get("beyond", ""))


@cache
def ladder() -> tuple[Rung, ...]:
    """All rungs, each after those that it requires."""
    text = resources.files("scenes.catalogue").joinpath("ladder.toml").read_text("utf-8")
    return tuple(
        Rung(entry["name"], entry["slide"], entry["teaches"], tuple(entry["requires"]), _needs(entry["needs"]))
        for entry in tomllib.loads(text)["rung"]
    )


def rung(name: str) -> Rung:
    """The rung of that name; raise SceneError with the nearest names."""
    for entry in ladder():
        if entry.name == name:
            return entry
    import difflib

    names = [entry.name for entry in ladder()]
    close = difflib.get_close_matches(name, names, n=3) or names[:3]
    raise SceneError("no such scene in the catalogue", "catalogue", repr(name), f"for example {', '.join(close)}")


@cache
def catalogue_hash() -> str:
    """One hash over all rungs and their scenes: equal catalogues, equal hash."""
    import hashlib

    digest = hashlib.sha256()
    for entry in ladder():
        digest.update(f"{entry.name} {entry.requires} {entry.scene().content_hash()}\n".encode())
    return digest.hexdigest()[:16]
