"""The example tracers, in copies of their own so that tests may build them side by side."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def compiled(tmp_path: Path) -> Callable[..., Path]:
    """A copy of an example's folder; flags are given to the compiler, `edit` maps words of its manifest."""
    if not (shutil.which("g++") and shutil.which("make")):
        pytest.skip("g++ and make are needed to build the examples")

    def copy(name: str, flags: str = "", **edit: str) -> Path:
        folder = tmp_path / name
        shutil.copytree(EXAMPLES / name, folder, ignore=shutil.ignore_patterns("tracer"))
        manifest = folder / "raycheck.toml"
        text = manifest.read_text("utf-8")
        if flags:
            text = text.replace('["make"]', f'["make", "CXXFLAGS=-O2 -std=c++17 {flags}"]')
        for old, new in edit.items():
            assert old in text
            text = text.replace(old, new)
        manifest.write_text(text, "utf-8")
        return folder

    return copy
