"""The page tells what the results hold, in the order in which it matters."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from hashlib import sha256
from html.parser import HTMLParser
from pathlib import Path
from typing import get_args

import pytest
from PIL import Image

from oracles.verdict import Judged, Pictures, Pixel, Verdict, Word
from reports import page
from reports.results import Results

Make = Callable[..., Verdict]
Run = Callable[..., Results]


class Outline(HTMLParser):
    """Tags with their attributes, and the text outside style and script."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.raw: dict[str, str] = {"style": "", "script": ""}
        self.inside = ""
        self.feed(html)
        self.text = " ".join(self.text.split())

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self.inside = tag

    def handle_endtag(self, tag: str) -> None:
        self.inside = ""
        self.text += " " if tag in ("dt", "dd", "p", "pre", "h4") else ""

    def handle_data(self, data: str) -> None:
        if self.inside in self.raw:
            self.raw[self.inside] += data
        else:
            self.text += data

    def attributes(self, tag: str, name: str) -> list[str]:
        return [attrs[name] or "" for found, attrs in self.tags if found == tag and name in attrs]


@pytest.fixture
def html(results: Results, folder: Path) -> str:
    return page.render(results, folder)


@pytest.fixture
def outline(html: str) -> Outline:
    return Outline(html)


def test_the_same_results_and_pictures_give_the_same_bytes(results: Results, folder: Path) -> None:
    first = page.write(results, folder).read_bytes()
    assert page.write(results, folder).read_bytes() == first


def test_the_page_is_written_beside_the_results_and_leaves_nothing_else(results: Results, folder: Path) -> None:
    assert page.write(results, folder) == folder / "index.html"
    assert sorted(path.name for path in folder.iterdir()) == ["images", "index.html"]


def test_the_policy_names_exactly_the_style_and_script_on_the_page(outline: Outline) -> None:
    policy = next(a["content"] for tag, a in outline.tags if a.get("http-equiv") == "Content-Security-Policy") or ""
    for kind, body in outline.raw.items():
        digest = b64encode(sha256(body.encode()).digest()).decode()
        assert f"{kind}-src 'sha256-{digest}'" in policy
    assert policy.startswith("default-src 'none'; img-src data:;")
    assert "unsafe" not in policy


def test_the_page_has_no_inline_handler_and_no_style_attribute(outline: Outline) -> None:
    names = {name for _, attrs in outline.tags for name in attrs}
    assert not {name for name in names if name == "style" or name.startswith("on")}


def test_the_page_loads_nothing(outline: Outline) -> None:
    links = outline.attributes("a", "href")
    sources = [source for tag in ("img", "script", "link", "iframe") for source in outline.attributes(tag, "src")]
    assert links
    assert all(link.startswith("#check-") for link in links)
    assert all(source.startswith("data:image/png;base64,") for source in sources)
    assert outline.attributes("link", "href") == ["data:,"]


def test_every_link_leads_to_an_element_and_no_id_occurs_twice(outline: Outline) -> None:
    ids = [attrs["id"] for _, attrs in outline.tags if "id" in attrs]
    assert len(ids) == len(set(ids))
    assert {link.removeprefix("#") for link in outline.attributes("a", "href")} <= set(ids)


def test_checks_of_one_name_have_places_of_their_own(run: Run, make: Make, folder: Path) -> None:
    twice = Outline(page.render(run(make("fail", check="A b"), make("pass", check="a-b")), folder))
    assert "check-1-a-b" in twice.attributes("article", "id")
    assert "check-2-a-b" in twice.attributes("tr", "id")


def test_the_title_says_who_and_what(outline: Outline) -> None:
    assert "Team 7 does not conform: 5 of 11 checks fail, 1 is blocked by them, 1 passes although" in outline.text


def test_verdicts_against_the_tracer_come_before_blocked_before_open_before_passes(html: str) -> None:
    body = html[html.index("<main>") :]
    titles = ("Against the tracer", "Blocked", "Neither for nor against", "Passed", "What this run was")
    places = [body.index(f"<h2>{title}</h2>") for title in titles]
    assert places == sorted(places)
    assert body.index("a-fail</span>") < body.index("a-pass</span>")


@pytest.mark.parametrize("word", get_args(Word))
def test_every_verdict_has_a_place_a_word_and_a_sign(html: str, word: Word) -> None:
    assert f"a-{word}</span>" in html[html.index("<main>") :]
    assert f"{page.SYMBOLS[word]}</span> <b>1</b> {word}" in html


