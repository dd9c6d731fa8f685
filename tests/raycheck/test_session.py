"""What a run leaves behind: results, pages, and a line that asks again."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import jsonschema
import pytest

import reports
import scenes.catalogue
from raycheck import session
from raycheck.subjects.command import CommandSubject
from reports import results
from reports.results import Results

ROOT = Path(scenes.catalogue.__file__).parents[2]
SCHEMA = Path(reports.__file__).parent / "schema" / "results-1.json"
Attached = Callable[..., Path]
Check = Callable[..., Results]

BLACK = "write(image, width, height)"


def told(folder: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((folder / "results.json").read_text("utf-8"))
    return data


def test_results_are_valid_by_the_published_schema(attached: Attached, check: Check, tmp_path: Path) -> None:
    check(attached(BLACK, 'features = ["plane", "shadow"]'), "--size", "16x12")
    data = told(tmp_path / "report")
    jsonschema.validate(data, json.loads(SCHEMA.read_text("utf-8")))
    assert data["complete"] is True
    assert data["planned"] == len(data["verdicts"])


def without_durations(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: without_durations(value) for key, value in data.items() if key not in ("seconds", "started")}
    if isinstance(data, list):
        return [without_durations(entry) for entry in data]
    return data


def test_two_runs_give_the_same_results_durations_aside(attached: Attached, check: Check, tmp_path: Path) -> None:
    folder = attached(BLACK + "\nprint(scene, image)\nif 'sphere' in scene: sys.exit(scene)")
    seen = []
    for _ in range(2):
        check(folder, "--size", "16x12", "--no-block", "--no-shrink")  # a search may end by the clock
        pictures = {p.name: p.read_bytes() for p in (tmp_path / "report" / "images").iterdir()}
        seen.append((without_durations(told(tmp_path / "report")), pictures))
    assert seen[0] == seen[1]


def test_every_picture_that_a_verdict_names_is_there(attached: Attached, check: Check, tmp_path: Path) -> None:
    found = check(attached(BLACK), "--size", "16x12", "--no-block")
    rungs = [v for v in found.verdicts if v.check.startswith("image/") and v.verdict != "unsupported"]
    named = [p for v in rungs for p in v.pictures.model_dump().values() if p]
    assert len(named) == 3 * len(rungs)
    for name in named:
        assert (tmp_path / "report" / name).read_bytes().startswith(b"\x89PNG")


def test_an_interrupt_leaves_valid_results_the_finished_verdicts_and_the_page(
    attached: Attached, tmp_path: Path
) -> None:
    body = """
import pathlib, time
write(image, width, height)
if words["raycheck"][1] == "headlight-sphere":
    pathlib.Path("reached").write_text(str(__import__("os").getpid()))
    time.sleep(600)
