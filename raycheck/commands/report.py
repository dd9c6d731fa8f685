"""raycheck report: the pages again, from results.json and the pictures beside it."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from raycheck import session
from raycheck.errors import CONFORMS, UsageError
from reports import results


def run(options: Namespace) -> int:
    """Read, write, name the page."""
    folder = Path(options.folder)
    try:
        found = results.read(folder)
    except results.ResultsError as error:
        raise UsageError(str(error)) from None
    print(session.write(found, folder))
    return CONFORMS