@pytest.mark.parametrize(
    "told",
    [
        "the message of fail",
        "no highlight behind",
        "L11: Phong Effect",
        "r = 2(i∘n)n - i",
        "i 7, j 3, green",
        "0.123456789 ± 2.5e-07",
        "Got 0.25",
        "+0.127",
        "5.06e+05 tolerances",
        "linear light",
        "31 of 192 (16.1 %)",
        "silhouette 5, shadow 2",
        "Tolerance, median 2.1e-07",
        "99 % of pixels 8.8e-07",
        "Worst 3.1e-05",
        "3.12 %",
        "./tracer 'two words.txt'",
        "exit status 0, 21.3 ms",
        "reading tracing",
        "raycheck check t --scenes a-fail",
        "picture missing",
    ],
)
def test_a_failure_tells(run: Run, make: Make, folder: Path, told: str) -> None:
    (folder / "images/difference.png").unlink()
    assert told in Outline(page.render(run(make("fail")), folder)).text


@pytest.mark.parametrize(
    "told",
    [
        "examples/cpp",
        "float32",
        "features spheres",
        "Abacus 9000, 2 cores, 15.6 GiB, Linux 6.1",
        "3.11.9",
        "drjit 1.5.0, numpy 2.4.6",
        "numpy float64",
        "2026.8.0, catalogue 1",
        "41",
        "2026-08-01T12:00:00Z",
        "2 min 11 s",
        "raycheck check examples/cpp",
        "as each scene says",
    ],
)
def test_the_end_tells_what_this_run_was(outline: Outline, told: str) -> None:
    assert told in outline.text[outline.text.index("What this run was") :]


def test_a_failure_shows_three_pictures_and_a_pass_only_what_it_got(run: Run, make: Make, folder: Path) -> None:
    failed = Outline(page.render(run(make("fail")), folder))
    passed = Outline(page.render(run(make("pass")), folder))
    assert failed.attributes("img", "alt") == ["expected", "got", "difference"]
    assert passed.attributes("img", "alt") == ["got"]


def test_the_worst_pixel_is_circled_on_pictures_of_its_size(run: Run, make: Make, folder: Path) -> None:
    html = page.render(run(make("fail")), folder)
    assert html.count('<circle cx="7.5" cy="3.5"') == 3


@pytest.mark.parametrize("change", [{"pixels": 48}, {"worst": None}])
def test_nothing_is_circled_where_the_place_is_not_sure(
    run: Run, make: Make, folder: Path, judged: Judged, change: dict[str, object]
) -> None:
    assert "<circle" not in page.render(run(make("fail", judged=judged.model_copy(update=change))), folder)


def test_nothing_is_circled_outside_the_picture(run: Run, make: Make, folder: Path, judged: Judged) -> None:
    outside: Pixel = judged.worst.model_copy(update={"i": 16})  # type: ignore[union-attr]
    assert "<circle" not in page.render(run(make("fail", judged=judged.model_copy(update={"worst": outside}))), folder)


def test_a_blocked_check_links_to_its_blocker(html: str, results: Results) -> None:
    index = 1 + [verdict.check for verdict in results.verdicts].index("a-fail")
    assert f'<a href="#check-{index}-a-fail">a-fail</a>' in html


def test_a_blocker_that_did_not_run_is_named_without_a_link(run: Run, make: Make, folder: Path) -> None:
    html = page.render(run(make("blocked", blocked_by="absent")), folder)
    assert '<td class="from" data-label="Blocked by">absent</td>' in html


def test_bare_verdicts_leave_no_empty_headings(run: Run, make: Make, folder: Path) -> None:
    bare = {"slide": "", "teaches": "", "formula": "", "reproduce": "", "judged": None, "process": None}
    verdicts = [make(word, **bare, pictures=Pictures()) for word in get_args(Word)]
    html = page.render(run(*verdicts, command="", subject={"name": "x", "spec": "y", "precision": "z"}), folder)
    assert "<h4>" not in html
    assert "features not said" in html


def test_an_interrupted_run_says_so(run: Run, make: Make, folder: Path) -> None:
    outline = Outline(page.render(run(make("pass"), complete=False, planned=42), folder))
    assert "Team 7 was interrupted after 1 of 42 checks, partial results: 1 of 1 check passes" in outline.text
    assert "no: the run was interrupted" in outline.text


def test_a_run_without_verdicts_is_a_page_too(run: Run, folder: Path) -> None:
    assert "No verdict was recorded." in page.render(run(), folder)


def test_forty_two_failures_with_noisy_pictures_stay_under_ten_megabytes(run: Run, make: Make, folder: Path) -> None:
    pictures = []
    for number in range(42):
        names = {kind: f"images/{number}-{kind}.png" for kind in ("expected", "got", "difference")}
        for name in names.values():
            Image.effect_noise((160, 120), 60).convert("RGB").save(folder / name)
        pictures.append(Pictures(**names))
    html = page.render(run(*(make("fail", check=f"c{n}", pictures=p) for n, p in enumerate(pictures))), folder)
    assert html.count("data:image/png") == 126
    assert len(html.encode()) < 10_000_000