"""
    folder, out = attached(body), tmp_path / "report"
    for number in (signal.SIGINT, signal.SIGTERM):
        (folder / "reached").unlink(missing_ok=True)
        entry = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()"]
        words = ["check", str(folder), "--no-block", "--size", "16x12", "--out", str(out)]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        run = subprocess.Popen([*entry, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
        deadline = time.monotonic() + 300
        while not (folder / "reached").exists() or not (folder / "reached").read_text():
            assert time.monotonic() < deadline, "the slow scene was never reached"
            time.sleep(0.02)
        tracer = int((folder / "reached").read_text())
        run.send_signal(number)
        said, _ = run.communicate(timeout=300)
        assert run.returncode == 130, said.decode()
        assert b"interrupted" in said
        data = told(out)
        jsonschema.validate(data, json.loads(SCHEMA.read_text("utf-8")))
        assert data["complete"] is False
        assert [v["check"] for v in data["verdicts"]] == ["image/background", "image/headlight-plane"]
        assert data["planned"] > 2
        assert "was interrupted after 2 of" in (out / "index.html").read_text("utf-8")
        assert (out / "junit.xml").exists()
        assert ended(tracer)


def ended(pid: int) -> bool:
    for _ in range(6000):
        try:
            if Path(f"/proc/{pid}/stat").read_text("utf-8").rsplit(")", 1)[1].split()[0] in "ZX":
                return True
        except (FileNotFoundError, ProcessLookupError):
            return True
        time.sleep(0.01)
    return False


AWKWARD = ("two words", "quo'te", 'dou"ble', "$HOME", "`id`", "back\\slash", "{width}", "{}", "{scene", "*")
AWKWARD += ("ü→λ", "-x", "", "a\nb", "#", "~", "!!", "%s", "--scenes")


def repeated(line: str, raycheck: Callable[..., Any], out: Path) -> Results:
    """What the reproduce line gives, typed into a shell (whose words shlex splits) with another --out."""
    program, command, *words = shlex.split(line)
    assert (program, command) == ("raycheck", "check")
    raycheck(command, "--out", out, *words)
    return results.read(out)


def judgement(verdict: Any) -> dict[str, Any]:
    """All but what names the report's own folder: the shrunk scene and its lines."""
    stripped: dict[str, Any] = without_durations(verdict.model_dump(mode="json", exclude={"shrunk"}))
    return stripped


def test_the_reproduce_line_of_a_folder_gives_the_same_verdict(
    attached: Attached, check: Check, raycheck: Callable[..., Any], tmp_path: Path
) -> None:
    folder = attached(BLACK, name="team {7} $x 'y'")
    words = ("--size", "16x12", "--seed", "5", "--no-block", "--scenes", "background,headlight-plane,glass-sphere")
    found = check(folder, *words)
    for verdict in found.verdicts:
        again = repeated(verdict.reproduce, raycheck, tmp_path / "again")
        assert [judgement(v) for v in again.verdicts] == [judgement(verdict)]
        assert (again.seed, again.size) == (5, "16x12")


def test_the_reproduce_line_of_a_command_gives_the_same_verdict_whatever_its_arguments(
    check: Check, raycheck: Callable[..., Any], tmp_path: Path
) -> None:
    program = tmp_path / "say it.py"
    program.write_text("import sys; sys.exit(ascii(sys.argv[1:-2]))", "utf-8")
    command = [sys.executable, "-S", program, *AWKWARD, "{scene}", "{image}"]
    options = ("--scene", "json", "--image", "png", "--precision", "float64", "--size", "16x12")
    found = check(*options, "--scenes", "headlight-sphere", "--", *command)
    (verdict,) = found.verdicts
    assert verdict.verdict == "error"
    assert "two words" in verdict.message
    again = repeated(verdict.reproduce, raycheck, tmp_path / "again")
    assert [judgement(v) for v in again.verdicts] == [judgement(verdict)]
    told_again = (again.subject.precision, again.subject.scene, again.subject.image)
    assert told_again == ("float64", "json", "png")


def test_the_reproduce_line_works_in_a_real_shell(check: Check, tmp_path: Path) -> None:
    program = tmp_path / "say.py"
    program.write_text("import sys; sys.exit(ascii(sys.argv[1:-2]))", "utf-8")
    found = check("--scenes", "background", "--", sys.executable, "-S", program, *AWKWARD, "{scene}", "{image}")
    (tmp_path / "bin").mkdir()
    wrapper = tmp_path / "bin" / "raycheck"
    wrapper.write_text(f'#!/bin/sh\nexec {sys.executable} -P -c "from raycheck.cli import entry; entry()" "$@"\n')
    wrapper.chmod(0o755)
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PATH": f"{wrapper.parent}:{os.environ['PATH']}"}
    line = found.verdicts[0].reproduce
    done = subprocess.run(["sh", "-c", line], cwd=tmp_path, env=environment, capture_output=True, check=False)
    assert done.returncode == 1, done.stderr.decode()
    again = results.read(tmp_path / "raycheck-report")
    assert again.verdicts[0].message == found.verdicts[0].message


