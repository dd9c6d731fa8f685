"""Scenes of files, judged as the catalogue's are."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from raycheck.formulas import FORMULAS
from scenes.files import load
from scenes.generator import Drawn


@dataclass(frozen=True)
class Filed(Drawn):
    """A rung whose scene comes from a file, and which builds on nothing."""

    file: str = field(kw_only=True)

    @property
    def asked(self) -> str:
        """The file."""
        return self.file


def is_file(name: str) -> bool:
    """Whether a word for a scene means a file: it ends as one does, or has a folder."""
    return name.endswith((".json", ".txt")) or "/" in name


def filed(name: str) -> Filed:
    """The rung of a scene file; raise SceneError naming file, place and value."""
    scene = load(Path(name))
    slide = scene.source.removeprefix("L11: ")
    return Filed(scene.name, slide if slide in FORMULAS else "", "", (), drawn=scene, file=name)
