"""A jail for one run: bubblewrap's namespaces and empty root, limits around them.

Inside are the system's programs and the toolchains (read only), what the run is given, an empty /tmp
of bounded size, and nothing else: no home, no network, no other process. Root and /dev are read only
too: they are memory of the host.

An ordinary user's jail is one bwrap with a user namespace. Root's would map its user to the host's root,
who owns /proc/sys and /dev/null without needing any capability; so root's jail prepares the mounts,
becomes nobody, and enters the user namespace from there.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from raycheck.errors import CANNOT_START, RaycheckError
from raycheck.process import Hold
from raycheck.sandbox import census, go_cache, toolchains
from raycheck.sandbox.cgroup import Cgroup, cgroup
from raycheck.sandbox.disk import used
from raycheck.sandbox.limits import MIB, Limits

NOBODY = 65534
"""The user and group of the jail (Linux: overflowuid), without rights on the host."""
SIGNALLED = 128
"""bwrap ends with this plus the signal that ended the command, as shells do."""
DISK_LOOK = 0.25
"""Seconds between two looks at the disk."""

TOOLS = {"bwrap": "bubblewrap", "prlimit": "util-linux", "setpriv": "util-linux", "sh": "dash"}
"""The programs that a jail is made of, each with the package that has it."""

_LINKED = ("bin", "sbin", "lib", "lib32", "lib64", "libx32")
_SETTINGS = ("ld.so.cache", "ld.so.conf", "ld.so.conf.d", "alternatives", "localtime")
_ENTER = 'for door; do shift; [ "$door" = -- ] && exec "$@"; echo 0 > "$door" || exit 1; done'
"""Enters each control group named before --, then becomes the rest of the words."""
_NOT_STARTED = re.compile(rb"^bwrap: execvp (.+): ([^:]+)\n?\Z", re.MULTILINE)


@dataclass
class SandboxError(RaycheckError):
    """This machine has no sandbox: nothing that a submission could do about it."""

    code: int = CANNOT_START


@dataclass(frozen=True)
class Jail:
    """Limits: what the jails of a run have in common, on whatever machine. Raises SandboxError where none can be."""

    limits: Limits = field(default_factory=Limits)

    def __post_init__(self) -> None:
        _demand()

    @contextlib.contextmanager
    def hold(self, read: Sequence[Path], write: Sequence[Path]) -> Iterator[Hold]:
        """A hold for one run; the folders in `write` become the jail's user's."""
        _demand()  # again: another machine may have sent it
        for folder in write:
            give(folder)
        library = go_cache.wanted(write)
        shown = (*toolchains.folders(), *((library,) if library else ()), *read)
        with cgroup(self.limits) as group:
            yield _Cell(self.limits, shown, tuple(write), group, library)


@dataclass
class _Cell:
    """The hold of one run."""

    limits: Limits
    read: tuple[Path, ...]
    write: tuple[Path, ...]
    group: Cgroup | None
    library: Path | None = None
    _looked: float = 0.0

    def words(self, command: Sequence[str], cwd: Path, file_limit: int) -> list[str]:
        doors = [str(door) for door in self.group.doors] if self.group else []
        entered = ["sh", "-c", _ENTER, "sh", *doors, "--"] if doors else []
        return [*entered, *self._limited(file_limit), *self._walls(), *_become(cwd), *command]

    def started(self, pid: int, file_limit: int) -> None:
        """Its limits came before it."""

    def _limited(self, file_limit: int) -> list[str]:
        """Limits of each process. Not of its address space: that breaks Java and sanitizers, and holds no tree."""
        size = min(file_limit, self.limits.disk * MIB)
        return ["prlimit", f"--cpu={self.limits.cpu}", f"--fsize={size}", "--core=0", "--nofile=1024", "--"]

    def _walls(self) -> list[str]:
        walls = ["bwrap", "--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--unshare-cgroup-try"]
        walls += ["--hostname", "jail", "--die-with-parent", "--new-session", "--cap-drop", "ALL", "--clearenv"]
        for name, value in _environment(self.library).items():
            walls += ["--setenv", name, value]
        walls += _system()
        walls += ["--proc", "/proc", "--dev", "/dev"]
        walls += [*self._memory("/dev/shm"), "--remount-ro", "/dev", *self._memory("/tmp")]  # noqa: S108, inside
        return [*walls, *self._shared(), "--remount-ro", "/", *_identity()]

    def _memory(self, place: str) -> list[str]:
        return ["--perms", "1777", "--size", str(self.limits.temporary * MIB), "--tmpfs", place]

    def _shared(self) -> list[str]:
        """What the run is given, where it is outside; folders on the way are made first, else they are closed."""
        words: list[str] = []
        made: set[Path] = {Path("/"), Path("/tmp"), Path("/usr"), Path("/etc")}  # noqa: S108, inside
        for option, paths in (("--ro-bind", self.read), ("--bind", self.write)):
            for path in paths:
                if path.is_relative_to("/usr"):
                    continue
                for parent in reversed(path.parents):
                    if parent not in made:
                        made.add(parent)
                        words += ["--perms", "0755", "--dir", str(parent)]
                words += [option, str(path), str(path)]
        return words

    def breach(self, pid: int) -> str:
        if self.group:
            return self.group.breach() or self._full()
        inside = census.descendants(pid)
        if census.tasks(inside) > self.limits.processes:
            return "processes"
        limit = self.limits.memory * MIB
        return "memory" if census.memory(inside, limit) > limit else self._full()

    def _full(self) -> str:
        now = time.monotonic()
        if now < self._looked + DISK_LOOK:
            return ""
        self._looked = now
        limit = self.limits.disk * MIB
        return "disk" if used(self.write, limit) > limit else ""

    def outcome(self, code: int, tail: bytes) -> tuple[str, int]:
        if code == 1 and (found := _NOT_STARTED.search(tail)):
            raise FileNotFoundError(errno.ENOENT, found[2].decode("utf-8", "replace"), os.fsdecode(found[1]))
        if code < 0:
            return "signal", -code
        return ("signal", code - SIGNALLED) if SIGNALLED < code < SIGNALLED + 65 else ("exited", code)

    def end(self, child: subprocess.Popen[bytes]) -> None:
        """Kill the namespace's first process: the kernel kills all others, and it goes last."""
        if child.poll() is not None:
            return  # bwrap ends after it
        for pid in [pid for pid in census.descendants(child.pid) if census.parent_of(pid) == child.pid]:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(timeout=5.0)
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child.pid, signal.SIGKILL)


