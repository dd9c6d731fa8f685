"""A tracer's name and output are text, whatever they hold."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from oracles.verdict import Verdict
from reports import junit, page, plain, summary
from reports.results import Results

HOSTILE = [
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "'><svg onload=alert(1)>",
    "{{7*7}}{% raw %}",
    "</style></pre></title><iframe src=//x>",
    "\x1b[31mred\x1b[0m\x1b]0;title\x07",
    "a\x00b\x08\x7f\x9b31m",
    "\u202egnp.exe",
    "]]><!--",
    "long" * 10_000,
]
FORBIDDEN = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")


def strings(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of all strings in nested data."""
    if isinstance(value, str):
        yield path
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from strings(entry, (*path, key))
    elif isinstance(value, (list, tuple)):
        for index, entry in enumerate(value):
            yield from strings(entry, (*path, index))


def poisoned(results: Results, evil: str) -> Results:
    """The results with evil in every free text, and as keys."""
    data = results.model_dump(mode="json")
    for path in strings(data):
        if path[-1] not in ("verdict", "channel", "unit", "memory_gib"):
            place = data
            for key in path[:-1]:
                place = place[key]
            place[path[-1]] = evil
    data["machine"]["packages"] = {evil: evil}
    for verdict in data["verdicts"]:
        verdict["judged"]["doubtful"] = {evil: 3}
    return Results.model_validate(data)


def skeleton(html: str) -> list[str]:
    """The tags of a page, without what hangs on its texts."""
    return [re.sub(r'(href|title|id|src|content)="[^"]*"', r"\1", tag) for tag in re.findall(r"<[^>]*>", html)]


@pytest.mark.parametrize("evil", HOSTILE)
def test_no_text_becomes_markup(results: Results, folder: Path, evil: str) -> None:
    harmless = page.render(poisoned(results, "x"), folder)
    html = page.render(poisoned(results, evil), folder)
    assert [t for t in skeleton(html) if "missing" not in t] == [t for t in skeleton(harmless) if "missing" not in t]
    assert not FORBIDDEN.search(html)


def test_template_syntax_is_shown_not_run(results: Results, folder: Path) -> None:
    html = page.render(poisoned(results, "{{7*7}}"), folder)
    assert "{{7*7}}" in html
    assert "49" not in html[html.index("<main>") : html.index("<script>")]


def test_a_long_output_keeps_the_page_small(results: Results, folder: Path) -> None:
    assert len(page.render(poisoned(results, "<" * 10**6), folder)) < 2_000_000


@pytest.mark.parametrize("evil", HOSTILE)
def test_junit_stays_well_formed(results: Results, evil: str) -> None:
    root = ElementTree.fromstring(junit.document(poisoned(results, evil)))  # noqa: S314 (our own document)
    assert len(root.findall(".//testcase")) == len(results.verdicts)
    assert not FORBIDDEN.search("".join(root.itertext()))


@pytest.mark.parametrize("evil", HOSTILE)
def test_the_summary_has_one_short_line_a_verdict(results: Results, evil: str) -> None:
    lines = summary.lines(poisoned(results, evil + "\nnext\rnext"))
    assert len(lines) == len(results.verdicts) - 1 + 2
    assert not FORBIDDEN.search("".join(lines))
    assert all("\n" not in line and len(line) < 1200 for line in lines)


@pytest.mark.parametrize(
    ("raw", "shown"),
    [
        ("\x1b[1;31mred\x1b[0m", "red"),
        ("\x1b]8;;http://x\x1b\\link\x1b]8;;\x07", "link"),
        ("\x1bPq#0\x1b\\sixel", "sixel"),
        ("\x1b(Bplain\x1b", "plain"),
        ("10 %\r20 %\r\ndone", "10 %\n20 %\ndone"),
        ("a\x00b\x7fc\x85d", "abc\nd"),
        ("\ufeffx\ufffe\uffff\ud800", "x"),
        ("tab\tnewline\n", "tab\tnewline\n"),
        ("θ₁ ∘ 光", "θ₁ ∘ 光"),
    ],
)
def test_terminal_codes_and_control_characters_go(raw: str, shown: str) -> None:
    assert plain.text(raw) == shown


@given(st.text(st.characters(), max_size=200))
def test_plain_text_is_plain(raw: str) -> None:
    shown = plain.text(raw)
    assert plain.text(shown) == shown
    assert not FORBIDDEN.search(shown)
    shown.encode()


@given(st.text("\x1b[]P;m0a\\\x07\x9b\n", max_size=60))
def test_nothing_reassembles_into_an_escape(raw: str) -> None:
    assert not re.search("[\x1b\x07\x9b]", plain.text(raw))


def test_a_long_output_keeps_its_end() -> None:
    shown = plain.tail("\n".join(f"line {n}" for n in range(10_000)))
    assert shown.startswith("…\n")
    assert shown.endswith("line 9999")
    assert len(shown.split("\n")) == plain.TAIL_LINES + 1


def test_a_long_line_keeps_its_start_and_shows_the_cut() -> None:
    assert plain.line("x" * 501) == "x" * 499 + "…"
    assert plain.line("x" * 500) == "x" * 500


def test_plain_results_are_left_as_they_are(results: Results) -> None:
    assert plain.results(results) == results


def test_a_message_keeps_its_lines_and_a_name_does_not(
    run: Callable[..., Results], make: Callable[..., Verdict]
) -> None:
    clean = plain.results(run(make("fail", check="a\nb", message="a\nb"))).verdicts[0]
    assert (clean.check, clean.message) == ("a b", "a\nb")
