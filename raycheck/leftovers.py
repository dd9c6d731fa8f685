"""Folders that are to go away with their process, however it ends.

Each is locked, and the kernel lifts the locks of a process that is gone. So a folder of the right name that nobody has
locked is what a killed process left behind.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Callable, Iterator
from pathlib import Path


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[bool]:
    """Hold the folder's lock; False if it was swept away before it could be locked."""
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except FileNotFoundError:
        yield False
        return
    try:
        with contextlib.suppress(OSError):  # a file system without locks: nobody can sweep there either
            fcntl.flock(descriptor, fcntl.LOCK_SH)
        yield os.fstat(descriptor).st_nlink > 0 and folder.is_dir()
    finally:
        os.close(descriptor)


def sweep(place: Path, prefix: str, remove: Callable[[Path], object]) -> None:
    """Remove this user's folders of the prefix in a place that no living process holds; links are not followed."""
    with contextlib.suppress(OSError):
        for name in os.listdir(place):
            if name.startswith(prefix):
                _swept(place / name, remove)


def _swept(folder: Path, remove: Callable[[Path], object]) -> None:
    try:
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    except OSError:
        return  # gone, a link, a file, or another user's
    try:
        if os.fstat(descriptor).st_uid == os.geteuid():
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
            remove(folder)
    except OSError:
        return  # in use, or no locks here
    finally:
        os.close(descriptor)
