"""raycheck report: the pages again, from what was found or measured."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from raycheck import session
from raycheck.errors import CONFORMS, UsageError
from reports import chart, results, stability
from reports.stored import ResultsError


def run(options: Namespace) -> int:
    """Read, write, name the page."""
    folder = Path(options.folder)
    try:
        print(_written(folder, _newest(folder)))
    except ResultsError as error:
        raise UsageError(str(error)) from None
    return CONFORMS


def _newest(folder: Path) -> str:
    """Which of the files that share one page was written last: the page belongs to it."""
    there = [name for name in (results.FILE, stability.FILE, chart.FILE) if (folder / name).exists()]
    newest = max(there, key=lambda name: (folder / name).stat().st_mtime_ns, default=results.FILE)
    if len(there) > 1:
        print(f"{folder} holds {' and '.join(there)}: the page is of {newest}, the newest", file=sys.stderr)
    return newest


def _written(folder: Path, name: str) -> Path:
    match name:
        case stability.FILE:
            return stability.write(stability.read(folder), folder)
        case chart.FILE:
            return chart.write(chart.read(folder), folder)
    return session.write(results.read(folder), folder)
