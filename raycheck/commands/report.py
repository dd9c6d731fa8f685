"""raycheck report: the pages again, from what was found or measured."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from raycheck import session
from raycheck.errors import CONFORMS, UsageError
from reports import chart, results, stability


def run(options: Namespace) -> int:
    """Read, write, name the page."""
    folder = Path(options.folder)
    try:
        if (folder / stability.FILE).exists():
            print(stability.write(stability.read(folder), folder))
            return CONFORMS
        if (folder / chart.FILE).exists():
            print(chart.write(chart.read(folder), folder))
            return CONFORMS
        found = results.read(folder)
    except results.ResultsError as error:
        raise UsageError(str(error)) from None
    print(session.write(found, folder))
    return CONFORMS
