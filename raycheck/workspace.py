"""A folder for one exchange with a stranger's program, gone afterwards whatever the program made of it."""

from __future__ import annotations

import contextlib
import os
import subprocess
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from raycheck import leftovers

PREFIX = "raycheck-work-"


@contextlib.contextmanager
def workspace() -> Iterator[Path]:
    """A new, empty folder; those that killed processes left behind go first."""
    _sweep(tempfile.gettempdir())
    while True:
        folder = tempfile.TemporaryDirectory(prefix=PREFIX, ignore_cleanup_errors=True)
        with leftovers.claimed(Path(folder.name)) as held:
            if not held:
                continue
            try:
                yield Path(folder.name)
            finally:
                with contextlib.suppress(RecursionError):  # a program can nest folders deeper than Python's stack
                    folder.cleanup()
                _remove(Path(folder.name))
            return


def _remove(folder: Path) -> None:
    """What is left of a folder, or what a program put in its place: a link, a file."""
    if os.path.lexists(folder):
        subprocess.run(["rm", "-rf", "--", folder], check=False, stderr=subprocess.DEVNULL)


@cache
def _sweep(place: str) -> None:
    """Once a process and place."""
    leftovers.sweep(Path(place), PREFIX, _remove)
