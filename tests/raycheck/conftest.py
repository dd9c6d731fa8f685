"""Tracers of a few lines, and the command line in this process."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from raycheck.cli import main
from reports import results
from reports.results import Results

# Who starts the tests in the background has interrupts ignored, and so would their children
signal.signal(signal.SIGINT, signal.default_int_handler)

PFM = """
import struct, sys
def write(path, width, height, value=0.0):
    with open(path, "wb") as f:
        f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
        f.write(struct.pack("<f", value) * (3 * width * height))
scene, image = sys.argv[1:3]
words = {line.split()[0]: line.split()[1:] for line in open(scene) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
background = [float(w) for w in words["background"]]
"""
"""What the scripts below begin with: reading the scene's size, writing a grey PFM."""

RIGHT = """
with open(image, "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *background) * (width * height))
"""
"""Right for the first rung, whose every pixel is the background."""


@dataclass(frozen=True)
class Told:
    """How a command ended and what it said."""

    code: int
    out: str
    err: str


@pytest.fixture
def raycheck(capsys: pytest.CaptureFixture[str]) -> Callable[..., Told]:
    """`raycheck WORDS` in this process."""

    def call(*words: object) -> Told:
        try:
            code = main([str(word) for word in words])
        except SystemExit as end:  # how argparse leaves
            code = int(end.code or 0)
        told = capsys.readouterr()
        return Told(code, told.out, told.err)

    return call


@pytest.fixture
def script(tmp_path: Path) -> Callable[..., list[str]]:
    """The command of a Python tracer with this body."""

    def write(body: str, name: str = "tracer.py") -> list[str]:
        path = tmp_path / name
        path.write_text(PFM + body, "utf-8")
        return [sys.executable, "-S", str(path), "{scene}", "{image}"]

    return write


@pytest.fixture
def manifest(tmp_path: Path) -> Callable[..., Path]:
    """A folder with this raycheck.toml."""

    def write(text: str, name: str = "team") -> Path:
        folder = tmp_path / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "raycheck.toml").write_text(text, "utf-8")
        return folder

    return write


@pytest.fixture
def attached(manifest: Callable[..., Path], tmp_path: Path) -> Callable[..., Path]:
    """A folder with a Python tracer of this body, attached by its manifest; more lines go into [tracer]."""

    def write(body: str, *lines: str, name: str = "team") -> Path:
        render = f'render = ["{sys.executable}", "-S", "tracer.py", "{{scene}}", "{{image}}"]'
        folder = manifest("\n".join(["[tracer]", 'name = "Team 7"', render, *lines]) + "\n", name)
        (folder / "tracer.py").write_text(PFM + body, "utf-8")
        return folder

    return write


@pytest.fixture
def check(raycheck: Callable[..., Told], tmp_path: Path) -> Callable[..., Results]:
    """`raycheck check WORDS`, its results; the exit code must be that of the results."""

    def call(*words: object) -> Results:
        out = tmp_path / "report"
        told = raycheck("check", "--out", out, *words)
        found = results.read(out)
        assert told.code == (0 if found.conforms else 1), told.err
        return found

    return call
