"""raycheck faults: the known mistakes, or one of them explained."""

from __future__ import annotations

from argparse import Namespace

from oracles.faults import fault
from oracles.faults.words import explained, listed
from raycheck.errors import CONFORMS, UsageError


def run(options: Namespace) -> int:
    """Print the list, or one entry."""
    name = options.explain or options.name
    if options.explain and options.name not in (None, options.explain):
        raise UsageError(f"both {options.name!r} and --explain {options.explain} are given", "one fault")
    if name is None:
        lines = listed()
    else:
        try:
            lines = explained(fault(name))
        except KeyError as error:
            raise UsageError(f"no fault is called {name!r}", f"for example {error.args[0]}") from None
    for line in lines:
        print(line)
    return CONFORMS
