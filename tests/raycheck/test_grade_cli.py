"""raycheck grade as it is called: what it refuses, what it says, what it writes."""

from __future__ import annotations

import json
import os
import re
import stat
import subprocess
import sys
import time
import tomllib
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from oracles.verdict import Judged, Pixel, Process, Verdict
from raycheck.errors import RaycheckError
from raycheck.grading import one, rubric
from raycheck.grading.one import Asked, veiled
from raycheck.grading.pool import Processes
from raycheck.grading.submissions import Submission, found, slug
from raycheck.sandbox import OPEN, jail
from raycheck.sandbox.cgroup import cgroup
from raycheck.sandbox.jail import missing
from raycheck.sandbox.limits import Limits
from reports.grades import Record

ROOT = Path(__file__).resolve().parents[2]
needs_a_sandbox = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")

ONE = 'name = "one"\n[[group]]\nname = "a"\npoints = 3\nrungs = ["background"]\n'
RIGHT = """
with open(image, "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *background) * (width * height))
"""


@pytest.fixture
def team(attached: Callable[..., Path], tmp_path: Path) -> Path:
    """A folder of one submission that passes the first rung, and a rubric of that rung."""
    attached(RIGHT, name="class/alice")
    toml = tmp_path / "class" / "alice" / "raycheck.toml"
    toml.write_text(toml.read_text("utf-8").replace(sys.executable, "python3"), "utf-8")
    (tmp_path / "one.toml").write_text(ONE, "utf-8")
    return tmp_path / "class"


def graded(raycheck: Callable[..., Any], team: Path, *words: object) -> Any:
    base = ("--rubric", team.parent / "one.toml", "--out", team.parent / "out")
    return raycheck("grade", team, *base, *words)


@needs_a_sandbox
def test_a_class_is_graded_and_told(raycheck: Callable[..., Any], team: Path, tmp_path: Path) -> None:
    (tmp_path / "late.csv").write_text("submission,points,reason\nalice,-1,one day late\n", "utf-8")
    told = graded(raycheck, team, "--adjust", tmp_path / "late.csv")
    assert (told.code, "2 of 3" in told.out) == (0, True), told.err
    assert (tmp_path / "out" / "grades.csv").read_text("utf-8") == (
        "submission,score,of,outcome,a,by hand\nalice,2,3,graded,3,-1\n"
    )
    explained = graded(raycheck, team, "--explain", "alice").out
    assert "earned   image/background: pass" in explained
    seed = json.loads((tmp_path / "out" / "run.json").read_text("utf-8"))["seed"]
    assert graded(raycheck, team).code == 0
    assert json.loads((tmp_path / "out" / "run.json").read_text("utf-8"))["seed"] == seed


