"""Laws of whole pictures: what moving, splitting or renaming parts of a scene must do to its image."""

from __future__ import annotations

from oracles.laws.pictures import light, matter, moves
from oracles.laws.pictures.law import PictureLaw, Studio, entered
from oracles.laws.pictures.sight import Sight, sight

FILES = (moves, light, matter)
"""Importing a file enters its laws."""


def picture_laws() -> tuple[PictureLaw, ...]:
    """All laws of pictures."""
    return entered()


__all__ = ["FILES", "PictureLaw", "Sight", "Studio", "picture_laws", "sight"]
