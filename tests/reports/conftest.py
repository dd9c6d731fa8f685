"""Samples: a run with every verdict, and the pictures beside it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import get_args

import pytest
from PIL import Image

from oracles.verdict import Judged, Pictures, Pixel, Process, Verdict, Word
from reports.results import Machine, Results, Subject, Suite

WIDTH, HEIGHT = 16, 12
RED, GREEN, BLUE = (200, 0, 0), (0, 200, 0), (0, 0, 200)


@pytest.fixture
def worst() -> Pixel:
    return Pixel(i=7, j=3, channel="green", expected=0.123456789, tolerance=2.5e-7, got=0.25, excess=506172.8)


@pytest.fixture
def judged(worst: Pixel) -> Judged:
    return Judged(
        pixels=WIDTH * HEIGHT,
        outside=31,
        doubtful={"shadow": 2, "silhouette": 5},
        decided=186,
        tolerance_median=2.1e-7,
        tolerance_99=8.8e-7,
        tolerance_worst=3.1e-5,
        worst=worst,
    )


@pytest.fixture
def process() -> Process:
    command = ("./tracer", "two words.txt")
    return Process(command=command, status="exit status 0", seconds=0.0213, output_tail="reading\ntracing")


@pytest.fixture
def pictures() -> Pictures:
    return Pictures(expected="images/expected.png", got="images/got.png", difference="images/difference.png")


@pytest.fixture
def make(judged: Judged, process: Process, pictures: Pictures) -> Callable[..., Verdict]:
    """A verdict of that word, named after it, with all its evidence."""

    def verdict(word: Word, **fields: object) -> Verdict:
        told = {
            "check": f"a-{word}",
            "verdict": word,
            "message": f"the message of {word}",
            "slide": "Phong Effect",
            "teaches": "no highlight behind",
            "formula": "r = 2(i∘n)n - i",
            "reproduce": f"raycheck check t --scenes a-{word}",
            "judged": judged,
            "process": process,
            "pictures": pictures,
            "seconds": 0.125,
        }
        return Verdict.model_validate(told | fields)

    return verdict


@pytest.fixture
def run() -> Callable[..., Results]:
    """A complete run with these verdicts."""

    def results(*verdicts: Verdict, **fields: object) -> Results:
        told = {
            "suite": Suite(version="2026.8.0", catalogue="1"),
            "subject": Subject(name="Team 7", spec="examples/cpp", precision="float32", features=("spheres",)),
            "machine": Machine(
                processor="Abacus 9000",
                cores=2,
                memory_gib=15.6,
                system="Linux 6.1",
                python="3.11.9",
                packages={"numpy": "2.4.6", "drjit": "1.5.0"},
                lanes="numpy float64",
            ),
            "started": "2026-08-01T12:00:00Z",
            "command": "raycheck check examples/cpp",
            "seed": 41,
            "seconds": 131.2,
            "planned": len(verdicts),
            "verdicts": verdicts,
            "complete": True,
        }
        return Results.model_validate(told | fields)

    return results


@pytest.fixture
def results(run: Callable[..., Results], make: Callable[..., Verdict]) -> Results:
    """A run in which every word occurs once, passes first."""
    return run(*(make(word, blocked_by="a-fail" if word == "blocked" else None) for word in get_args(Word)))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A report's folder with three pictures."""
    report = tmp_path / "report"
    (report / "images").mkdir(parents=True)
    for name, colour in {"expected": RED, "got": GREEN, "difference": BLUE}.items():
        Image.new("RGB", (WIDTH, HEIGHT), colour).save(report / "images" / f"{name}.png")
    return report
