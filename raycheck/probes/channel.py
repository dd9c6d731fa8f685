"""A process that answers a line for a line: written to and read from at once, bounded in time and size.

A batch is sent as fast as the process reads it while its answers are read as fast as they come, so neither side
waits for the other with full pipes, and a round trip is paid once a batch.
"""

from __future__ import annotations

import contextlib
import os
import selectors
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

from oracles.laws import NoAnswerError
from raycheck import process
from raycheck.probes.wire import LINE_LIMIT, shown

FILES = 2**24
"""Bytes of a file that a probe may write: it has no reason to write any."""
CHUNK = 2**18
GRACE = 5.0
"""Seconds that a process which closed its output has to end, so that its end can be told also on a busy machine."""


class BrokenOffError(NoAnswerError):
    """The exchange ended early; `answered` lines had come."""

    def __init__(self, word: str, message: str, answered: int) -> None:
        super().__init__(word, message)
        self.answered = answered


class Channel:
    """One running process."""

    def __init__(
        self, command: Sequence[str], folder: Path, patience: float, hold: process.Hold = process.GROUP
    ) -> None:
        """Start it; patience: seconds for each answer. Raise OSError if it cannot start."""
        self.patience, self.hold = patience, hold
        self.child = process.start(command, folder, FILES, hold)
        into, out, err = (
            stream.fileno() for stream in (self.child.stdin, self.child.stdout, self.child.stderr) if stream
        )
        self.ends = (into, out, err)
        for end in self.ends:
            os.set_blocking(end, False)
        self.said = b""
        self.unread = b""

    def close(self) -> None:
        """End the process."""
        process.stop(self.child, self.hold)

    def exchange(self, requests: bytes, count: int) -> list[bytes]:
        """The answers to `count` lines of requests; raise BrokenOffError where they do not come."""
        into, out, err = self.ends
        self._nothing_waits()
        left = memoryview(requests)
        answers: list[bytes] = []
        deadline = time.monotonic() + self.patience
        with selectors.DefaultSelector() as selector:
            selector.register(into, selectors.EVENT_WRITE)
            selector.register(out, selectors.EVENT_READ)
            selector.register(err, selectors.EVENT_READ)
            while len(answers) < count:
                ready = {key.fd for key, _ in selector.select(max(0.0, deadline - time.monotonic()))}
                if err in ready and not self._overhear():
                    selector.unregister(err)
                if out in ready:
                    answers += self._read(len(answers))
                    deadline = time.monotonic() + self.patience
                elif time.monotonic() >= deadline:
                    raise self._silent(len(answers))
                if into in ready:
                    left = self._write(left)
                    if not left:
                        selector.unregister(into)
        if len(answers) > count or self.unread:
            raise BrokenOffError("invalid", f"more lines than questions: {shown(self.unread or answers[count])}", count)
        return answers

    def _nothing_waits(self) -> None:
        """Raise if the process has said something unasked since the last exchange."""
        try:
            early = os.read(self.ends[1], CHUNK)
        except BlockingIOError:
            return
        if early:
            raise BrokenOffError("invalid", f"more lines than questions: {shown(early)}", 0)
        raise self._ended(0)

    def _write(self, left: memoryview) -> memoryview:
        """Send what fits; nothing more to a process that no longer reads, whose silence then tells."""
        try:
            return left[os.write(self.ends[0], left[:CHUNK]) :]
        except BlockingIOError:
            return left
        except BrokenPipeError:
            return left[len(left) :]

    def _read(self, answered: int) -> list[bytes]:
        """Whole lines that have come."""
        chunk = os.read(self.ends[1], CHUNK)
        if not chunk:
            raise self._ended(answered)
        *lines, self.unread = (self.unread + chunk).split(b"\n")
        longest = max((*lines, self.unread), key=len)
        if len(longest) > LINE_LIMIT:
            raise BrokenOffError("invalid", f"a line of more than {LINE_LIMIT} bytes: {shown(longest)}", answered)
        return lines

    def _overhear(self) -> bool:
        """Keep the tail of stderr; False at its end."""
        chunk = os.read(self.ends[2], CHUNK)
        self.said = (self.said + chunk)[-4 * process.TAIL :]
        return bool(chunk)

    def _silent(self, answered: int) -> BrokenOffError:
        hint = "; answers must be flushed line by line" if self.unread or not answered else ""
        return BrokenOffError("timeout", f"no answer within {self.patience:g} s{hint}{self._tail()}", answered)

    def _ended(self, answered: int) -> BrokenOffError:
        """The process closed its output: by what end."""
        try:
            code = self.child.wait(GRACE)
        except subprocess.TimeoutExpired:
            return BrokenOffError("invalid", f"the probe closed its output{self._tail()}", answered)
        if code < 0:
            return BrokenOffError(
                "crash", f"the probe was killed by {process.signal_name(-code)}{self._tail()}", answered
            )
        return BrokenOffError("error", f"the probe ended with exit status {code}{self._tail()}", answered)

    def _tail(self) -> str:
        """The last line on stderr, for a message."""
        with contextlib.suppress(OSError):  # nothing was said, or all has been read
            self._overhear()
        lines = process.clean(self.said).splitlines()
        return f": {lines[-1][:200]}" if lines else ""
