"""junit.xml counts as CI servers count."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import get_args
from xml.etree import ElementTree

import pytest

from oracles.verdict import Verdict, Word
from reports import junit
from reports.results import Results

Make = Callable[..., Verdict]
Run = Callable[..., Results]


def parsed(results: Results) -> ElementTree.Element:
    return ElementTree.fromstring(junit.document(results))  # noqa: S314 (our own document)


def test_the_totals_are_those_of_the_cases(results: Results) -> None:
    root = parsed(results)
    for suite in (root, root[0]):
        assert int(suite.attrib["tests"]) == len(root.findall(".//testcase")) == 11
        assert int(suite.attrib["failures"]) == len(root.findall(".//failure")) == 3
        assert int(suite.attrib["errors"]) == len(root.findall(".//error")) == 3
        assert int(suite.attrib["skipped"]) == len(root.findall(".//skipped")) == 4


@pytest.mark.parametrize(
    ("word", "element"),
    [
        ("pass", None),
        ("fail", "failure"),
        ("invalid", "failure"),
        ("fixed", "failure"),
        ("crash", "error"),
        ("timeout", "error"),
        ("error", "error"),
        ("blocked", "skipped"),
        ("unsupported", "skipped"),
        ("undecided", "skipped"),
        ("known", "skipped"),
    ],
)
def test_each_word_is_its_element(run: Run, make: Make, word: Word, element: str | None) -> None:
    case = parsed(run(make(word))).find(".//testcase")
    assert case is not None
    assert (case.get("classname"), case.get("name"), case.get("time")) == ("raycheck", f"a-{word}", "0.125")
    assert [child.tag for child in case] == ([element] if element else [])


def test_every_word_but_pass_has_an_element() -> None:
    assert set(junit.ELEMENTS) == set(get_args(Word)) - {"pass"}


def test_a_failure_tells_its_numbers_and_how_to_run_it_again(run: Run, make: Make) -> None:
    failure = parsed(run(make("fail"))).find(".//failure")
    assert failure is not None
    assert failure.get("message") == "fail: the message of fail"
    assert (failure.text or "").split("\n") == [
        "the message of fail",
        "outside: 31 of 192 pixels",
        "worst pixel: i 7, j 3, green: expected 0.123456789 ± 2.5e-07, got 0.25 (linear light), "
        "excess: 5.06e+05 tolerances",
        "process: ./tracer 'two words.txt': exit status 0",
        "reading",
        "tracing",
        "run again: raycheck check t --scenes a-fail",
    ]


def test_a_blocked_check_names_its_blocker(run: Run, make: Make) -> None:
    blocked = make("blocked", blocked_by="shadow-hard", message="", judged=None, process=None, reproduce="")
    skipped = parsed(run(blocked)).find(".//skipped")
    assert skipped is not None
    assert skipped.get("message") == "blocked: blocked"
    assert (skipped.text or "").strip() == "blocked by: shadow-hard"


def test_a_judgement_without_a_worst_pixel_tells_its_counts(run: Run, make: Make) -> None:
    bare = make("fail")
    judged = bare.judged and bare.judged.model_copy(update={"worst": None})
    failure = parsed(run(bare.model_copy(update={"judged": judged}))).find(".//failure")
    assert failure is not None
    assert "outside: 31 of 192" in (failure.text or "")
    assert "worst pixel" not in (failure.text or "")


def test_the_properties_tell_an_interrupted_run(run: Run, make: Make) -> None:
    found = {p.get("name"): p.get("value") for p in parsed(run(make("pass"), complete=False)).iter("property")}
    assert found["complete"] == "false"
    assert found["seed"] == "41"
    assert "interrupted" in (found["conclusion"] or "")


def test_the_same_results_give_the_same_bytes(results: Results, folder: Path) -> None:
    path = junit.write(results, folder)
    assert path == folder / "junit.xml"
    assert path.read_bytes() == junit.document(results)
    assert sorted(p.name for p in folder.iterdir()) == ["images", "junit.xml"]