def test_the_reproduce_line_keeps_the_known_failures(
    check: Check, attached: Attached, raycheck: Callable[..., Any], tmp_path: Path
) -> None:
    path = tmp_path / "known list.toml"
    path.write_text('[[known]]\ncheck = "image/headlight-plane"\nreason = "r"\nurl = "u"\n')
    found = check(attached(BLACK), "--size", "16x12", "--scenes", "headlight-plane", "--known", path)
    again = repeated(found.verdicts[0].reproduce, raycheck, tmp_path / "again")
    assert [v.verdict for v in again.verdicts] == ["known"]


def test_the_command_in_the_results_is_the_one_that_was_typed(check: Check, attached: Attached, tmp_path: Path) -> None:
    folder = attached(BLACK, name="two words")
    found = check(folder, "--scenes", "background")
    expected = ["raycheck", "check", "--out", str(tmp_path / "report"), str(folder), "--scenes", "background"]
    assert shlex.split(found.command) == expected


def test_a_smoke_run_shows_what_went_out_and_what_came_back(attached: Attached, raycheck: Callable[..., Any]) -> None:
    said = raycheck("smoke", attached("print('hello from the tracer'); " + BLACK))
    assert said.code == 1
    for part in ("# tracer: Team 7", "raycheck 1 pixel-centre", "exit status 0", "hello from the tracer", "40x30"):
        assert part in said.out
    assert re.search(r"# verdict: fail: \d+ of 1200 pixels", said.out)


def test_a_smoke_run_of_a_tracer_that_dies_says_how(attached: Attached, raycheck: Callable[..., Any]) -> None:
    said = raycheck("smoke", attached("print('until here', flush=True)\nimport os; os.abort()"))
    assert said.code == 1
    assert "# it ended: killed by SIGABRT" in said.out
    assert "# verdict: crash" in said.out
    assert "until here" in said.out


def test_a_smoke_run_of_a_folder_of_pictures_looks_at_its_picture(raycheck: Callable[..., Any], tmp_path: Path) -> None:
    assert raycheck("render", "pixel-centre", tmp_path / "pixel-centre.png").code == 0
    assert raycheck("smoke", f"images:{tmp_path}").code == 0


def test_a_smoke_run_of_the_reference_passes(raycheck: Callable[..., Any]) -> None:
    assert raycheck("smoke", "builtin:reference").code == 0


def test_no_file_of_the_exchange_is_left_in_the_temporary_folder(
    attached: Attached, check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tempfile

    room = tmp_path / "tmp"
    room.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(room))
    body = "import os\nos.chdir(os.path.dirname(image))\nfor _ in range(1200): os.mkdir('d'); os.chdir('d')"
    found = check(attached(body), "--scenes", "background")
    assert found.verdicts[0].verdict == "invalid"
    assert list(room.iterdir()) == []


def test_a_command_subject_fills_in_no_placeholder_of_a_placeholder() -> None:
    """The words are the user's: a path that happens to hold {seed} stays as it is only where it is not a word."""
    from raycheck.manifest import Manifest
    from scenes.catalogue import rung

    manifest = Manifest(name="x", render=("a", "{scene}{image}", "{width}", "{height}", "{seed}"))
    subject = CommandSubject(Path("."), manifest, "")
    words = subject.arguments(rung("background").scene(), Path("/s"), Path("/i"), 3)
    scene = rung("background").scene()
    assert words == ["a", "/s/i", str(scene.image.width), str(scene.image.height), "3"]


def test_processes_that_make_the_same_folder_do_not_stumble_over_one_another(tmp_path: Path) -> None:
    folder = tmp_path / "shared"
    with ThreadPoolExecutor(8) as pool:  # raises what any of them raised
        list(pool.map(lambda _: session.make_folder(folder), range(800)))
    assert not list(folder.iterdir())
