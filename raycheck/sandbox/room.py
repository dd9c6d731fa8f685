"""Where a command runs: out in the open, or in a jail. Both give out holds."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from raycheck.process import GROUP, Hold


class Room(Protocol):
    """Gives a hold for one run."""

    def hold(self, read: Sequence[Path], write: Sequence[Path]) -> contextlib.AbstractContextManager[Hold]:
        """A hold in which the command sees these files and folders, and may change what is in `write`."""


@dataclass(frozen=True)
class _Open:
    """No walls: the program has the rights of its caller."""

    @contextlib.contextmanager
    def hold(self, read: Sequence[Path], write: Sequence[Path]) -> Iterator[Hold]:
        yield GROUP


OPEN: Room = _Open()
