"""Progress on stderr, where stderr is a terminal."""

from __future__ import annotations

import sys


class Progress:
    """One line that counts up and goes away."""

    def __init__(self, title: str, total: int) -> None:
        self.title, self.total, self.done = title, total, 0
        self.shown = sys.stderr is not None and sys.stderr.isatty()

    def step(self, what: str) -> None:
        """One more is done."""
        self.done += 1
        self.share(self.done / max(1, self.total), f"{self.done}/{self.total} {what}")

    def say(self, what: str) -> None:
        """What is being done."""
        self.share(min(1.0, self.done / max(1, self.total)), what)

    def share(self, share: float, what: str = "") -> None:
        """So much is done, from 0 to 1."""
        if self.shown:
            bar = "#" * round(20 * share)
            sys.stderr.write(f"\r\x1b[K{self.title} [{bar:<20}] {what or f'{share:.0%}'}")
            sys.stderr.flush()

    def close(self) -> None:
        """Clear the line."""
        if self.shown:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
