"""The command line: exit codes, misuse, help, pipes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import raycheck.cli
from raycheck import VERSION, suite
from raycheck.commands import scenes as scenes_command
from raycheck.sandbox import jail
from reports import results
from scenes.catalogue import ladder

ROOT = Path(raycheck.cli.__file__).parents[1]
ENTRY = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()"]
COMMANDS = (
    "demo",
    "check",
    "smoke",
    "render",
    "golden",
    "compare",
    "peers",
    "scenes",
    "stability",
    "chart",
    "needs",
    "grade",
    "faults",
    "power",
    "init",
    "report",
    "doctor",
)

Raycheck = Callable[..., Any]


def outside(*words: object, **options: Any) -> subprocess.CompletedProcess[str]:
    """`raycheck WORDS` in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **options.pop("env", {})}
    command = [*ENTRY, *(str(word) for word in words)]
    return subprocess.run(command, capture_output=True, text=True, env=environment, timeout=120, check=False, **options)


def test_exit_0_is_a_tracer_that_conforms(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", "builtin:reference", "--scenes", "background", "--out", tmp_path / "o")
    assert told.code == 0
    assert "conforms" in told.out
    assert f"report: {tmp_path / 'o' / 'index.html'}" in told.out


def test_exit_1_is_a_tracer_that_does_not_conform(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", f"images:{tmp_path}", "--scenes", "background", "--out", tmp_path / "o")
    assert told.code == 1
    assert "does not conform" in told.out


def test_exit_3_is_a_tracer_that_does_not_start(raycheck: Raycheck, tmp_path: Path) -> None:
    assert raycheck("smoke", "--", tmp_path / "nothing", "{scene}", "{image}").code == 3


def test_exit_4_is_a_bug_of_ours_and_says_so(raycheck: Raycheck, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken() -> None:
        raise ZeroDivisionError("an invariant")

    monkeypatch.setattr(scenes_command, "ladder", broken)
    told = raycheck("scenes")
    assert told.code == 4
    assert "the suite itself failed (ZeroDivisionError); this is a bug of raycheck" in told.err
    assert "an invariant" in told.err


def test_exit_130_is_an_interrupt(raycheck: Raycheck, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted() -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(scenes_command, "ladder", interrupted)
    assert raycheck("scenes").code == 130


def test_a_bug_midway_still_leaves_the_verdicts_found_until_then(
    raycheck: Raycheck, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def two_and_a_bug(hearing: suite.Hearing) -> Any:
        verdicts = ask(hearing)
        yield next(verdicts)
        yield next(verdicts)
        raise ZeroDivisionError

    ask = suite.Hearing.verdicts
    monkeypatch.setattr(suite.Hearing, "verdicts", two_and_a_bug)
    assert raycheck("check", "builtin:reference", "--size", "8x6", "--out", tmp_path).code == 4
    found = results.read(tmp_path)
    assert not found.complete
    assert not found.conforms
    assert len(found.verdicts) == 2


MISUSE = {
    # call: what the message says
    (): "required: COMMAND",
    ("fly",): "invalid choice: 'fly'",
    ("check",): "no tracer is given",
    ("smoke",): "no tracer is given",
    ("check", "--"): "no command follows --",
    ("check", "builtin:reference", "--", "./t", "{scene}", "{image}"): "both 'builtin:reference' and a command",
    ("check", "builtin:reference", "--fast"): "unrecognized arguments: --fast",
    ("check", "builtin:reference", "builtin:reference"): "unrecognized arguments",
    ("check", "builtin:reference", "--size", "320"): "--size 320: not a size",
    ("check", "builtin:reference", "--size", "0x5"): "--size 0x5: out of range",
    ("check", "builtin:reference", "--size", "5x16385"): "out of range",
    ("check", "builtin:reference", "--size", "-5x5"): "--size",
    ("check", "builtin:reference", "--size", "1e2x5"): "not a size",
    ("check", "builtin:reference", "--size", ""): "not a size",
    ("check", "builtin:reference", "--scenes", ""): "--scenes is empty",
    ("check", "builtin:reference", "--scenes", "glas-sphere"): "glass-sphere",
    ("check", "builtin:reference", "--scenes", "background,"): "no such scene",
    ("check", "builtin:reference", "--scenes", "background, headlight-plane"): "headlight-plane",
    ("check", "builtin:reference", "--seed", "x"): "invalid int value: 'x'",
    ("check", "builtin:reference", "--precision", "float16"): "invalid choice: 'float16'",
    ("check", "builtin:reference", "--known", "/nowhere.toml"): "/nowhere.toml: No such file",
    ("render", "background"): "required: IMAGE",
    ("render", "background", "x.jpg"): "unknown image ending '.jpg'",
    ("render", "background", "x"): "unknown image ending ''",
    ("render", "background", "/nowhere/x.png"): "/nowhere: no such folder",
    ("render", "nobody", "x.png"): "no such scene",
    ("render", "/nowhere.json", "x.png"): "/nowhere.json",
    ("render", "background", "x.png", "--depth", "17"): "--depth 17: out of range",
    ("render", "background", "x.png", "--depth", "-1"): "--depth -1: out of range",
    ("render", "background", "x.png", "--arithmetic", "plain", "--precision", "32"): "computes in 64 bits",
    ("render", "background", "x.png", "--precision", "16"): "invalid choice: 16",
    ("render", "background", "x.png", "--size", "x"): "not a size",
    ("scenes", "nobody"): "no such scene",
    ("scenes", "background", "--as", "yaml"): "invalid choice: 'yaml'",
    ("scenes", "--", "background"): "takes no command after --",
    ("doctor", "--", "x"): "takes no command after --",
    ("report",): "required: DIR",
    ("report", "/nowhere"): "/nowhere/results.json: No such file",
    ("doctor", "now"): "unrecognized arguments",
}


@pytest.mark.parametrize("words", MISUSE, ids=lambda words: " ".join(words)[:60] or "nothing")
def test_misuse_is_exit_2_and_one_line_that_names_it(
    raycheck: Raycheck, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    told = raycheck(*words)
    assert told.code == 2
    assert told.err.startswith("raycheck: ")
    assert told.err.count("\n") == 1
    assert MISUSE[words] in told.err
    assert told.out == ""
    assert not list(tmp_path.rglob("*.png"))


def test_an_out_folder_that_is_a_file_is_exit_2(raycheck: Raycheck, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    for out in (tmp_path / "file", tmp_path / "file" / "below"):
        told = raycheck("check", "builtin:reference", "--scenes", "background", "--out", out)
        assert told.code == 2
        assert str(out) in told.err


@pytest.mark.parametrize("name", ["index.html", "results.json", "junit.xml"])
def test_a_folder_where_a_report_file_goes_is_exit_2_before_anything_runs(
    raycheck: Raycheck, tmp_path: Path, name: str
) -> None:
    (tmp_path / name).mkdir()
    told = raycheck("check", "builtin:reference", "--scenes", "background", "--out", tmp_path)
    assert told.code == 2
    assert name in told.err
    assert not list((tmp_path / "images").iterdir())


def test_a_file_where_the_pictures_go_is_exit_2(raycheck: Raycheck, tmp_path: Path) -> None:
    (tmp_path / "images").write_text("x")
    assert raycheck("check", "builtin:reference", "--scenes", "background", "--out", tmp_path).code == 2


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_explains_itself(raycheck: Raycheck, command: str) -> None:
    told = raycheck(command, "--help")
    assert told.code == 0
    assert told.out.startswith(f"usage: raycheck {command}")
    assert "exit codes" in told.out


def test_the_list_of_commands_here_is_that_of_the_parser() -> None:
    for line in raycheck.cli.parser().format_help().splitlines():
        if line.startswith("    ") and line.strip() and not line.startswith("     "):
            assert line.split()[0] in COMMANDS


def test_the_version_is_told(raycheck: Raycheck) -> None:
    assert raycheck("--version").out == f"raycheck {VERSION}\n"


def test_help_loads_nothing_heavy() -> None:
    body = """
import sys
from raycheck.cli import main
for words in (["--help"], ["check", "--help"], ["--version"], ["nonsense"]):
    try:
        main(words)
    except SystemExit:
        pass
print(sorted({name.split(".")[0] for name in sys.modules} & {"numpy", "pydantic", "drjit", "jinja2", "PIL", "OpenEXR"}))
"""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-P", "-c", body], capture_output=True, text=True, env=environment, check=True
    )
    assert done.stdout.splitlines()[-1] == "[]"


def to_a_closed_pipe(*words: object) -> tuple[int, str]:
    """Exit code and stderr of `raycheck WORDS` whose reader has gone away before it starts."""
    read, write = os.pipe()
    os.close(read)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [*ENTRY, *(str(word) for word in words)], stdout=write, stderr=subprocess.PIPE, env=environment, check=False
    )
    os.close(write)
    return done.returncode, done.stderr.decode()


def test_output_to_a_closed_pipe_is_no_error() -> None:
    assert to_a_closed_pipe("scenes") == (0, "")


def test_a_closed_pipe_does_not_make_a_wrong_tracer_conform(tmp_path: Path) -> None:
    words = ("check", f"images:{tmp_path}", "--scenes", "background", "--out", tmp_path / "o")
    assert to_a_closed_pipe(*words) == (1, "")


@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_closed_streams_are_no_error(tmp_path: Path, closed: str) -> None:
    line = f'exec "$@" {closed}'
    words = ["check", "builtin:reference/numpy", "--scenes", "background", "--out", str(tmp_path / "o")]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    assert subprocess.run(["sh", "-c", line, "sh", *ENTRY, *words], env=environment, check=False).returncode == 0


def test_a_terminal_without_greek_letters_still_gets_the_catalogue() -> None:
    done = outside("scenes", env={"PYTHONIOENCODING": "ascii"})
    assert (done.returncode, done.stderr) == (0, "")
    assert "\\u2218" in done.stdout


def test_progress_is_not_written_where_stderr_is_no_terminal(tmp_path: Path) -> None:
    done = outside("check", "builtin:reference/numpy", "--scenes", "background", "--out", tmp_path / "o")
    assert (done.returncode, done.stderr) == (0, "")


def test_the_catalogue_is_listed_with_one_line_a_scene(raycheck: Raycheck) -> None:
    lines = raycheck("scenes").out.splitlines()
    assert [line.split()[0] for line in lines] == [rung.name for rung in ladder()]


def test_doctor_names_the_machine_and_a_remedy_for_what_is_missing(
    raycheck: Raycheck, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    told = raycheck("doctor")
    assert told.code == 0
    assert "povray    missing: " in told.out
    assert "apt-get install povray" in told.out
    for tool, package in jail.TOOLS.items():
        assert f"{tool:<9} missing: no sandbox" in told.out
        assert f"apt-get install {package}" in told.out
    assert "sandbox   missing: bwrap is not installed" in told.out


@pytest.mark.parametrize("option", ["--precision float64", "--scene json", "--image exr"])
def test_what_the_manifest_says_cannot_be_said_again(option: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert raycheck.cli.main(["check", str(ROOT / "examples/cpp_lecture"), *option.split()]) == 2
    told = capsys.readouterr().err
    assert f"{option} does not go with {ROOT / 'examples' / 'cpp_lecture'}; raycheck.toml says it" in told


def test_an_abbreviated_option_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stop:
        raycheck.cli.main(["check", "builtin:reference", "--scen", "background"])
    assert stop.value.code == 2
    assert "unrecognized arguments: --scen" in capsys.readouterr().err
