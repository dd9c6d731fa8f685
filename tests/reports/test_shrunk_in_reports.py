"""The smallest failing scene, as page and junit.xml tell it; what a tracer brought into it is text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from oracles.verdict import Shrunk, Verdict
from reports import junit, page, results
from reports.results import Results

Make = Callable[..., Verdict]
Run = Callable[..., Results]


@pytest.fixture
def shrunk() -> Shrunk:
    return Shrunk(
        file="scenes/phong-10.shrunk.txt",
        left="1 sphere, 1 light, depth 0, 1 pixel",
        text="raycheck 1 phong-10-shrunk\nimage 1 1 0 0\nend\n",
        pixel=(0, 3),
        expected=(0.25, 0.0, 1.0),
        tolerance=(1e-7, 0.0, 2e-7),
        got=(0.125, 0.0, 1.0),
        tries=1234,
        least=True,
        run="(cd team && ./tracer scene.txt scene.pfm)",
        judge="raycheck check team --scenes raycheck-report/scenes/phong-10.shrunk.txt",
    )


def test_the_page_shows_what_is_left_the_numbers_the_scene_and_both_lines(
    make: Make, run: Run, shrunk: Shrunk, folder: Path
) -> None:
    text = page.render(run(make("fail", shrunk=shrunk)), folder)
    for told in (
        shrunk.left,
        shrunk.file,
        "0.25, 0, 1",
        "0.125, 0, 1",
        "1,234 scenes tried",
        "nothing more",
        shrunk.text,
    ):
        assert told.strip() in text
    assert "(cd team &amp;&amp; ./tracer scene.txt scene.pfm)" in text
    assert shrunk.judge in text
    assert "Allowed for" not in text


def test_a_search_that_was_ended_and_what_was_allowed_for_are_said(
    make: Make, run: Run, shrunk: Shrunk, folder: Path
) -> None:
    more = shrunk.model_copy(update={"least": False, "under": "are upside down", "unit": "code"})
    text = page.render(run(make("fail", shrunk=more)), folder)
    assert "ended before everything was tried" in text
    assert "are upside down" in text
    assert "display codes" in text


def test_without_text_and_own_line_the_page_leaves_them_out(make: Make, run: Run, shrunk: Shrunk, folder: Path) -> None:
    bare = shrunk.model_copy(update={"text": "", "run": "", "judge": ""})
    text = page.render(run(make("fail", shrunk=bare)), folder)
    assert "That scene" not in text
    assert "Run the tracer on it" not in text
    assert "Judge it" not in text


def test_what_is_hostile_is_escaped_and_bounded(make: Make, run: Run, shrunk: Shrunk, folder: Path) -> None:
    bad = "<script>alert(1)</script>\x1b[31m"
    fields = dict.fromkeys(("file", "left", "text", "under", "run", "judge"), bad + "x" * 20_000)
    text = page.render(run(make("fail", shrunk=shrunk.model_copy(update=fields))), folder)
    assert "<script>alert" not in text
    assert "\x1b" not in text
    assert "x" * 9_000 not in text


def test_results_and_junit_tell_it(make: Make, run: Run, shrunk: Shrunk, tmp_path: Path) -> None:
    told = run(make("fail", shrunk=shrunk))
    results.write(told, tmp_path)
    assert results.read(tmp_path).verdicts[0].shrunk == shrunk
    text = junit.document(told).decode()
    assert "smallest scene that fails: scenes/phong-10.shrunk.txt (1 sphere, 1 light, depth 0, 1 pixel)" in text
    assert "pixel (0, 3): expected 0.25, 0, 1, got 0.125, 0, 1" in text
    assert f"judge it: {shrunk.judge}" in text
