"""junit.xml: a run for a CI server; one test case for each verdict."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

from oracles.verdict import Case, Judged, Shrunk, Verdict, Word
from reports import conclusion, format, plain
from reports.results import Results
from scenes.disk import write_whole

FILE = "junit.xml"

ELEMENTS: dict[Word, str] = {
    "fail": "failure",
    "invalid": "failure",
    "fixed": "failure",
    "crash": "error",
    "timeout": "error",
    "error": "error",
    "blocked": "skipped",
    "unsupported": "skipped",
    "undecided": "skipped",
    "known": "skipped",
}
"""What a verdict other than a pass is to JUnit."""


def write(results: Results, folder: Path) -> Path:
    """Write junit.xml whole or not at all; return its path."""
    path = folder / FILE
    write_whole(path, document(results))
    return path


def document(results: Results) -> bytes:
    """The XML document, UTF-8."""
    clean = plain.results(results)
    root = ElementTree.Element("testsuites", _totals(clean))
    suite = ElementTree.SubElement(root, "testsuite", _totals(clean), timestamp=clean.started)
    properties = ElementTree.SubElement(suite, "properties")
    for name, value in _properties(clean):
        ElementTree.SubElement(properties, "property", name=name, value=value)
    suite.extend(_case(verdict) for verdict in clean.verdicts)
    ElementTree.indent(root)
    body: bytes = ElementTree.tostring(root, "utf-8", xml_declaration=True)
    return body + b"\n"


def _totals(results: Results) -> dict[str, str]:
    elements = [ELEMENTS.get(verdict.verdict) for verdict in results.verdicts]
    return {
        "name": f"raycheck {results.subject.name}",
        "tests": str(len(elements)),
        "failures": str(elements.count("failure")),
        "errors": str(elements.count("error")),
        "skipped": str(elements.count("skipped")),
        "time": f"{results.seconds:.3f}",
    }


def _properties(results: Results) -> Iterator[tuple[str, str]]:
    yield "conclusion", conclusion.sentence(results)
    yield "complete", str(results.complete).lower()
    yield "suite", results.suite.version
    yield "catalogue", results.suite.catalogue
    yield "seed", str(results.seed)
    yield "command", results.command


def _case(verdict: Verdict) -> ElementTree.Element:
    time = f"{verdict.seconds:.3f}"
    case = ElementTree.Element("testcase", classname="raycheck", name=verdict.check, time=time)
    kind = ELEMENTS.get(verdict.verdict)
    if kind is not None:
        said = plain.line(verdict.message) or verdict.verdict
        found = ElementTree.SubElement(case, kind, type=verdict.verdict, message=f"{verdict.verdict}: {said}")
        found.text = "\n".join(_evidence(verdict))
    return case


def _evidence(verdict: Verdict) -> Iterator[str]:
    """The message, the worst pixel, the process, and the line that runs it again."""
    yield verdict.message
    if verdict.blocked_by:
        yield f"blocked by: {verdict.blocked_by}"
    if verdict.judged:
        yield from _numbers(verdict.judged)
    if verdict.case:
        yield from _case_told(verdict.case)
    if verdict.shrunk:
        yield from _shrunk_told(verdict.shrunk)
    if verdict.process:
        yield f"process: {format.shell(verdict.process.command)}: {verdict.process.status}"
        yield verdict.process.output_tail
    if verdict.reproduce:
        yield f"run again: {verdict.reproduce}"


def _case_told(case: Case) -> Iterator[str]:
    if case.expected is not None and case.bound is not None and case.got is not None:
        yield (
            f"{case.quantity}: expected {format.value(case.expected)} ± {format.measure(case.bound)}, "
            f"got {format.value(case.got)}"
        )
    if case.run:
        yield f"this case: {case.run}"


def _shrunk_told(shrunk: Shrunk) -> Iterator[str]:
    yield (
        f"smallest scene that fails: {shrunk.file} ({shrunk.left}): pixel {shrunk.pixel}: expected "
        f"{format.triple(shrunk.expected)}, got {format.triple(shrunk.got)}"
    )
    yield f"judge it: {shrunk.judge}"


def _numbers(judged: Judged) -> Iterator[str]:
    yield f"outside: {judged.outside} of {judged.pixels} pixels"
    worst = judged.worst
    if worst:
        yield (
            f"worst pixel: i {worst.i}, j {worst.j}, {worst.channel}: expected {format.value(worst.expected)} "
            f"± {format.measure(worst.tolerance)}, got {format.value(worst.got)} ({format.unit(worst)}), "
            f"excess: {format.excess(worst)}"
        )
