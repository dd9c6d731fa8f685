"""The page of a chart: every point a dot, a row and a line."""

from __future__ import annotations

import json
import re
from importlib import resources
from pathlib import Path

import jsonschema
import pytest

from oracles.measurement import Panel, Point
from reports import chart, scatter
from reports.chart import Chart
from reports.drawings import LogScale, spread, tag
from reports.results import Machine
from reports.stored import ResultsError

EVIL = '<script>alert(1)</script>"\u202e'


def point(name: str, seconds: float, error: float | None, **more: object) -> Point:
    values: dict[str, object] = {
        "panel": "near",
        "name": name,
        "kind": "NumPy float64",
        "precision": "float64",
        "seconds": seconds,
        "spread": (seconds, 1.1 * seconds, 1.3 * seconds),
        "ratio": 1.0,
        "error": error,
        "bits": 40.0,
        "wrong": 0.0,
        "baseline": False,
        "frontier": False,
    }
    return Point.model_validate(values | more)


@pytest.fixture
def found() -> Chart:
    return Chart(
        suite="0",
        subject="Team 7",
        machine=Machine(processor="p", cores=2, memory_gib=1.0, system="s", python="3", packages={}, lanes="NumPy"),
        started="now",
        command="raycheck chart",
        seed=0,
        seconds=1.0,
        panels=(
            Panel(name="near", title="Ordinary", about="About.", per="one ray", measure="|Δλ|/r", tolerance=1e-3),
            Panel(name="empty", title="Nothing", about="About.", per="one ray", measure="|Δλ|/r", tolerance=1e-3),
        ),
        points=(
            point("lecture", 1e-9, 1e-7, baseline=True, frontier=True),
            point("haines", 2e-9, 1e-9, frontier=True, kind="DrJit float64"),
            point("slow", 5e-6, 3e-9, kind="Python"),
            point("wrong", 1e-10, 2.0, wrong=0.25, precision="float32", kind="NumPy float32"),
            point("proved", 1e-5, 1e-37, frontier=True, kind="arb, 128 bits"),
            point("lost", 1e-9, None),
        ),
        remarks=("Team 8: crash",),
    )


def test_what_is_written_is_read_back_the_same(found: Chart, tmp_path: Path) -> None:
    chart.write(found, tmp_path)
    assert chart.read(tmp_path) == found


def test_every_point_is_a_line_of_the_json(found: Chart) -> None:
    lines = [line for line in chart.text(found).splitlines() if '"panel":"near"' in line]
    assert [json.loads(line.strip().rstrip(","))["name"] for line in lines] == [p.name for p in found.points]


def test_the_committed_schema_is_the_generated_one_and_accepts_the_file(found: Chart) -> None:
    committed = resources.files("reports.schema").joinpath("chart-1.json").read_text("utf-8")
    assert committed == chart.schema()
    jsonschema.Draft202012Validator(json.loads(committed)).validate(json.loads(chart.text(found)))


def test_every_point_is_a_row_and_every_one_with_an_error_a_dot(found: Chart) -> None:
    text = chart.render(found)
    for p in found.points:
        assert re.search(rf'<th scope="row">{p.name}\b', text)
        assert (f"<title>{p.name}," in text) == (p.error is not None)


def test_wrong_points_are_hollow_right_ones_full_and_the_baseline_has_a_ring(found: Chart) -> None:
    text = str(scatter.scatter(found.panels[0], found.points))
    dots = dict(re.findall(r"<title>(\w+),[^<]*</title>(.*?)</g>", text))
    assert {name for name, dot in dots.items() if "hollow" in dot} == {"wrong"}
    assert {name for name, dot in dots.items() if "ring" in dot} == {"lecture"}
    assert {name for name, dot in dots.items() if "arrow" in dot} == {"proved"}


def test_the_frontier_is_a_stepped_line_through_its_points(found: Chart) -> None:
    text = str(scatter.scatter(found.panels[0], found.points))
    (path,) = re.findall(r'<path d="([^"]*)" class="pareto">', text)
    assert re.fullmatch(r"M[\d.]+ [\d.]+( H[\d.]+ V[\d.]+){3} H[\d.]+", path)


def test_the_page_loads_nothing_and_runs_nothing(found: Chart) -> None:
    text = chart.render(found)
    assert not re.search(r"(src|href)=\"(?!#|data:)", text)
    assert "<script" not in text
    assert "style=" not in text


def test_hostile_names_are_text(found: Chart) -> None:
    evil = found.model_copy(
        update={
            "points": (point(EVIL, 1e-9, 1e-7, kind=EVIL, frontier=True), point("b", 1e-8, 1e-9)),
            "remarks": (EVIL,),
            "subject": EVIL,
        }
    )
    text = chart.render(evil)
    assert "<script" not in text
    assert "\u202e" not in text


@pytest.mark.parametrize("content", [None, "{}", "[", '{"schema_version": 2}'])
def test_a_file_that_is_none_is_refused_by_name(content: str | None, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / chart.FILE).write_text(content)
    with pytest.raises(ResultsError, match=chart.FILE):
        chart.read(tmp_path)


def test_a_log_scale_puts_the_middle_decade_in_the_middle() -> None:
    scale = LogScale(1e-4, 1e4, 0.0, 80.0)
    assert [scale(x) for x in (1e-9, 1e-4, 1.0, 1e4, 1e9)] == [0.0, 0.0, 40.0, 80.0, 80.0]
    assert scale.decades(3) == pytest.approx([1e-4, 1e-1, 1e2], rel=4 * 2.0**-53, abs=0.0)  # powers of ten


def test_labels_are_moved_apart() -> None:
    assert [y for y, *_ in spread([(1.0, "a", ""), (2.0, "b", ""), (50.0, "c", "")], 10.0)] == [1.0, 11.0, 50.0]


def test_everything_in_a_drawing_is_escaped() -> None:
    assert str(tag("text", "<b>", class_='"x')) == '<text class="&#34;x">&lt;b&gt;</text>'
