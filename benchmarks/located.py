"""Where errors are located that no known fault explains: each known fault is hidden in turn, and sought by the others.

Twice: once only the fault itself is hidden, once every known fault of the same formula, so that what is left of it
are its mutants. The tracers are those of benchmarks/diagnosis.py.
"""

from __future__ import annotations

import argparse
import importlib.util
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from oracles.diagnosis.evidence import Evidence
from oracles.diagnosis.located import located, term_of
from oracles.faults import FAULTS, Fault
from raycheck.machine import machine
from scenes.catalogue import ladder
from scenes.model import Scene

_SPEC = importlib.util.spec_from_file_location("diagnosis", Path(__file__).parent / "diagnosis.py")
assert _SPEC
assert _SPEC.loader
diagnosis: Any = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(diagnosis)


def main() -> None:
    """Print the figures; --size WxH, --every N."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--size", default="48x36")
    options.add_argument("--every", type=int, default=1, help="only every Nth fault")
    chosen = options.parse_args()
    width, height = map(int, chosen.size.split("x"))
    scenes = [rung.scene().resized(width, height) for rung in ladder()]
    print(machine())
    with np.errstate(all="ignore"):
        hidden(scenes, [fault for fault in FAULTS if fault.fate == "killed" and fault.entries][:: chosen.every])


def hidden(scenes: Sequence[Scene], faults: Sequence[Fault]) -> None:
    """A line for each fault that is sought in a wrong term."""
    itself = formula = 0
    for fault in faults:
        evidence = Evidence(diagnosis.exhibits(scenes, (fault,)))
        term = term_of(fault).name
        by_itself = located(evidence, [f for f in FAULTS if f is not fault])[0]
        by_formula = located(evidence, [f for f in FAULTS if not f.entries & fault.entries])[0]
        itself += by_itself.term.name == term
        formula += by_formula.term.name == term
        if by_itself.term.name != term or by_formula.term.name != term:
            likes = "; ".join(f"{p.term.name} like {p.like.name} {p.likeness:.2f}" for p in (by_itself, by_formula))
            print(f"  {fault.name} ({term}): {likes}", flush=True)
    count = len(faults)
    print(f"{count} faults: right term with itself hidden {itself} ({itself / count:.1%}),", end=" ")
    print(f"with all of its formula hidden {formula} ({formula / count:.1%})")


if __name__ == "__main__":
    main()
