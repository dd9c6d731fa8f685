"""The page of a stability measurement: whole, offline, hostile names harmless."""

from __future__ import annotations

import json
import re
from importlib import resources
from pathlib import Path

import jsonschema
import pytest

from oracles.measurement import Answer, Axis, Case, Depth, Experiment, Frontier, Map, Question, Start
from reports import measured, stability
from reports.results import Machine
from reports.stability import Stability
from reports.stored import ResultsError

EVIL = "<script>alert(1)</script>\u202egnp\x1b[31m"


@pytest.fixture
def found() -> Stability:
    def frontier(method: str, precision: str, reach: float | None, is_open: bool = False) -> Frontier:
        return Frontier.model_validate(
            {
                "question": "distance",
                "method": method,
                "precision": precision,
                "reach": reach,
                "open": is_open,
                "predicted": 40.0,
                "law": "4u(D + D²/cos)",
            }
        )

    return Stability(
        suite="0",
        subject=None,
        machine=Machine(
            processor="p", cores=2, memory_gib=1.0, system="s", python="3", packages={"numpy": "2"}, lanes="NumPy"
        ),
        started="now",
        command="raycheck stability",
        seed=0,
        seconds=1.0,
        questions=(Question(name="distance", title="Hit point", unit="D", farther="up"),),
        frontiers=(
            frontier("lecture", "float32", 63.0),
            frontier("haines", "float32", 5e3),
            frontier("lecture", "float64", None),
            frontier("haines", "float64", 2e12, True),
        ),
        experiments=(
            Experiment(
                name="distance",
                title="Far and grazing",
                about="About.",
                measure="|Δλ|/r",
                precision="float32",
                x=Axis(name="D", values=(1.5, 1e4)),
                y=Axis(name="gap", values=(1.0, 1e-3)),
                cases=7,
                maps=(
                    Map(
                        method="lecture",
                        precision="float32",
                        wrong=((0.0, 0.25), (0.0, None)),
                        error=((1e-7, 2.0), (0.0, None)),
                    ),
                ),
            ),
        ),
        starts=(
            Start(
                offset="none",
                method="haines",
                precision="float32",
                distance=10.0,
                world=0.0,
                acne=0.5,
                leaks=(0.0, 0.25),
                height=0.0,
            ),
        ),
        gaps=(1e-2, 1e-3),
        depths=(
            Depth(method="lecture", precision="float32", depth=0, median=0.0, most=1e-7, largest=2e-7, visible=0.0),
            Depth(method="lecture", precision="float32", depth=1, median=0.0, most=1e-7, largest=4e-7, visible=0.0),
        ),
        depth_scene="lecture-final",
        cases=(
            Case(
                number=1,
                title="Far",
                inputs="o = 0",
                truth="1",
                slide="Refraction",
                answers=(Answer(who="lecture", got="2", right=False), Answer(who="haines", got="1", right=True)),
            ),
        ),
    )


def test_what_is_written_is_read_back_the_same(found: Stability, tmp_path: Path) -> None:
    stability.write(found, tmp_path)
    assert stability.read(tmp_path) == found
    assert (tmp_path / "index.html").read_text("utf-8") == stability.render(found)


def test_the_committed_schema_is_the_generated_one_and_accepts_the_file(found: Stability) -> None:
    committed = resources.files("reports.schema").joinpath("stability-1.json").read_text("utf-8")
    assert committed == stability.schema()
    jsonschema.Draft202012Validator(json.loads(committed)).validate(json.loads(found.model_dump_json()))


def test_the_page_shows_every_part(found: Stability) -> None:
    text = stability.render(found)
    assert "The lecture in float32: hit points good to r/1000 up to D = 63 (haines: 5,000)" in text
    assert "The lecture in float64: hit points good to r/1000 at no distance (haines: 2·10¹²)" in text
    assert "fails at once" in text
    assert "beyond 2·10¹²" in text
    assert ">25%<" in text  # a cell of wrong decisions
    assert "−7" in text  # one of errors
    assert 'class="void"' in text  # one without any
    assert "1.5, 1: 0 wrong, error 10⁻⁷" in text


def test_the_page_loads_nothing_and_runs_nothing(found: Stability) -> None:
    text = stability.render(found)
    assert not re.search(r"(src|href)=\"(?!#|data:)", text)
    assert "<script" not in text
    assert "style=" not in text  # the policy would drop it


def test_a_hostile_subject_is_text(found: Stability) -> None:
    text = stability.render(found.model_copy(update={"subject": EVIL, "command": EVIL}))
    assert "<script" not in text
    assert "&lt;script&gt;" in text
    assert "\u202e" not in text
    assert "\x1b" not in text


@pytest.mark.parametrize("content", [None, "{}", "[", '{"schema_version": 2}'])
def test_a_file_that_is_none_is_refused_by_name(content: str | None, tmp_path: Path) -> None:
    if content is not None:
        (tmp_path / stability.FILE).write_text(content)
    with pytest.raises(ResultsError, match=stability.FILE):
        stability.read(tmp_path)


@pytest.mark.parametrize(
    ("x", "text"),
    [(None, "–"), (0.0, "0"), (63.2, "63"), (6320.0, "6,300"), (1e-4, "10⁻⁴"), (2.5e12, "2.5·10¹²"), (2e-9, "2·10⁻⁹")],
)
def test_numbers_are_short(x: float | None, text: str) -> None:
    assert measured.number(x) == text


@pytest.mark.parametrize(
    ("x", "text"), [(0.0, "0"), (0.0004, "< 0.1 %"), (0.034, "3.4 %"), (0.5, "50 %"), (1.0, "100 %"), (None, "–")]
)
def test_rates_are_per_cent(x: float | None, text: str) -> None:
    assert measured.rate(x) == text


@pytest.mark.parametrize(("s", "text"), [(2e-9, "2 ns"), (3.5e-6, "3.5 µs"), (0.012, "12 ms"), (2.0, "2 s")])
def test_durations_have_their_unit(s: float, text: str) -> None:
    assert measured.duration(s) == text