def _demand() -> None:
    reason = missing()
    if reason:
        raise SandboxError(f"no sandbox: {reason}", "apt-get install bubblewrap; user namespaces must be allowed")


def give(folder: Path) -> None:
    """Make a folder the jail's user's, where this process may: root's jail is nobody's."""
    if os.geteuid() != 0:
        return
    os.chown(folder, NOBODY, NOBODY, follow_symlinks=False)
    for here, folders, files in os.walk(folder):
        for name in (*folders, *files):
            os.chown(os.path.join(here, name), NOBODY, NOBODY, follow_symlinks=False)


def _environment(library: Path | None) -> dict[str, str]:
    own = {"PATH": toolchains.search_path(), "HOME": "/tmp", "TMPDIR": "/tmp", "LANG": "C.UTF-8"}  # noqa: S108
    return own | ({"GOCACHE": str(library)} if library else {})


@cache
def _system() -> list[str]:
    """The system's folders: real ones are bound, links (bin to usr/bin) made again."""
    words: list[str] = ["--ro-bind", "/usr", "/usr"]
    for name in _LINKED:
        path = Path("/", name)
        if path.is_symlink():
            words += ["--symlink", os.readlink(path).lstrip("/"), str(path)]
        elif path.is_dir():
            words += ["--ro-bind", str(path), str(path)]
    words += ["--perms", "0755", "--dir", "/etc"]
    settings = [Path("/etc", name) for name in _SETTINGS] + sorted(Path("/etc").glob("java-*"))
    for path in settings:
        words += ["--ro-bind-try", str(path), str(path)]
    return words


def _identity() -> list[str]:
    if os.geteuid() == 0:
        return ["--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"]
    return ["--unshare-user", "--disable-userns", "--uid", str(NOBODY), "--gid", str(NOBODY)]


def _become(cwd: Path) -> list[str]:
    """From bwrap to the command: chdir, and for root the way to nobody and into a user namespace."""
    if os.geteuid() != 0:
        return ["--chdir", str(cwd), "--"]
    nobody = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups", "--no-new-privs", "--"]
    inner = ["bwrap", "--unshare-user", "--disable-userns", "--die-with-parent", "--dev-bind", "/", "/"]
    return ["--", *nobody, *inner, "--chdir", str(cwd), "--"]


@cache
def missing() -> str:
    """Why there is no sandbox on this machine, found out once; empty if there is one."""
    return inspect()


def inspect() -> str:
    """Why there is no sandbox on this machine; empty if there is one."""
    for name in TOOLS:
        if shutil.which(name) is None:
            return f"{name} is not installed"
    cell = _Cell(Limits(), (), (), None)
    try:
        done = subprocess.run(cell.words(["true"], Path("/"), MIB), capture_output=True, timeout=20, check=False)
    except (OSError, subprocess.SubprocessError) as error:
        return str(error)
    return "" if done.returncode == 0 else done.stderr.decode("utf-8", "replace").strip()[-300:]
