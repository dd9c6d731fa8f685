"""The wheel holds everything that a user without a checkout needs."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from raycheck.skeleton import LANGUAGES

pytestmark = pytest.mark.skipif(find_spec("hatchling") is None, reason="hatchling is needed: pip install hatchling")
ROOT = Path(__file__).resolve().parents[1]
PACKAGES = ("raycheck", "reports", "oracles", "reference_tracer", "scenes")


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel's files, unpacked."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-P", "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder / "built")]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = (folder / "built").iterdir()
    zipfile.ZipFile(wheel).extractall(folder / "site")
    return folder / "site"


def raycheck(installed: Path, folder: Path, *words: str) -> str:
    """What the installed command says, called outside the checkout."""
    call = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()", *words]
    environment = os.environ | {"PYTHONPATH": str(installed)}
    return subprocess.run(call, cwd=folder, env=environment, check=True, capture_output=True, text=True).stdout


def test_every_file_of_the_packages_is_in_it(installed: Path) -> None:
    told = {path.relative_to(installed).as_posix() for path in installed.rglob("*") if path.is_file()}
    ours = {
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in (ROOT / package).rglob("*")
        if path.is_file() and path.suffix != ".pyc"
    }
    assert len(ours) > 200
    assert ours <= told
    assert not any(name.startswith(("tests/", "benchmarks/", "docs/")) for name in told)


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_skeleton_is_whole(installed: Path, tmp_path: Path, language: str) -> None:
    raycheck(installed, tmp_path, "init", language, "mine")
    sources = {
        p.name for p in (ROOT / "examples" / f"{language}_lecture").iterdir() if p.suffix or p.name == "Makefile"
    }
    assert {path.name for path in (tmp_path / "mine").iterdir()} == {n for n in sources if not n.endswith(".class")}


def test_scenes_and_the_rubric_that_ships_are_found(installed: Path, tmp_path: Path) -> None:
    assert '"name": "background"' in raycheck(installed, tmp_path, "scenes", "background", "--as", "json")
    raycheck(installed, tmp_path, "grade", "--gradescope-bundle", "autograder.zip")
    with zipfile.ZipFile(tmp_path / "autograder.zip") as bundle:
        assert "[[group]]" in bundle.read("rubric.toml").decode()


def test_a_report_is_written_from_it(installed: Path, tmp_path: Path) -> None:
    words = ("builtin:reference/numpy", "--scenes", "background", "--size", "8x6", "--out", "out")
    raycheck(installed, tmp_path, "check", *words)
    assert "conforms" in (tmp_path / "out" / "index.html").read_text("utf-8")
