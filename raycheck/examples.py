"""Where the example tracers are."""

from __future__ import annotations

from pathlib import Path

from raycheck.errors import StartError


def examples() -> Path:
    """The folder of example tracers: in the package, or beside it in a checkout."""
    here = Path(__file__).resolve().parent
    for folder in (here / "examples", here.parent / "examples"):
        if folder.is_dir():
            return folder
    raise StartError("the example tracers are not installed", "install raycheck from its wheel or a checkout")
