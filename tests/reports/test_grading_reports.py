"""Grading reports: what strangers wrote stays text, the numbers add up, and scripts are not needed."""

from __future__ import annotations

import csv
import html
import io
import json
import re
from pathlib import Path

import pytest

from reports import class_chart, classroom, platforms
from reports.classroom import Classroom
from reports.grades import Adjustment, Graded, GroupScore, Line, Outcome, Record, explanation

EVIL = "<script>alert(1)</script>\x1b[31m\x00\u202e{{7*7}}"


def line(counts: str = "earned", check: str = "image/background", why: str = "fine") -> Line:
    return Line.model_validate(
        {"check": check, "verdict": "pass" if counts == "earned" else "fail", "counts": counts, "why": why}
    )


def record(name: str = "alice", outcome: Outcome = "graded", earned: float = 5.0, *lines: Line) -> Record:
    groups = (
        GroupScore(name="A", points=10.0, earned=earned, lines=lines or (line(), line("lost"), line("excused"))),
        GroupScore(name="B", points=2.5, earned=0.0, lines=(line("excused"),)),
    )
    return Record(name=name, slug=re.sub(r"\W", "_", name)[:20], key="k", outcome=outcome, message="", groups=groups)


def room(*graded: Graded) -> Classroom:
    told = {"name": "class", "suite": "0", "catalogue": "c", "seed": 1, "size": "9x9"}
    return Classroom.model_validate(told | {"expected": len(graded), "graded": graded})


def test_a_groups_sum_is_told_in_words() -> None:
    first, second = record().groups
    assert first.sum_in_words == "10 × 1 of 2, 1 not counted = 5"
    assert second.sum_in_words == "nothing could be shown: 0 of 2.5, 1 not counted"


def test_points_by_hand_are_added_and_no_total_is_below_0() -> None:
    hand = (Adjustment(points=-2.0, reason="late"), Adjustment(points=0.5, reason="style"))
    assert Graded(record=record(), adjustments=hand).score == 3.5
    assert Graded(record=record(), adjustments=(Adjustment(points=-99.0, reason="copied"),)).score == 0.0
    assert "by hand: -2 (late)" in "\n".join(explanation(Graded(record=record(), adjustments=hand)))


@pytest.mark.parametrize(
    ("outcome", "earned", "band"),
    [("graded", 12.5, "full"), ("graded", 5.0, "part"), ("graded", 0.0, "none"), ("build", 0.0, "ungraded")],
)
def test_bands(outcome: Outcome, earned: float, band: str) -> None:
    assert Graded(record=record("a", outcome, earned)).band == band


def test_gradescope_and_prairielearn_say_the_same() -> None:
    graded = Graded(record=record())
    scope, lake = platforms.gradescope(graded), platforms.prairielearn(graded)
    assert scope["score"] == 5.0
    assert lake == {**lake, "gradable": True, "score": 0.4}
    assert [t["score"] for t in scope["tests"]] == [t["points"] for t in lake["tests"]] == [5.0, 0.0]
    assert [t["max_score"] for t in scope["tests"]] == [t["max_points"] for t in lake["tests"]] == [10.0, 2.5]
    formats = {scope[key] for key in ("output_format", "test_output_format", "test_name_format")}
    assert formats == {"text"}


@pytest.mark.parametrize("outcome", ["refused", "manifest", "build", "start", "protocol"])
def test_what_could_not_be_asked_is_not_gradable(outcome: Outcome) -> None:
    lake = platforms.prairielearn(Graded(record=record("a", outcome, 0.0)))
    assert (lake["gradable"], lake["score"]) == (False, 0.0)


def test_prairielearns_file_stays_below_its_limit(tmp_path: Path) -> None:
    lines = tuple(line("lost", f"image/{k}", "x" * 5000) for k in range(200))
    platforms.write(Graded(record=record("a", "graded", 0.0, *lines)), tmp_path)
    assert (tmp_path / platforms.PRAIRIELEARN).stat().st_size < platforms.MAX_BYTES
    assert json.loads((tmp_path / platforms.GRADESCOPE).read_text("utf-8"))["score"] == 0.0


def hostile() -> Graded:
    groups = (GroupScore(name="A", points=1.0, earned=0.0, lines=(line("lost", "image/background", EVIL),)),)
    return Graded(
        record=Record(
            name=EVIL,
            slug="evil",
            key="k",
            tracer=EVIL,
            outcome="build",
            message=EVIL,
            groups=groups,
            faults=(EVIL,),
            speed=1.0,
            outside=0.1,
        ),
        adjustments=(Adjustment(points=-1.0, reason=EVIL),),
    )


