"""The dictionary in words: a list, an entry, the page of the documents."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from oracles.faults import FAULTS, TWINS, Fault


def in_groups() -> list[Fault]:
    """All entries, those of a group together."""
    return sorted(FAULTS, key=_place)


def listed() -> Iterator[str]:
    """One line a fault, by group."""
    width = max(len(fault.name) for fault in FAULTS)
    for group, faults in groupby(in_groups(), key=lambda fault: fault.group):
        yield f"{group}:"
        yield from (f"  {fault.name:<{width}}  {fault.seen}{_mark(fault)}" for fault in faults)


def explained(fault: Fault) -> Iterator[str]:
    """One fault: source, wrong and right line, what is seen, where to look, how to see it."""
    yield f"{fault.name} ({fault.group})"
    yield f"  source:  {fault.source}"
    yield f"  wrong:   {fault.wrong}"
    yield f"  right:   {fault.right}"
    yield f"  seen:    {fault.seen}"
    yield f"  mend:    {fault.mend}"
    if fault.reason:
        yield f"  {fault.fate}: {fault.reason}"
    yield f"  try it:  raycheck check builtin:fault/{fault.name}"


def page() -> str:
    """docs/faults.md."""
    lines = [
        "# The dictionary of faults",
        "",
        f"{len(FAULTS)} known mistakes, each a rulebook with a wrong entry or a wrong way to write the file; "
        f"and {len(TWINS)} correct tracers that differ. `raycheck faults NAME` explains one, "
        "`raycheck check builtin:fault/upside-down` shows what the suite says of one, and `raycheck power` proves that",
        "every one is noticed and no correct tracer is failed. Written from `oracles/faults`.",
        "",
        "`raycheck faults --out raycheck-faults` writes a page for each, with an index: what one sees, right and wrong "
        "picture of the scene that shows it best, right and wrong line, and which scenes notice it "
        "(`--explain NAME`: that page only). They take a minute or two and are not kept with the source.",
        "",
        "Wrong lines are as a student writes them. A fault marked *survives* is noticed by no scene of the catalogue, "
        "for the reason given; one marked *equivalent* changes nothing, by the proof given.",
    ]
    for group, faults in groupby(in_groups(), key=lambda fault: fault.group):
        lines += ["", f"## {group.capitalize()}", "", "| fault | wrong | right | seen | mend | source |"]
        lines += ["|---|---|---|---|---|---|", *map(_row, faults)]
    lines += ["", "## Twins", "", "Correct tracers, which nothing may fail.", "", "| twin | how |", "|---|---|"]
    lines += [f"| {twin.name} | {_cell(twin.how)} |" for twin in TWINS]
    return "\n".join(lines) + "\n"


def _place(fault: Fault) -> int:
    """The first place of the fault's group in the dictionary: sorting by it keeps groups together."""
    return next(k for k, other in enumerate(FAULTS) if other.group == fault.group)


def _mark(fault: Fault) -> str:
    return "" if fault.fate == "killed" else f" ({fault.fate})"


def _row(fault: Fault) -> str:
    seen = f"{fault.seen}. *{fault.fate.capitalize()}*: {fault.reason}" if fault.reason else fault.seen
    words = (f"`{_cell(fault.wrong)}`", f"`{_cell(fault.right)}`", seen, fault.mend, fault.source)
    return f"| {fault.name} | {words[0]} | {words[1]} | {' | '.join(map(_cell, words[2:]))} |"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
