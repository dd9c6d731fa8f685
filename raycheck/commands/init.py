"""raycheck init: a tracer to begin with."""

from __future__ import annotations

import shlex
from argparse import Namespace
from pathlib import Path

from raycheck.errors import CONFORMS
from raycheck.skeleton import skeleton


def run(options: Namespace) -> int:
    """Write the files, and say what to do with them."""
    folder = Path(options.folder)
    for path in skeleton(options.language, folder):
        print(path)
    print(
        f"the scene reader and the image writer are done, the formulas are marked YOURS; check it with:\n"
        f"raycheck check {shlex.quote(str(folder))}"
    )
    return CONFORMS
