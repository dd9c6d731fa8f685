"""Running a stranger's program: bounded in time, output and files, and gone afterwards.

A hold says what a program is started in and how it is ended. A group of processes (`Group`) is the
weakest: a program that leaves its group survives. `raycheck.sandbox` has one that nothing leaves.
Time and output are watched from outside; whatever happens, the hold is ended before `run` returns.
"""

from __future__ import annotations

import contextlib
import os
import re
import resource
import selectors
import signal
import subprocess
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

OUTPUT_LIMIT = 16 * 2**20
"""Bytes a tracer may print in all before it is stopped."""
TAIL = 4000
"""Characters of output kept for the report."""
GRACE = 0.5
"""Seconds to read on after the program has ended, in case a child of it still holds the pipe."""
LOOK = 0.05
"""Seconds between two looks at a running program."""


@dataclass(frozen=True)
class Ended:
    """How a run ended.

    how: exited | signal | timeout | flood, or what the hold found: memory | processes | disk; code: exit
    status or signal number; tail: the end of stdout and stderr together, as text without control characters.
    """

    how: str
    code: int
    seconds: float
    tail: str

    @property
    def status(self) -> str:
        """In words, signals by name."""
        match self.how:
            case "signal":
                return f"killed by {signal_name(self.code)}"
            case "timeout":
                return "stopped: out of time"
            case "flood":
                return "stopped: too much output"
            case "memory" | "processes" | "disk":
                return f"stopped: beyond its limit of {self.how}"
            case _:
                return f"exit status {self.code}"


