"""The processes below one, counted and weighed from /proc: the watchdog where no control group can be made."""

from __future__ import annotations

import os
import re
from pathlib import Path

_PAGE = os.sysconf("SC_PAGE_SIZE")
_PSS = re.compile(rb"^Pss:\s+(\d+) kB", re.MULTILINE)


def descendants(root: int) -> list[int]:
    """All processes below root. Inside a PID namespace an orphan falls to its first process, so none is missed."""
    children: dict[int, list[int]] = {}
    for name in os.listdir("/proc"):
        if name.isdigit() and (parent := parent_of(int(name))) is not None:
            children.setdefault(parent, []).append(int(name))
    found, left = [], [root]
    while left:
        below = children.get(left.pop(), [])
        found += below
        left += below
    return found


def parent_of(pid: int) -> int | None:
    """The process that started this one; None if it has ended."""
    try:
        return int(Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()[1])
    except (OSError, IndexError):
        return None


def tasks(pids: list[int]) -> int:
    """Number of threads of these processes."""
    return sum(_entries(Path(f"/proc/{pid}/task")) for pid in pids)


def _entries(folder: Path) -> int:
    try:
        return len(os.listdir(folder))
    except OSError:
        return 0


def memory(pids: list[int], limit: int) -> int:
    """Bytes that these processes keep in memory.

    Resident sizes count a shared page once for each process that has it. That bound is quick and mostly
    enough; where it passes the limit, the shares (Pss) are added up instead.
    """
    bound = sum(_resident(pid) for pid in pids)
    return bound if bound <= limit else sum(_share(pid) for pid in pids)


def _resident(pid: int) -> int:
    try:
        return int(Path(f"/proc/{pid}/statm").read_bytes().split()[1]) * _PAGE
    except (OSError, IndexError):
        return 0


def _share(pid: int) -> int:
    try:
        found = _PSS.search(Path(f"/proc/{pid}/smaps_rollup").read_bytes())
    except PermissionError:
        return _resident(pid)
    except OSError:
        return 0
    return int(found[1]) * 1024 if found else 0
