"""The pages of measurements in a real browser: nothing of them is stopped by their own policy."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from oracles.measurement import Panel, Point
from oracles.stability import maps
from oracles.stability.probe import sphere_methods
from reports import chart, stability
from reports.results import Machine

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium on PATH: the page is not loaded in a browser")
FLAGS = ("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--enable-logging=stderr", "--dump-dom")
MACHINE = Machine(processor="p", cores=2, memory_gib=1.0, system="s", python="3", packages={}, lanes="NumPy")
RUN = {"suite": "0", "subject": None, "machine": MACHINE, "started": "now", "command": "c", "seed": 0, "seconds": 1.0}


def of_stability(folder: Path) -> Path:
    experiment = maps.world_map(sphere_methods("float32")[:1], "float32", np.random.default_rng(0))
    nothing: dict[str, object] = {
        "questions": (),
        "frontiers": (),
        "starts": (),
        "gaps": (),
        "depths": (),
        "depth_scene": "s",
        "cases": (),
    }
    return stability.write(stability.Stability.model_validate(RUN | nothing | {"experiments": (experiment,)}), folder)


def of_chart(folder: Path) -> Path:
    panel = Panel(name="near", title="Ordinary", about="", per="one ray", measure="error", tolerance=1e-3)
    point = Point(
        panel="near",
        name="lecture",
        kind="NumPy float64",
        precision="float64",
        seconds=1e-9,
        spread=(1e-9, 1e-9, 2e-9),
        ratio=1.0,
        error=1e-9,
        bits=30.0,
        wrong=0.0,
        baseline=True,
        frontier=True,
    )
    return chart.write(chart.Chart.model_validate(RUN | {"panels": (panel,), "points": (point,)}), folder)


@pytest.mark.parametrize("make", [of_stability, of_chart])
def test_the_page_shows_in_a_browser_and_breaks_no_policy(make: Callable[[Path], Path], tmp_path: Path) -> None:
    command = (str(BROWSER), *FLAGS, f"--user-data-dir={tmp_path / 'profile'}", make(tmp_path).as_uri())
    loaded = subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)
    assert "<svg" in loaded.stdout
    assert "Content Security Policy" not in loaded.stderr
