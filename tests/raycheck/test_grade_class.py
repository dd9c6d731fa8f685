"""A class of known faults gets the scores that the rubric gives for them, however and how often it is graded."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

from raycheck.cli import main
from raycheck.grading.expected import Expectation
from raycheck.grading.one import Asked
from raycheck.grading.rubric import Rubric, load
from raycheck.grading.synthetic import FAULTS, RUBRIC, Member, members, write, write_quick
from raycheck.manifest import load as manifest_of
from raycheck.sandbox import OPEN
from raycheck.sandbox.census import descendants
from raycheck.sandbox.jail import missing
from reports.grades import Record

pytestmark = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")
ROOT = Path(__file__).resolve().parents[2]
ENTRY = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()"]

TOOLS = {"cpp": "make", "python": "python3", "rust": "rustc", "go": "go", "java": "javac", "javascript": "node"}


@pytest.fixture
def classroom(tmp_path: Path) -> Callable[..., Path]:
    """A folder of submissions; the rubric lies beside it."""
    (tmp_path / "rubric.toml").write_text(RUBRIC, "utf-8")

    def hand_in(*of: Member) -> Path:
        for member in of:
            write(member, tmp_path / "class")
        return tmp_path / "class"

    return hand_in


def graded(folder: Path, out: Path, *words: str) -> dict[str, Record]:
    rubric = folder.parent / "rubric.toml"
    assert main(["grade", str(folder), "--rubric", str(rubric), "--out", str(out), "--seed", "5", *words]) == 0
    records = [Record.model_validate_json(path.read_bytes()) for path in (out / "records").iterdir()]
    return {record.name: record for record in records}


@pytest.mark.parametrize("language", TOOLS)
def test_known_faults_cost_what_the_rubric_says(classroom: Callable[..., Path], tmp_path: Path, language: str) -> None:
    if not shutil.which(TOOLS[language]):
        pytest.skip(f"{TOOLS[language]} is needed to build this example")
    k = list(TOOLS).index(language)
    chosen = [Member(language, (FAULTS[k],)), Member(language, (FAULTS[(k + 1) % 6], FAULTS[(k + 3) % 6]))]
    folder = classroom(*chosen)
    records = graded(folder, tmp_path / "out")
    expected = Expectation(Asked(load(tmp_path / "rubric.toml"), 5, tmp_path / "out", OPEN))
    for member in chosen:
        precision = manifest_of(folder / member.name).precision
        record = records[member.name]
        assert record.outcome == "graded", record.message
        assert [group.earned for group in record.groups] == expected.points(member, precision)
        assert record.earned < record.points


def test_every_fault_costs_something_and_none_costs_everything() -> None:
    rubric = Rubric.model_validate(tomllib.loads(RUBRIC))
    expected = Expectation(Asked(rubric, 7, Path(), OPEN))
    for fault in FAULTS:
        assert 0.0 < sum(expected.points(Member("cpp", (fault,)), "float32")) < 40.0
    assert expected.points(Member("cpp", ()), "float32") == [8.0, 12.0, 20.0]


def test_every_member_of_the_synthetic_class_can_be_written(tmp_path: Path) -> None:
    everyone = members(60)
    assert len({write(member, tmp_path).name for member in everyone}) == 60


def bytes_of(out: Path) -> dict[str, bytes]:
    kept = [out / "grades.csv", out / "index.html", *sorted((out / "records").iterdir())]
    return {path.name: path.read_bytes() for path in kept}


def test_scores_are_the_same_whatever_the_number_of_jobs(tmp_path: Path) -> None:
    folder = write_quick(tmp_path, 8)
    graded(folder, tmp_path / "one")
    graded(folder, tmp_path / "two", "--jobs", "2")
    assert bytes_of(tmp_path / "one") == bytes_of(tmp_path / "two")
    assert (tmp_path / "one" / "grades.csv").read_text("utf-8").count(",3,5,graded,3,0,0") == 5


def test_kill_9_at_random_moments_loses_nothing(tmp_path: Path) -> None:
    folder = write_quick(tmp_path, 16)
    words = ["--rubric", str(tmp_path / "rubric.toml"), "--seed", "5", "--jobs", "2"]
    draw = random.Random(11)  # noqa: S311
    kills = 0

    def records() -> list[Path]:
        return list((tmp_path / "killed" / "records").glob("*.json"))

    for _ in range(6):
        run = subprocess.Popen(
            [*ENTRY, "grade", str(folder), "--out", str(tmp_path / "killed"), *words],
            env=os.environ | {"PYTHONPATH": str(ROOT), "TMPDIR": str(tmp_path)},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        )
        enough = len(records()) + draw.randint(0, 2)
        while run.poll() is None and len(records()) < enough:
            time.sleep(0.001)
        time.sleep(draw.uniform(0.0, 0.2))
        below = descendants(run.pid)
        kills += run.poll() is None
        run.send_signal(signal.SIGKILL)
        run.communicate()
        until = time.monotonic() + 60.0
        while any(Path(f"/proc/{pid}").exists() for pid in below) and time.monotonic() < until:
            time.sleep(0.02)
        assert [pid for pid in below if Path(f"/proc/{pid}").exists()] == [], "a process outlived its killed parent"
        for path in records():
            Record.model_validate_json(path.read_bytes())
    assert kills >= 3
    graded(folder, tmp_path / "killed", "--jobs", "2")
    graded(folder, tmp_path / "whole", "--jobs", "2")
    assert bytes_of(tmp_path / "killed") == bytes_of(tmp_path / "whole")


def test_a_second_run_asks_nothing_and_a_changed_submission_is_asked_again(tmp_path: Path) -> None:
    folder = write_quick(tmp_path, 3)
    graded(folder, tmp_path / "out")
    times = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out" / "records").iterdir()}
    (folder / "student-01" / "tracer.py").write_text("raise SystemExit(3)", "utf-8")
    records = graded(folder, tmp_path / "out")
    again = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out" / "records").iterdir()}
    assert {name for name in times if times[name] != again[name]} == {"student-01.json"}
    assert records["student-01"].outcome == "protocol"


def test_only_and_rerun_failed_choose(tmp_path: Path) -> None:
    folder = write_quick(tmp_path, 3)
    assert set(graded(folder, tmp_path / "out", "--only", "student-01")) == {"student-01"}
    (folder / "student-02" / "tracer.py").write_text("raise SystemExit(3)", "utf-8")
    graded(folder, tmp_path / "out")
    times = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out" / "records").iterdir()}
    graded(folder, tmp_path / "out", "--rerun-failed")
    again = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out" / "records").iterdir()}
    assert {name for name in times if times[name] != again[name]} == {"student-02.json"}
