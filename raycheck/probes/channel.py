"""A process that answers a line for a line: written to and read from at once, bounded in time and size.

A batch is sent as fast as the process reads it while its answers are read as fast as they come, so neither side
waits for the other with full pipes, and a round trip is paid once a batch.
"""

from __future__ import annotations

import contextlib
import math
import os
import selectors
import subprocess
import threading
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

SPENT = "its answers took longer than all of them together may"


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
        self.breach = ""
        self.closed = threading.Event()
        self.watchman = threading.Thread(target=self._watch, daemon=True)
        if hold is not process.GROUP:  # which limits nothing that has to be watched
            self.watchman.start()

    def close(self) -> None:
        """End the process."""
        self.closed.set()
        if self.watchman.is_alive():
            self.watchman.join()
        process.stop(self.child, self.hold)

    def _watch(self) -> None:
        """End the process once it passes a limit of its hold, also while it is asked nothing."""
        while not self.closed.wait(process.LOOK):
            if breach := self.hold.breach(self.child.pid):
                self.breach = breach
                self.hold.end(self.child)
                return

    def exchange(self, requests: bytes, count: int, until: float = math.inf) -> list[bytes]:
        """The answers to `count` lines of requests; raise BrokenOffError where they do not come.

        until: when the last must have come, on the monotonic clock.
        """
        into, out, err = self.ends
        self._nothing_waits()
        left = memoryview(requests)
        answers: list[bytes] = []
        deadline = min(until, time.monotonic() + self.patience)
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
                    deadline = min(until, time.monotonic() + self.patience)
                if len(answers) < count and (now := time.monotonic()) >= deadline:
                    raise self._silent(len(answers), now >= until)
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

    def _silent(self, answered: int, spent: bool) -> BrokenOffError:
        if spent:
            return BrokenOffError("timeout", f"{SPENT}{self._tail()}", answered)
        hint = "; answers must be flushed line by line" if self.unread or not answered else ""
        return BrokenOffError("timeout", f"no answer within {self.patience:g} s{hint}{self._tail()}", answered)

    def _ended(self, answered: int) -> BrokenOffError:
        """The process closed its output: by what end."""
        try:
            code = self.child.wait(GRACE)
        except subprocess.TimeoutExpired:
            return BrokenOffError("invalid", f"the probe closed its output{self._tail()}", answered)
        breach = self.breach or self.hold.breach(self.child.pid)
        if breach:
            return BrokenOffError("invalid", f"used more than its limit of {breach} and was stopped", answered)
        tail = self._tail()
        try:
            how, number = self.hold.outcome(code, self.said)
        except OSError as error:
            return BrokenOffError("error", f"the probe cannot be started: {error.strerror}", answered)
        if how == "signal":
            return BrokenOffError("crash", f"the probe was killed by {process.signal_name(number)}{tail}", answered)
        return BrokenOffError("error", f"the probe ended with exit status {number}{tail}", answered)

    def _tail(self) -> str:
        """The last line on stderr, for a message."""
        with contextlib.suppress(OSError):  # nothing was said, or all has been read
            self._overhear()
        lines = process.clean(self.said).splitlines()
        return f": {lines[-1][:200]}" if lines else ""
