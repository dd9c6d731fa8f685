"""A folder for one exchange with a stranger's program, gone afterwards whatever the program made of it."""

from __future__ import annotations

import contextlib
import os
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def workspace() -> Iterator[Path]:
    """A new, empty folder."""
    folder = tempfile.TemporaryDirectory(prefix="raycheck-", ignore_cleanup_errors=True)
    try:
        yield Path(folder.name)
    finally:
        with contextlib.suppress(RecursionError):  # a program can nest folders deeper than Python's stack
            folder.cleanup()
        if os.path.lexists(folder.name):  # or put a link or a file in the folder's place
            subprocess.run(["rm", "-rf", "--", folder.name], check=False, stderr=subprocess.DEVNULL)
