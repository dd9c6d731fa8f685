"""Tracers that cannot be started (exit 3) and manifests that cannot be read (exit 2)."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from raycheck.manifest import MAX_BYTES

Raycheck = Callable[..., Any]
Manifest = Callable[..., Path]

RENDER = 'render = ["./tracer", "{scene}", "{image}"]\n'


def test_a_program_that_is_missing_is_exit_3(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", "--out", tmp_path / "o", "--", "/nowhere/tracer", "{scene}", "{image}")
    assert told.code == 3
    assert "'/nowhere/tracer' cannot be started: No such file or directory" in told.err


def test_a_program_that_is_not_executable_is_exit_3(raycheck: Raycheck, tmp_path: Path) -> None:
    program = tmp_path / "tracer"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o644)
    told = raycheck("check", "--out", tmp_path / "o", "--", program, "{scene}", "{image}")
    assert told.code == 3
    assert "Permission denied" in told.err


def test_a_file_that_is_no_program_is_exit_3(raycheck: Raycheck, tmp_path: Path) -> None:
    program = tmp_path / "tracer"
    program.write_bytes(b"\x7fELF nonsense")
    program.chmod(0o755)
    assert raycheck("check", "--out", tmp_path / "o", "--", program, "{scene}", "{image}").code == 3


@pytest.mark.parametrize("word", ["/", "", "."])
def test_a_command_without_a_name_is_exit_3(raycheck: Raycheck, tmp_path: Path, word: str) -> None:
    assert raycheck("check", "--out", tmp_path / "o", "--", word, "{scene}", "{image}").code == 3


def test_a_build_that_fails_is_exit_3_with_the_compilers_words(
    raycheck: Raycheck, manifest: Manifest, tmp_path: Path
) -> None:
    build = f"""build = ["{sys.executable}", "-c", "raise SystemExit('tracer.cpp:7: expected ;')"]\n"""
    told = raycheck("check", manifest('[tracer]\nname = "x"\n' + build + RENDER), "--out", tmp_path / "o")
    assert told.code == 3
    assert "failed (exit status 1)" in told.err
    assert "tracer.cpp:7: expected ;" in told.err


def test_a_build_that_dies_by_a_signal_is_exit_3(raycheck: Raycheck, manifest: Manifest, tmp_path: Path) -> None:
    build = f"""build = ["{sys.executable}", "-c", "import os; os.abort()"]\n"""
    told = raycheck("check", manifest('[tracer]\nname = "x"\n' + build + RENDER), "--out", tmp_path / "o")
    assert told.code == 3
    assert "SIGABRT" in told.err


def test_a_build_program_that_is_missing_is_exit_3(raycheck: Raycheck, manifest: Manifest, tmp_path: Path) -> None:
    text = '[tracer]\nname = "x"\nbuild = ["no-such-compiler", "-O2"]\n' + RENDER
    told = raycheck("check", manifest(text), "--out", tmp_path / "o")
    assert told.code == 3
    assert "'no-such-compiler -O2' cannot run" in told.err


def test_a_build_runs_once_and_in_the_tracers_folder(
    attached: Callable[..., Path], raycheck: Raycheck, tmp_path: Path
) -> None:
    build = f"""build = ["{sys.executable}", "-c", "open('built', 'a').write('x')"]"""
    folder = attached("write(image, width, height)", build)
    raycheck("check", folder, "--scenes", "background,headlight-plane", "--no-block", "--out", tmp_path / "o")
    assert (folder / "built").read_text() == "x"


def test_a_wrong_scene_name_is_found_before_the_build(
    attached: Callable[..., Path], raycheck: Raycheck, tmp_path: Path
) -> None:
    folder = attached("", f"""build = ["{sys.executable}", "-c", "open('built', 'a').write('x')"]""")
    assert raycheck("check", folder, "--scenes", "nope", "--out", tmp_path / "o").code == 2
    assert not (folder / "built").exists()


NAMED = '[tracer]\nname = "x"\n'
WRONG = {
    # manifest: what the message must name
    '[tracer]\nname = "x"\n': "key tracer.render is missing",
    "[tracer]\n" + RENDER: "key tracer.name is missing",
    "": "key tracer is missing",
    NAMED + RENDER + 'colour = "red"\n': "unknown key tracer.colour",
    NAMED + RENDER + "[other]\nx = 1\n": "unknown key other",
    "[tracer\n": "not TOML",
    NAMED + RENDER + RENDER: "not TOML",
    "x = \ufffd": "not TOML",
    "a = " + "[" * 30_000: "not TOML",
    "a = " + "1" * 6_000: "not TOML",
    "tracer = 3\n": "tracer = 3",
    '[tracer]\nname = ""\n' + RENDER: "tracer.name = ''",
    "[tracer]\nname = 7\n" + RENDER: "tracer.name = 7",
    NAMED + 'render = "./tracer {scene} {image}"\n': "tracer.render = './tracer {scene} {image}'",
    NAMED + "render = []\n": "tracer.render",
    NAMED + 'render = ["./tracer", 3]\n': "tracer.render.1 = 3",
    NAMED + 'render = ["./a\\u0000", "{scene}", "{image}"]\n': "tracer.render.0",
    NAMED + 'build = "make"\n' + RENDER: "tracer.build = 'make'",
    NAMED + "build = []\n" + RENDER: "tracer.build",
    NAMED + RENDER + 'timeout = "30"\n': "tracer.timeout = '30'",
    NAMED + RENDER + "timeout = true\n": "tracer.timeout = True",
    NAMED + RENDER + "timeout = 0\n": "tracer.timeout = 0",
    NAMED + RENDER + "timeout = -1\n": "tracer.timeout = -1",
    NAMED + RENDER + "timeout = nan\n": "tracer.timeout = nan",
    NAMED + RENDER + "timeout = inf\n": "tracer.timeout = inf",
    NAMED + RENDER + 'scene = "yaml"\n': "tracer.scene = 'yaml'",
    NAMED + RENDER + 'image = "jpg"\n': "tracer.image = 'jpg'",
    NAMED + RENDER + 'precision = "float16"\n': "tracer.precision = 'float16'",
    NAMED + RENDER + 'features = ["plane", "magic"]\n': "tracer.features.1 = 'magic'",
    NAMED + RENDER + 'features = "plane"\n': "tracer.features = 'plane'",
    NAMED + 'render = ["./tracer", "{image}"]\n': "lacks {scene}",
    NAMED + 'render = ["./tracer", "{scene}"]\n': "lacks {image}",
}


@pytest.mark.parametrize("text", WRONG, ids=lambda text: WRONG[text][:40])
def test_a_wrong_manifest_is_exit_2_and_names_file_and_key(
    raycheck: Raycheck, manifest: Manifest, tmp_path: Path, text: str
) -> None:
    told = raycheck("check", manifest(text), "--out", tmp_path / "o")
    assert told.code == 2
    assert WRONG[text] in told.err
    if "lacks" not in WRONG[text]:
        assert "raycheck.toml" in told.err


def test_a_huge_manifest_is_exit_2_and_names_the_file(raycheck: Raycheck, manifest: Manifest) -> None:
    told = raycheck("check", manifest(NAMED + RENDER + "#" * MAX_BYTES))
    assert told.code == 2
    assert "raycheck.toml: over" in told.err


def test_a_pipe_as_manifest_is_exit_2_and_not_waited_for(raycheck: Raycheck, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "raycheck.toml")
    told = raycheck("check", tmp_path)
    assert told.code == 2
    assert "raycheck.toml: not a regular file" in told.err


def test_a_manifest_that_is_not_utf_8_is_exit_2(raycheck: Raycheck, tmp_path: Path) -> None:
    (tmp_path / "raycheck.toml").write_bytes(b"[tracer]\nname = '\xff'\n")
    told = raycheck("check", tmp_path)
    assert told.code == 2
    assert "not TOML" in told.err


def test_a_folder_without_a_manifest_is_exit_2_with_both_ways_out(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", tmp_path)
    assert told.code == 2
    assert "raycheck.toml" in told.err
    assert "after --" in told.err


@pytest.mark.parametrize("command", ["check", "smoke"])
@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("/nowhere/at/all", "no such folder"),
        ("builtin:nobody", "no such tracer is built in"),
        ("builtin:reference/abacus", "no such reference"),
        ("builtin:reference/numpy/16", "no such reference"),
        ("builtin:reference/numpy/32/x", "no such reference"),
        ("builtin:reference/plain/32", "the plain tracer computes in 64 bits"),
        ("images:/nowhere/at/all", "no such folder"),
        ("images:", "no such folder"),
        ("python:module", "not a Python object"),
        ("python:a:b:c", "not a Python object"),
    ],
)
def test_a_subject_that_does_not_exist_is_exit_2(raycheck: Raycheck, command: str, spec: str, message: str) -> None:
    told = raycheck(command, spec)
    assert told.code == 2
    assert spec in told.err or "images:" in spec
    assert message in told.err


def test_a_command_of_too_many_words_is_exit_2(raycheck: Raycheck) -> None:
    told = raycheck("check", "--", "./tracer", "{scene}", "{image}", *["x"] * 100)
    assert told.code == 2
    assert "at most 100" in told.err


@pytest.mark.parametrize("missing", ["{scene}", "{image}"])
def test_a_command_that_lacks_a_placeholder_is_exit_2(raycheck: Raycheck, missing: str) -> None:
    words = [word for word in ("./tracer", "{scene}", "{image}") if word != missing]
    told = raycheck("check", "--", *words)
    assert told.code == 2
    assert f"lacks {missing}" in told.err


def test_a_word_that_is_not_utf_8_is_exit_2(raycheck: Raycheck) -> None:
    told = raycheck("check", "--", "./t\udcff", "{scene}", "{image}")
    assert told.code == 2
    assert "is not UTF-8" in told.err