def test_without_a_sandbox_it_refuses_unless_the_code_is_trusted(
    raycheck: Callable[..., Any], team: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(jail, "missing", lambda: "bwrap is not installed")
    told = graded(raycheck, team)
    assert (told.code, "no sandbox: bwrap is not installed" in told.err) == (3, True)
    assert raycheck("check", team / "alice", "--sandbox").code == 3
    told = graded(raycheck, team, "--i-trust-this-code")
    assert (told.code, "with your rights" in told.err) == (0, True)
    record = team.parent / "out" / "records" / "alice.json"
    before = record.stat().st_mtime_ns
    assert graded(raycheck, team, "--i-trust-this-code").code == 0
    assert record.stat().st_mtime_ns == before


REFUSED = {
    "unknown rung": (ONE.replace("background", "backgruond"), "no rung is called"),
    "rung twice": (ONE.replace('["background"]', '["background", "background"]'), "counted twice"),
    "unknown key": (ONE + "diagnosis = 3\n", "diagnosis"),
    "negative points": (ONE.replace("3", "-3"), "points"),
    "infinite points": (ONE.replace("3", "inf"), "points"),
    "no groups": ('name = "x"', "group"),
    "an empty group": (ONE.replace('rungs = ["background"]', ""), "no rungs, laws, stability or speed"),
    "unknown law": (ONE + 'laws = ["spere"]\n', "no such law"),
    "law twice": (
        ONE + 'laws = ["reflect", "reflect/unit"]\n[[group]]\nname="b"\npoints=1\nlaws=["reflect/unit"]',
        "twice",
    ),
    "unknown question": (ONE + 'stability = [{question = "far", float32 = 1, float64 = 1}]', "question"),
    "stability at one precision": (ONE + 'stability = [{question = "distance", float32 = 9}]', "float64"),
    "speed of nothing": (ONE + "speed = [0]", "speed"),
    "unknown word": (ONE + 'unsupported = "free"', "unsupported"),
    "not toml": ("= = =", "not TOML"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_wrong_rubric_is_refused_by_key(raycheck: Callable[..., Any], team: Path, name: str) -> None:
    text, message = REFUSED[name]
    (team.parent / "one.toml").write_text(text, "utf-8")
    told = graded(raycheck, team)
    assert (told.code, message in told.err) == (2, True), told.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name,points,reason\n", "line 1"),
        ("submission,points,reason\nbob,-1,late\n", "no submission is called 'bob'"),
        ("submission,points,reason\nalice,much,late\n", "'much'"),
        ("submission,points,reason\nalice,nan,late\n", "'nan'"),
        ("submission,points,reason\nalice,-1\n", "2 values"),
    ],
)
def test_a_wrong_line_of_points_by_hand_is_refused(
    raycheck: Callable[..., Any], team: Path, tmp_path: Path, text: str, message: str
) -> None:
    (tmp_path / "late.csv").write_text(text, "utf-8")
    told = graded(raycheck, team, "--adjust", tmp_path / "late.csv")
    assert (told.code, message in told.err) == (2, True), told.err


@pytest.mark.parametrize(
    ("words", "message"),
    [(["--only", "bob"], "bob"), (["--explain", "bob"], "bob"), (["--jobs", "0"], "--jobs 0")],
)
def test_a_wrong_call_is_refused(raycheck: Callable[..., Any], team: Path, words: list[str], message: str) -> None:
    told = graded(raycheck, team, "--i-trust-this-code", *words)
    assert (told.code, message in told.err) == (2, True), told.err


def test_folders_that_are_not_there_or_empty_are_refused(raycheck: Callable[..., Any], tmp_path: Path) -> None:
    for folder in (tmp_path / "none", tmp_path):
        assert raycheck("grade", folder, "--out", tmp_path / "out").code == 2
    assert raycheck("grade").code == 2


def test_the_rubric_that_ships_asks_every_rung_for_100_points() -> None:
    shipped = rubric.load(None)
    assert len(shipped.rungs) == 46
    assert sum(group.points for group in shipped.group) + (shipped.hidden.points if shipped.hidden else 0) == 100


def test_the_rubric_in_the_docs_is_one() -> None:
    page = (ROOT / "docs" / "grading.md").read_text("utf-8")
    (text,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    told = rubric.Rubric.model_validate(tomllib.loads(text))
    assert told.rungs
    assert told.laws
    assert told.reaches
    assert told.speeds


def test_no_two_names_share_a_file_and_none_leaves_its_folder() -> None:
    names = ["a", "A", "a b", "a_b", "../x", "..", ".hidden", "x" * 300, "<script>", "ä", "con\n", "a\x1b"]
    slugs = [slug(name) for name in names]
    assert len({s.lower() for s in slugs}) == len(names)
    assert all(s.strip(".") and "/" not in s and len(s) < 80 and s.isascii() for s in slugs)


def test_submissions_are_folders_and_archives_by_name(tmp_path: Path) -> None:
    for name in ("b", "c", ".git"):
        (tmp_path / name).mkdir()
    for name in ("a.tar.gz", "c.zip", "readme.txt"):
        (tmp_path / name).touch()
    assert [s.name for s in found(tmp_path)] == ["a", "b", "c", "c.zip"]


def test_a_hidden_scene_tells_its_author_no_value_and_nothing_printed() -> None:
    worst = Pixel(i=1, j=1, channel="red", expected=0.123, tolerance=0.0, got=1.0, excess=1.0)
    judged = Judged(pixels=1, outside=1, decided=1, tolerance_median=0, tolerance_99=0, tolerance_worst=0, worst=worst)
    process = Process(command=("x",), status="exit status 3", seconds=0.1, output_tail="sphere 1 2 3")
    for word in ("fail", "error", "crash"):
        verdict = Verdict(
            check="image/hidden-1",
            verdict=word,
            message="expected 0.123",
            judged=judged,
            process=process,  # type: ignore[arg-type]
        )
        shown = veiled(verdict).model_dump_json()
        assert "sphere 1 2 3" not in shown
        assert word == "crash" or "0.123" not in shown


def test_a_run_of_another_seed_asks_other_sizes_and_scenes(tmp_path: Path) -> None:
    asked = [Asked(rubric.load(None), seed, tmp_path, OPEN) for seed in range(20)]
    assert len({one.size for one in asked}) > 10
    assert len({one.hidden[0].scene().content_hash() for one in asked}) == 20
    assert len({one.key("content") for one in asked}) == 20


def dies_once(asked: Asked, submission: Submission, again: bool) -> Record:
    """A worker that is killed by its first task."""
    mark = asked.out / "died"
    if not mark.exists():
        mark.touch()
        os._exit(9)
    return Record(name=submission.name, slug=submission.slug, key="k", outcome="graded", groups=())


def dies(asked: Asked, submission: Submission, again: bool) -> Record:
    os._exit(9)


def test_what_a_lost_worker_had_is_graded_by_another(tmp_path: Path) -> None:
    asked = Asked(rubric.load(None), 1, tmp_path, OPEN)
    submissions = [Submission(f"s{k}", f"s{k}", tmp_path) for k in range(5)]
    records = list(Processes(2, dies_once).records(asked, submissions, False))
    assert sorted(record.name for record in records) == ["s0", "s1", "s2", "s3", "s4"]
    with pytest.raises(RaycheckError, match="workers died 3 times"):
        list(Processes(2, dies).records(asked, submissions, False))


def test_a_record_is_whole_or_not_there_when_the_disk_is_full(
    raycheck: Callable[..., Any], team: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(one.grades, "write", full)
    told = graded(raycheck, team, "--i-trust-this-code")
    assert (told.code, "No space left on device" in told.err) == (2, True)
    assert list((tmp_path / "out" / "records").iterdir()) == []
    monkeypatch.undo()
    assert graded(raycheck, team, "--i-trust-this-code").code == 0


def test_a_control_group_of_version_2_has_its_limits_and_goes_away(tmp_path: Path) -> None:
    (tmp_path / "cgroup.controllers").write_text("memory pids", "utf-8")
    with cgroup(Limits(memory=1, processes=2), tmp_path) as group:
        assert group is None  # a folder that is no control group: the kernel's files are not there
    assert [p.name for p in tmp_path.iterdir()] == ["cgroup.controllers"]


@needs_a_sandbox
def test_the_gradescope_bundle_grades_as_its_container_would(
    raycheck: Callable[..., Any], team: Path, tmp_path: Path
) -> None:
    bundle = tmp_path / "autograder.zip"
    assert raycheck("grade", "--rubric", tmp_path / "one.toml", "--gradescope-bundle", bundle).code == 0
    with zipfile.ZipFile(bundle) as packed:
        assert packed.namelist() == ["setup.sh", "run_autograder", "rubric.toml"]
        assert all(entry.external_attr >> 16 & stat.S_IXUSR for entry in packed.infolist()[:2])
        packed.extractall(tmp_path / "autograder" / "source")
    (team / "alice").rename(tmp_path / "autograder" / "submission")
    command = tmp_path / "raycheck"
    command.write_text(f'#!/bin/sh\nexec {sys.executable} -P -c "from raycheck.cli import entry; entry()" "$@"\n')
    command.chmod(0o755)
    environment = {"AUTOGRADER_ROOT": str(tmp_path / "autograder"), "RAYCHECK": str(command), "PYTHONPATH": str(ROOT)}
    script = tmp_path / "autograder" / "source" / "run_autograder"
    for rubric_text, score in ((ONE, 3.0), ("= = =", 0)):
        (tmp_path / "autograder" / "source" / "rubric.toml").write_text(rubric_text, "utf-8")
        subprocess.run(["sh", script], env=os.environ | environment, check=True, stdout=subprocess.DEVNULL)
        told = json.loads((tmp_path / "autograder" / "results" / "results.json").read_text("utf-8"))
        assert told["score"] == score


@needs_a_sandbox
def test_a_cluster_gives_the_same_grades_and_survives_a_lost_worker(
    raycheck: Callable[..., Any], team: Path, tmp_path: Path
) -> None:
    pytest.importorskip("distributed", reason="dask.distributed is needed: pip install 'raycheck[cluster]'")
    for k in range(6):
        subprocess.run(["cp", "-R", str(team / "alice"), str(team / f"student-{k}")], check=True)
    meeting = tmp_path / "scheduler.json"  # the scheduler picks its port and tells it there
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    quiet: dict[str, Any] = {"env": environment, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    python = [sys.executable, "-P", "-m"]
    common = ["--no-dashboard", "--scheduler-file", str(meeting)]
    started = [
        subprocess.Popen(
            [*python, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", *common], **quiet
        )
    ]
    worker = ["--nthreads", "2", "--no-nanny", "--local-directory", str(tmp_path / "workers"), *common]
    started += [subprocess.Popen([*python, "distributed.cli.dask_worker", *worker], **quiet) for _ in range(2)]
    try:
        words = ["grade", str(team), "--rubric", str(tmp_path / "one.toml"), "--seed", "4"]
        call = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()", *words]
        while not meeting.exists():
            assert started[0].poll() is None
            time.sleep(0.02)
        address = json.loads(meeting.read_text("utf-8"))["address"]
        run = subprocess.Popen([*call, "--out", str(tmp_path / "far"), "--cluster", address], **quiet)
        while run.poll() is None and not list((tmp_path / "far").glob("records/*.json")):
            time.sleep(0.005)
        started[1].kill()
        assert run.wait(timeout=500) == 0
    finally:
        for process in started:
            process.kill()
            process.wait()
    assert raycheck(*words, "--out", tmp_path / "near").code == 0
    for name in ("grades.csv", "index.html"):
        assert (tmp_path / "far" / name).read_bytes() == (tmp_path / "near" / name).read_bytes()


def test_no_cluster_at_an_address_is_said(raycheck: Callable[..., Any], team: Path, monkeypatch: Any) -> None:
    pytest.importorskip("distributed", reason="dask.distributed is needed: pip install 'raycheck[cluster]'")
    monkeypatch.setattr("raycheck.grading.cluster.CONNECT", 0.5)
    told = graded(raycheck, team, "--i-trust-this-code", "--cluster", "tcp://127.0.0.1:1")
    assert (told.code, "no cluster at tcp://127.0.0.1:1" in told.err) == (3, True)
