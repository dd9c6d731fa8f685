"""Dialects and slips of convention: the C++ example in each, what the suite finds, and whether it conforms then.

Each variant is checked as a stranger's: first without a word about its dialect, which must be inferred; then with
the lines that were named, under which it must conform. Slips are found, and all pictures right but for them.
Last, real faults under dialects: found as before, and not explained away.

    python benchmarks/dialects.py [--only WORDS ...]

With --only, the rows whose name holds any of the words.
"""

from __future__ import annotations

import argparse
import importlib.util
import tempfile
import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from oracles.verdict import Verdict
from raycheck.known import Known
from raycheck.machine import machine
from raycheck.subjects import attach
from raycheck.suite import Hearing, Plan
from scenes.catalogue import ladder

_SPEC = importlib.util.spec_from_file_location("cpp_variants", Path(__file__).parents[1] / "examples/cpp_variants.py")
assert _SPEC
assert _SPEC.loader
variants: Any = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(variants)

COMBINED: tuple[tuple[tuple[str, ...], tuple[str, ...]], ...] = (
    (('specular = "blinn"', 'lambert = "1/pi"'), ("upside down",)),
    (('ambient = "per_light"', 'mix = "lerp"'), ("BGR",)),
    (('sample = "centre"', 'tir = "reflect"', 'fresnel = "schlick"'), ()),
    (("specular_needs_light_in_front = false", 'glass_shadow = "none"'), ("gamma 2.2",)),
    (('faces = "outward"', 'clamp = "generation"'), ("sRGB",)),
    (('limit = "background"', 'specular = "blinn"'), ("mirrored", "w-1")),
)
"""Dialect lines and slips, together."""

FAULTY = (
    ("reflection 2n - i", ('lambert = "1/pi"',)),
    ("ratio not inverted on leaving", ('specular = "blinn"',)),
    ("shadows pass the light", ('ambient = "per_light"',)),
    ("light vector not unit", ('sample = "centre"',)),
    ("nearest is the last", ('fresnel = "schlick"',)),
)
"""A fault on top of a dialect."""


def check(folder: Path) -> tuple[list[Verdict], float]:
    """The suite's verdicts on a tracer's folder, and the seconds they took."""
    subject = attach(str(folder))
    subject.prepare()
    plan = Plan(ladder(), None, 0, True, Known({}), "{scene}")
    begin = time.perf_counter()
    hearing = Hearing(subject, plan, folder / "report")
    verdicts = hearing.reconsidered(list(hearing.verdicts()), lambda words: None)
    return verdicts, time.perf_counter() - begin


def edits(dialect: Iterable[str], slips: Iterable[str], faults: Iterable[str] = ()) -> list[tuple[str, str]]:
    """All edits of a variant."""
    tables = ((variants.DIALECTS, dialect), (variants.SLIPS, slips), (variants.FAULTS, faults))
    return [edit for table, names in tables for name in names for edit in table[name]]


def told(verdicts: list[Verdict]) -> tuple[str, ...]:
    """The findings about conventions."""
    return tuple(v.message for v in verdicts if v.check.startswith("convention/"))


def wrong(verdicts: list[Verdict]) -> list[str]:
    """Failing checks that are no findings about conventions."""
    return [v.check for v in verdicts if v.verdict not in ("pass", "undecided") and v.check.startswith("image/")]


def one(place: Path, dialect: tuple[str, ...], slips: tuple[str, ...]) -> str:
    """A row: was it inferred, does it conform then."""
    verdicts, seconds = check(variants.write(place / "blind", edits(dialect, slips)))
    said = " ".join(told(verdicts))
    lines = said.partition("[tracer.dialect]: ")[2].split("; ") if dialect else []
    named = sorted(lines) == sorted(dialect) and all(_SIGNS[slip] in said for slip in slips)
    declared, _ = check(variants.write(place / "declared", edits(dialect, slips), dialect))
    expected = 1 if slips else 0
    clean = not wrong(verdicts) and not wrong(declared) and len(told(declared)) == expected
    inferred = "inferred" if named else f"NOT INFERRED: {said}"
    return f"{inferred}, {'conforms' if clean else f'WRONG: {wrong(declared)}'}, {seconds:.1f} s"


_SIGNS = {
    "upside down": "are upside down",
    "mirrored": "are mirrored",
    "BGR": "red and blue exchanged",
    "sRGB": "sRGB encoding",
    "gamma 2.2": "gamma 2.2",
    "half": "half a pixel",
    "w-1": "are stretched",
}


def faulty(place: Path, fault: str, dialect: tuple[str, ...]) -> str:
    """A row: what fails of a fault alone, on its dialect, and where nobody declared that."""
    alone = wrong(check(variants.write(place / "fault", edits((), (), (fault,))))[0])
    both, _ = check(variants.write(place / "both", edits(dialect, (), (fault,)), dialect))
    blind, _ = check(variants.write(place / "blind", edits(dialect, (), (fault,))))
    same = "the same" if wrong(both) == alone else wrong(both)
    said = " ".join(told(blind)) or "no dialect named"
    return f"{len(alone)} checks not passed alone, {same} declared,\n    {len(wrong(blind))} undeclared; {said}"


def main() -> None:
    """All rows that are asked for."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", nargs="*", default=[""], metavar="WORDS")
    only = options.parse_args().only
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}")
    cases = [((name,), ()) for name in variants.DIALECTS] + [((), (name,)) for name in variants.SLIPS]
    rows = {", ".join(dialect + slips): (one, dialect, slips) for dialect, slips in [*cases, *COMBINED]}
    rows |= {f"{fault} on {', '.join(dialect)}": (faulty, fault, dialect) for fault, dialect in FAULTY}
    for name, (row, *about) in rows.items():
        if any(words in name for words in only):
            with tempfile.TemporaryDirectory() as place:
                print(f"{name:<75} {row(Path(place), *about)}", flush=True)


if __name__ == "__main__":
    main()
