"""A process that answers many requests: started when first asked, watched, and started again after it died."""

from __future__ import annotations

import contextlib
import os
import selectors
import subprocess
import sys
import tempfile
import time
import weakref
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, cast

import oracles
from raycheck import process
from raycheck.errors import StartError

FILE_LIMIT = 2**30
"""Bytes of any file that the process writes: pictures, and what it prints."""
REPLY_LIMIT = 2**16
GRACE = 5.0
"""Seconds for a process that closed its output to be gone: a large one on a busy machine, with a core to write."""


@dataclass(frozen=True)
class Reply:
    """What came of one request: the answer's line, or how the process ended instead of answering."""

    line: str
    ended: process.Ended | None
    seconds: float


@dataclass
class Child:
    """One Python module run as a process of its own, one request a line."""

    module: str
    arguments: Sequence[str]
    environment: Mapping[str, str] = field(default_factory=dict)
    _running: subprocess.Popen[bytes] | None = None
    _printed: IO[bytes] | None = None
    _end: Callable[[], object] | None = None
    """Ends the process once, here or when raycheck itself ends: afterwards its number may be another's."""

    @property
    def command(self) -> tuple[str, ...]:
        """As it can be typed."""
        return ("python", "-P", "-m", self.module, *self.arguments)

    def ask(self, request: str, timeout: float) -> Reply:
        """Send one line, wait for one line; a process that dies or is silent too long is gone afterwards."""
        begin = time.monotonic()
        running = self._running or self._start()
        try:
            line = self._exchange(running, request, begin + timeout)
        except BaseException:  # an interrupt leaves an answer on its way to nobody
            self.stop()
            raise
        seconds = time.monotonic() - begin
        if line is not None and line.endswith("\n"):
            return Reply(line.rstrip("\n"), None, seconds)
        ended = self._ended(running, line is None, seconds)
        self.stop()
        return Reply("", ended, seconds)

    def _start(self) -> subprocess.Popen[bytes]:
        root = str(Path(oracles.__file__).resolve().parents[1])
        words = [sys.executable, "-P", "-m", self.module, *self.arguments]
        printed = tempfile.TemporaryFile()  # noqa: SIM115 (it lives as long as the process)
        try:
            with process.interrupts_held():
                running = subprocess.Popen(
                    words,
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=printed,
                    start_new_session=True,
                    env={**process.own_environment(), "PYTHONPATH": root, **self.environment},
                )
                self._running, self._printed = running, printed
        except OSError as error:
            raise StartError(f"{self.module} cannot be started: {error.strerror}") from None
        self._end = weakref.finalize(self, _finish, running, printed)
        process.GROUP.started(running.pid, FILE_LIMIT)
        return running

    def _exchange(self, running: subprocess.Popen[bytes], request: str, deadline: float) -> str | None:
        """The answer's line; a line without its end if the process ended; None if time ran out."""
        stdin, stdout = cast(IO[bytes], running.stdin), cast(IO[bytes], running.stdout)
        try:
            stdin.write(request.encode() + b"\n")
            stdin.flush()
        except BrokenPipeError:
            return ""
        descriptor, got = stdout.fileno(), b""
        with selectors.DefaultSelector() as selector:
            selector.register(descriptor, selectors.EVENT_READ)
            while not got.endswith(b"\n") and len(got) < REPLY_LIMIT:
                if not selector.select(timeout=max(0.0, deadline - time.monotonic())):
                    return None
                chunk = os.read(descriptor, REPLY_LIMIT)
                if not chunk:
                    break
                got += chunk
        return process.clean(got) + ("\n" if got.endswith(b"\n") else "")

    def _ended(self, running: subprocess.Popen[bytes], late: bool, seconds: float) -> process.Ended:
        if not late:
            try:
                running.wait(timeout=GRACE)
            except subprocess.TimeoutExpired:
                late = True
        code = running.returncode
        how = "timeout" if late else "signal" if code < 0 else "exited"
        return process.Ended(how, abs(code or 0), seconds, self._tail())

    def _tail(self) -> str:
        if self._printed is None:
            return ""
        size = self._printed.seek(0, os.SEEK_END)
        self._printed.seek(max(0, size - 4 * process.TAIL))
        return process.clean(self._printed.read())

    def stop(self) -> None:
        """End the process, if it runs."""
        if self._end is not None:
            self._end()
        self._running = self._printed = self._end = None


def _finish(running: subprocess.Popen[bytes], printed: IO[bytes]) -> None:
    """End the process and close what is open to it."""
    process.end(running)
    if running.stdin is not None:
        with contextlib.suppress(BrokenPipeError):
            running.stdin.close()
    printed.close()