def signal_name(number: int) -> str:
    """SIGSEGV for 11."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


class Hold(Protocol):
    """What a program runs in."""

    def words(self, command: Sequence[str], cwd: Path, file_limit: int) -> list[str]:
        """What to execute instead of the command."""

    def started(self, pid: int, file_limit: int) -> None:
        """Limit what runs now."""

    def breach(self, pid: int) -> str:
        """The limit that the run of this process has passed, as a word of `Ended.how`; empty while it has not."""

    def outcome(self, code: int, tail: bytes) -> tuple[str, int]:
        """(how, code) by the return code of what was executed; raise OSError if the command could not start."""

    def end(self, child: subprocess.Popen[bytes]) -> None:
        """Kill whatever is left."""


class Group:
    """A group of processes of its own, killed as one."""

    def words(self, command: Sequence[str], cwd: Path, file_limit: int) -> list[str]:
        return list(command)

    def started(self, pid: int, file_limit: int) -> None:
        """No core dumps, no larger file than an image of the format can be."""
        with contextlib.suppress(OSError, AttributeError):  # it may have ended already; not all systems have prlimit
            resource.prlimit(pid, resource.RLIMIT_CORE, (0, 0))
            resource.prlimit(pid, resource.RLIMIT_FSIZE, (file_limit, file_limit))

    def breach(self, pid: int) -> str:
        return ""

    def outcome(self, code: int, tail: bytes) -> tuple[str, int]:
        return ("signal", -code) if code < 0 else ("exited", code)

    def end(self, child: subprocess.Popen[bytes]) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child.pid, signal.SIGKILL)


GROUP = Group()


def run(
    command: Sequence[str],
    cwd: Path,
    timeout: float,
    file_limit: int,
    environment: Mapping[str, str] | None = None,
    hold: Hold = GROUP,
) -> Ended:
    """Run a command (never through a shell) to its end or its bounds; raise OSError if it cannot start."""
    begin = time.monotonic()
    child: subprocess.Popen[bytes] | None = None
    try:
        with interrupts_held():
            child = subprocess.Popen(
                hold.words(command, cwd, file_limit),
                cwd=cwd,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                env=dict(environment or own_environment()),
            )
        hold.started(child.pid, file_limit)
        how, tail = _watch(child, begin + timeout, hold)
    finally:
        if child is not None:
            end(child, hold)
    seconds = time.monotonic() - begin
    # A limit that it met at the very end may be what it died of
    how = hold.breach(child.pid) or how if how == "ended" and child.returncode else how
    code = abs(child.returncode)
    if how == "ended":
        how, code = hold.outcome(child.returncode, tail)
    return Ended(how, code, seconds, clean(tail))


@contextlib.contextmanager
def interrupts_held() -> Iterator[None]:
    """Let SIGINT and SIGTERM wait: one that struck while a child starts would leave it running, known to nobody."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []
    usual = {
        number: signal.signal(number, lambda n, _: waiting.append(n)) for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        yield
    finally:
        for number, handler in usual.items():
            signal.signal(number, handler)
    if waiting:
        signal.raise_signal(waiting[0])


def own_environment() -> dict[str, str]:
    """What a tracer needs of ours: where programs and libraries are, and the language."""
    keep = ("PATH", "HOME", "LANG", "LC_ALL", "TMPDIR", "LD_LIBRARY_PATH", "JAVA_HOME", "GOPATH", "CARGO_HOME")
    return {name: os.environ[name] for name in keep if name in os.environ}


def _watch(child: subprocess.Popen[bytes], deadline: float, hold: Hold) -> tuple[str, bytes]:
    """Read until the end of the output, the deadline or a limit; how it went, and the tail."""
    assert child.stdout is not None
    descriptor = child.stdout.fileno()
    os.set_blocking(descriptor, False)
    seen, tail = 0, b""
    ended: float | None = None
    look = 0.0
    with selectors.DefaultSelector() as selector:
        selector.register(descriptor, selectors.EVENT_READ)
        while True:
            now = time.monotonic()
            if child.poll() is not None and ended is None:
                ended = now
            if ended is not None and now > ended + GRACE:
                return "ended", tail
            if now > deadline and ended is None:
                return "timeout", tail
            if now >= look:
                look = now + LOOK
                if breach := hold.breach(child.pid):
                    return breach, tail
            if not selector.select(timeout=min(LOOK, max(0.0, deadline - now))):
                if ended is not None:
                    return "ended", tail
                continue
            chunk = os.read(descriptor, 65536)
            if not chunk:
                return _wait(child, deadline, hold), tail
            seen += len(chunk)
            tail = (tail + chunk)[-4 * TAIL :]
            if seen > OUTPUT_LIMIT:
                return "flood", tail


def _wait(child: subprocess.Popen[bytes], deadline: float, hold: Hold) -> str:
    """The output is closed: wait for the program itself."""
    while True:
        try:
            child.wait(timeout=max(0.0, min(LOOK, deadline - time.monotonic())))
        except subprocess.TimeoutExpired:
            if time.monotonic() > deadline:
                return "timeout"
            if breach := hold.breach(child.pid):
                return breach
        else:
            return "ended"


def end(child: subprocess.Popen[bytes], hold: Hold = GROUP) -> None:
    """End all that is held, and collect the child."""
    hold.end(child)
    child.wait()
    if child.stdout is not None:
        child.stdout.close()


_ESCAPES = re.compile(r"\x1b(\[[0-?]*[ -/]*[@-~]|\][^\x07\x1b]*(\x07|\x1b\\)?|.)?", re.DOTALL)


def clean(output: bytes) -> str:
    """Output as harmless text: no escapes, no control characters but newline and tab, the last TAIL characters."""
    text = _ESCAPES.sub("", output.decode("utf-8", "replace"))
    text = "".join(c for c in text if c in "\n\t" or c.isprintable())
    return text[-TAIL:].strip()


def start(command: Sequence[str], cwd: Path, file_limit: int, hold: Hold = GROUP) -> subprocess.Popen[bytes]:
    """Start a program that is talked to, its three streams as pipes; raise OSError if it cannot start."""
    with interrupts_held():
        child = subprocess.Popen(
            hold.words(command, cwd, file_limit),
            cwd=cwd,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            env=own_environment(),
        )
    hold.started(child.pid, file_limit)
    return child


def stop(child: subprocess.Popen[bytes], hold: Hold = GROUP) -> None:
    """End a started program with all that is held, and close its streams."""
    end(child, hold)
    for stream in (child.stdin, child.stderr):
        if stream is not None:
            with contextlib.suppress(OSError):  # what was not yet sent has nowhere to go
                stream.close()
