"""Control groups: the kernel's own limits on memory and tasks, where this process may make one.

Version 1 has a tree for each controller, version 2 one for all (Linux, admin-guide/cgroup-v1/memory.rst
and pids.rst, admin-guide/cgroup-v2.rst).
"""

from __future__ import annotations

import contextlib
import os
import secrets
import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from raycheck import leftovers
from raycheck.sandbox.limits import MIB, Limits

ROOT = Path("/sys/fs/cgroup")
PREFIX = "raycheck-"


@dataclass(frozen=True)
class Cgroup:
    """A group for one run. folders: where it is, one or two; doors: files through which a process enters."""

    folders: tuple[Path, ...]

    @property
    def doors(self) -> tuple[Path, ...]:
        return tuple(folder / "cgroup.procs" for folder in self.folders)

    def breach(self) -> str:
        """What the kernel has refused to this group."""
        for folder in self.folders:
            if _counted(folder / "memory.oom_control", "oom_kill") or _counted(folder / "memory.events", "oom_kill"):
                return "memory"
            if _counted(folder / "pids.events", "max"):
                return "processes"
        return ""


@contextlib.contextmanager
def cgroup(limits: Limits, root: Path = ROOT) -> Iterator[Cgroup | None]:
    """A group of these limits, removed afterwards; None where none can be made."""
    _sweep(root)
    while True:
        made: list[Path] = []
        with contextlib.ExitStack() as held:
            try:
                group = _made(limits, root, made)
                if all(held.enter_context(leftovers.claimed(folder)) for folder in made):
                    yield group
                    return
            finally:
                for folder in made:
                    _remove(folder)


def _made(limits: Limits, root: Path, made: list[Path]) -> Cgroup | None:
    name = f"{PREFIX}{os.getpid()}-{secrets.token_hex(4)}"
    memory, tasks = str(limits.memory * MIB), str(limits.processes)
    try:
        if (root / "cgroup.controllers").exists():
            _make(root / name, made, {"memory.max": memory, "memory.oom.group": "1", "pids.max": tasks})
            _optionally(root / name / "memory.swap.max", "0")
        else:
            _make(root / "memory" / name, made, {"memory.limit_in_bytes": memory})
            _optionally(root / "memory" / name / "memory.memsw.limit_in_bytes", memory)
            _make(root / "pids" / name, made, {"pids.max": tasks})
    except OSError:
        return None  # no right to, or no such controller: the watchdog serves
    return Cgroup(tuple(made))


def _make(folder: Path, made: list[Path], settings: dict[str, str]) -> None:
    if not folder.parent.is_dir():
        raise FileNotFoundError(folder.parent)
    folder.mkdir()
    made.append(folder)
    for name, value in settings.items():
        _set(folder / name, value)


def _set(path: Path, value: str) -> None:
    """Write to a file that the kernel must have put there."""
    descriptor = os.open(path, os.O_WRONLY)
    try:
        os.write(descriptor, value.encode())
    finally:
        os.close(descriptor)


def _optionally(path: Path, value: str) -> None:
    """Kernels without swap accounting lack the file."""
    with contextlib.suppress(OSError):
        _set(path, value)


def _counted(path: Path, name: str) -> bool:
    """Does the file count at least one event of this name."""
    try:
        lines = path.read_text("utf-8").splitlines()
    except OSError:
        return False
    return any(line.split()[0] == name and line.split()[1] != "0" for line in lines if line.count(" ") == 1)


@cache
def _sweep(root: Path) -> None:
    """Once a process: the groups that killed ones left behind."""
    for place in (root, root / "memory", root / "pids"):
        leftovers.sweep(place, PREFIX, _discard)


def _discard(folder: Path) -> None:
    """A group that still has processes stays."""
    with contextlib.suppress(OSError):
        folder.rmdir()


def _remove(folder: Path) -> None:
    """The kernel may need a moment to let go of the last process."""
    for _ in range(100):
        try:
            folder.rmdir()
        except OSError:
            time.sleep(0.01)
        else:
            return
