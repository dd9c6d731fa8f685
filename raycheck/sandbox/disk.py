"""How much is in a folder, without following anything that a stranger put there."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

ENTRY = 4096
"""Bytes that an entry is taken to cost beside its blocks."""
BLOCK = 512
"""Unit of st_blocks (POSIX leaves it open, Linux counts 512)."""


def used(folders: Iterable[Path], enough: int) -> int:
    """Bytes on disk below these folders; counting ends once there are more than enough."""
    total = 0
    left = [str(folder) for folder in folders]
    while left and total <= enough:
        try:
            with os.scandir(left.pop()) as entries:
                for entry in entries:
                    total += ENTRY + entry.stat(follow_symlinks=False).st_blocks * BLOCK
                    if total > enough:
                        return total
                    if entry.is_dir(follow_symlinks=False):
                        left.append(entry.path)
        except OSError:
            continue  # gone while we looked, or deeper than a path may be
    return total
