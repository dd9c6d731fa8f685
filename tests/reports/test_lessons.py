"""Pages to learn from: whole, escaped, without scripts, and linked to each other."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reports import lessons
from reports.lessons import Course, Lesson, Pair, sentence
from reports.power import SceneKill

COURSE = Course("0", 46, "64x48")
PNG = b"\x89PNG\r\n\x1a\n"


def lesson(name: str, **more: object) -> Lesson:
    pair = Pair(
        scene="phong-10",
        teaches="a highlight",
        width=4,
        height=3,
        right=PNG + b"r",
        wrong=PNG + b"w",
        difference=PNG + b"d",
        thumbnail=PNG + b"t",
        outside=5,
        finite=True,
    )
    told = {
        "name": name,
        "group": "light",
        "source": 'L11 "Phong Effect"',
        "formula": "specular·max(r∘(-v), 0)^s",
        "wrong": "a < b && c",
        "right": "a > b",
        "seen": "no <b>highlights</b>",
        "mend": "look at r",
        "fate": "killed",
        "reason": "",
        "entries": ("phong",),
        "kills": (SceneKill(scene="phong-10", pixels=5, excess=7.5), SceneKill(scene="strays", pixels=1, excess=None)),
        "pair": pair,
        "again": f"raycheck check builtin:fault/{name} --scenes phong-10 --no-block",
    }
    return Lesson.model_validate(told | more)


def test_a_page_tells_everything_escaped_and_runs_nothing(tmp_path: Path) -> None:
    text = lessons.write_one(lesson("one"), COURSE, tmp_path).read_text("utf-8")
    for told in (
        "a &lt; b &amp;&amp; c",
        "a &gt; b",
        "No &lt;b&gt;highlights&lt;/b&gt;.",
        "Look at r.",
        "5 of 12 pixels",
    ):
        assert told in text
    for told in ("specular·max(r∘(-v), 0)^s", "2 of 46 scenes at 64x48", "none is tolerated", "(shown above)"):
        assert told in text
    assert text.count("data:image/png;base64,") == 3
    assert "<script" not in text
    assert "<b>" not in text
    assert "default-src &#39;none&#39;" in text


def test_a_page_alone_leads_nowhere(tmp_path: Path) -> None:
    text = lessons.write_one(lesson("one"), COURSE, tmp_path).read_text("utf-8")
    assert [path.name for path in tmp_path.iterdir()] == ["one.html"]
    assert re.findall(r'<a [^>]*href="', text) == []


def test_the_index_leads_to_every_page_and_these_to_their_neighbours(tmp_path: Path) -> None:
    found = [lesson("one"), lesson("two"), lesson("three", group="glass")]
    index = lessons.write(found, COURSE, tmp_path)
    assert index == tmp_path / "index.html"
    pages = sorted(tmp_path.glob("*.html"))
    assert len(pages) == 4
    for page in pages:
        for link in re.findall(r'<a [^>]*href="([^"#]+)"', page.read_text("utf-8")):
            assert (tmp_path / link).is_file()
    text = index.read_text("utf-8")
    assert all(f'href="{entry.file}"' in text for entry in found)
    assert "3 mistakes" in text
    assert 'href="#glass">glass (1)' in text
    middle = (tmp_path / "two.html").read_text("utf-8")
    assert 'href="one.html"' in middle
    assert 'href="three.html"' in middle


@pytest.mark.parametrize(
    ("fate", "said"), [("survives", "Why no scene notices it"), ("equivalent", "Why it changes nothing")]
)
def test_what_nothing_notices_has_its_reason_and_no_picture(fate: str, said: str, tmp_path: Path) -> None:
    bare = lesson("one", fate=fate, reason="<i>because</i>", pair=None, kills=(), entries=(), formula="")
    text = lessons.write_one(bare, COURSE, tmp_path).read_text("utf-8")
    assert said in text
    assert "&lt;i&gt;because" in text
    assert "base64" not in text
    assert "how they are written" in text
    assert "What notices it" not in text
    lessons.write([bare], COURSE, tmp_path)
    assert "no scene shows it" in (tmp_path / "index.html").read_text("utf-8")


def test_a_picture_without_numbers_is_said_to_be_one(tmp_path: Path) -> None:
    shown = lesson("one").pair
    assert shown is not None
    holed = lesson("one", pair=shown.model_copy(update={"finite": False}))
    assert "NaN" in lessons.write_one(holed, COURSE, tmp_path).read_text("utf-8")
    assert "NaN" not in lessons.write_one(lesson("one"), COURSE, tmp_path).read_text("utf-8")


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("a ball vanishes", "A ball vanishes."),
        ("nothing, while it is near", "Nothing, while it is near."),
        ("λ = -b∘v", "λ = -b∘v."),
        ("b = o - c", "b = o - c."),
        ("sqrt(D) is left out", "sqrt(D) is left out."),
    ],
)
def test_sentences_begin_with_a_capital_unless_with_a_formula(said: str, told: str) -> None:
    assert sentence(said) == told