def test_strangers_text_stays_text_on_both_pages(tmp_path: Path) -> None:
    classroom.write(room(hostile(), Graded(record=record())), tmp_path)
    for path in (tmp_path / "index.html", tmp_path / "students" / "evil" / "index.html"):
        text = path.read_text("utf-8")
        assert "<script>alert" not in text
        assert html.escape("<script>alert(1)</script>") in text
        assert not re.search("[\x00\x1b\u202e]", text)
        assert "default-src 'none'" in html.unescape(text)
        assert "{{7*7}}" in text


def test_a_name_that_a_spreadsheet_would_run_is_quoted() -> None:
    table = classroom.table(room(Graded(record=record("=cmd|' /C calc'!A0"))))
    rows = list(csv.reader(io.StringIO(table)))
    assert rows[0] == ["submission", "score", "of", "outcome", "A", "B", "by hand"]
    assert rows[1][0].startswith("'=")
    assert rows[1][1:] == ["5", "12.5", "graded", "5", "0", "0"]


def test_the_class_page_tells_all_without_scripts() -> None:
    graded = [Graded(record=record(f"s{k}", "graded", 12.5 if k else 0.0)) for k in range(3)]
    page = classroom.overview(room(*graded))
    bare = re.sub(r"<script>.*?</script>", "", page, flags=re.DOTALL)
    for told in ("3 of 3 submissions graded", "s0", "0 of 12.5", "12.5 of 12.5", 'href="students/s1/index.html"'):
        assert told in bare
    assert bare.count('type="radio"') == 5
    assert ":has(#band-full:checked)" in bare


def test_the_distribution_counts_everyone_once() -> None:
    graded = [Graded(record=record(f"s{k}", "graded", 12.5 * k / 7)) for k in range(8)]
    assert sum(bar.count for bar in classroom.histogram(room(*graded)).bars) == 8
    assert classroom.histogram(room()).bars[0].count == 0


def timed(name: str, speed: float | None, outside: float, *faults: str) -> Graded:
    more = {"speed": speed, "outside": outside, "faults": faults}
    return Graded(record=record(name).model_copy(update=more))


def test_the_chart_has_a_dot_for_each_timed_submission_and_leads_to_it() -> None:
    told = room(timed("fast", 300.0, 0.0), timed("slow", 0.5, 0.02), timed("wrong", None, 0.9))
    page = re.sub(r"<script>.*?</script>", "", classroom.overview(told), flags=re.DOTALL)
    chart = page[page.index("Speed and accuracy") :]
    assert re.findall(r'<a href="(students/\w+/index.html)"><title>(\w+)', chart) == [
        ("students/fast/index.html", "fast"),
        ("students/slow/index.html", "slow"),
    ]
    assert "slow: 0.5× as fast, 2 % of the pixels wrong" in chart
    assert ">300×</td>" in page
    assert "Speed and accuracy" not in classroom.overview(room(timed("wrong", None, 0.9)))


def test_a_faster_and_a_more_accurate_submission_is_drawn_to_the_right_and_higher() -> None:
    dots = [
        class_chart.Dot("a", "a", 1.0, 0.5),
        class_chart.Dot("b", "b", 10.0, 0.001),
        class_chart.Dot("c", "c", 99.0, 0.0),
    ]
    found = re.findall(r'<circle cx="([\d.]+)" cy="([\d.]+)"', str(class_chart.scatter(dots)))
    across, up = ([float(pair[k]) for pair in found] for k in (0, 1))
    assert across == sorted(across)
    assert up == sorted(up, reverse=True)


def test_common_faults_are_counted_once_a_submission() -> None:
    told = room(timed("a", None, 0.0, "no-shadows", "no-shadows"), timed("b", None, 0.0, "upside-down", "no-shadows"))
    assert classroom.faults(told) == [("no-shadows", 2), ("upside-down", 1)]
    assert "Most common faults" in classroom.overview(told)


def test_a_group_that_is_left_out_does_not_count() -> None:
    away = GroupScore(name="C", points=4.0, earned=0.0, lines=(line("left out"), line("left out")))
    part = GroupScore(name="D", points=4.0, earned=4.0, lines=(line("left out"), line("earned")))
    told = record().model_copy(update={"groups": (*record().groups, away, part)})
    assert (told.points, told.earned) == (16.5, 9.0)
    assert platforms.prairielearn(Graded(record=told))["score"] == 9.0 / 16.5
    scope = platforms.gradescope(Graded(record=told))
    assert sum(test["max_score"] for test in scope["tests"]) == told.points
    assert classroom.table(room(Graded(record=told))).splitlines()[1] == "alice,9,16.5,graded,5,0,,4,0"
    assert [rate.away for rate in classroom.rates(room(Graded(record=told)))] == [3]


def test_rates_name_hidden_scenes_by_their_group() -> None:
    hidden = Graded(record=record("a", "graded", 0.0, line("lost", "image/hidden-1"), line("earned", "image/hidden-2")))
    (rate, _) = classroom.rates(room(hidden))
    assert (rate.check, rate.earned, rate.lost, rate.percent) == ("A", 1, 1, 50.0)
