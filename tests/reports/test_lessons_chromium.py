"""The pages of mistakes in a real browser: nothing of them is stopped by their own policy."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from oracles.images.writing import png_bytes
from reports import lessons
from reports.lessons import Course, Lesson, Pair
from reports.power import SceneKill

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium on PATH: the page is not loaded in a browser")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--enable-logging=stderr", "--dump-dom")
PICTURE = png_bytes(np.full((3, 4, 3), 128))


@pytest.mark.parametrize("name", ["index.html", "a-mistake.html"])
def test_the_page_shows_in_a_browser_and_breaks_no_policy(name: str, tmp_path: Path) -> None:
    kinds = dict.fromkeys(("right", "wrong", "difference", "thumbnail"), PICTURE)
    pair = Pair.model_validate(
        {"scene": "s", "teaches": "t", "width": 4, "height": 3, "outside": 1, "finite": True} | kinds
    )
    words = ("group", "source", "formula", "wrong", "right", "seen", "mend", "fate", "reason", "again")
    told = {"name": "a-mistake", "entries": ("phong",), "kills": (SceneKill(scene="s", pixels=1, excess=2.0),)}
    lesson = Lesson.model_validate(dict.fromkeys(words, "some words") | told | {"pair": pair})
    lessons.write([lesson], Course("0", 1, "4x3"), tmp_path)
    command = (str(BROWSER), *FLAGS, f"--user-data-dir={tmp_path / 'profile'}", (tmp_path / name).as_uri())
    loaded = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "data:image/png;base64," in loaded.stdout
    assert "Content Security Policy" not in loaded.stderr
