"""Whether a picture and its truth fit into this machine's memory, asked before anything is allocated."""

from __future__ import annotations

import contextlib
import math
import os
from pathlib import Path

from raycheck.errors import UsageError

PIXEL = 256
"""Bytes a pixel. The certified render holds 177 while it looks for margins: the enclosure's value, radius (3 float64
each) and doubts (1) make 56, its own value, bound, bits and decided 57, four float64 columns, in tiles and joined, 64.
Judging a picture against its truth holds 232, most of them both ends of every bound."""

_LIMITS = (Path("/sys/fs/cgroup/memory.max"), Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"))
"""Where a container finds its own (Linux, admin-guide/cgroup-v2.rst and cgroup-v1/memory.rst)."""


def physical() -> int:
    """Bytes of memory of the machine; 0 where the system does not say."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        return 0


def memory() -> float:
    """Bytes of memory that this process may hope for: the machine's, or its container's; infinite if nobody says."""
    found = [physical() or math.inf]
    for path in _LIMITS:
        with contextlib.suppress(OSError, ValueError):  # not limited, or not on this system
            found.append(int(path.read_text("ascii")))
    return min(found)


def check_fits(width: int, height: int, said: str, at_once: int = 1) -> None:
    """Raise UsageError, beginning with `said`, unless so many pictures of this size fit together."""
    needed, there = PIXEL * width * height * at_once, memory()
    if needed > there:
        several = f", {at_once} at once," if at_once > 1 else ""
        raise UsageError(
            f"{said}: {width}x{height} pixels with their proof{several} take {_gib(needed)} of memory, "
            f"there are {_gib(there)}",
            "a smaller --size WxH" + (" or fewer --jobs" if at_once > 1 else ""),
        )


def _gib(count: float) -> str:
    return f"{count / 2**30:.3g} GiB"
