"""results.json: everything a check found, and the one thing all reports are written from."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

from oracles.verdict import CONFORMING, Diagnosis, Frozen, Verdict
from reports.stored import stored
from scenes.disk import write_whole

FILE = "results.json"


class Subject(Frozen):
    """The tracer under test, as attached."""

    name: str
    spec: str
    precision: str
    scene: str = ""
    image: str = ""
    features: tuple[str, ...] | None = None


class Machine(Frozen):
    """Where the check ran."""

    processor: str
    cores: int
    memory_gib: float
    system: str
    python: str
    packages: dict[str, str]
    lanes: str


class Suite(Frozen):
    """Which suite judged."""

    version: str
    catalogue: str


class Results(Frozen):
    """One run of the suite against one subject.

    planned: checks that were meant to run; diagnosis: what explains those that fail; complete: False if the run was
    cut off before them.
    """

    schema_version: Literal[1] = 1
    suite: Suite
    subject: Subject
    machine: Machine
    started: str
    command: str
    seed: int
    size: str | None = None
    seconds: float = 0.0
    planned: int
    verdicts: tuple[Verdict, ...]
    diagnosis: Diagnosis | None = None
    complete: bool

    @property
    def conforms(self) -> bool:
        """No verdict stands against the tracer, and at least one stands for it."""
        words = [v.verdict for v in self.verdicts]
        return self.complete and all(word in CONFORMING for word in words) and "pass" in words

    def counts(self) -> dict[str, int]:
        """Number of verdicts by word, in order of first appearance."""
        found: dict[str, int] = {}
        for verdict in self.verdicts:
            found[verdict.verdict] = found.get(verdict.verdict, 0) + 1
        return found


def write(results: Results, folder: Path) -> Path:
    """Write results.json whole or not at all; return its path."""
    path = folder / FILE
    write_whole(path, (results.model_dump_json(indent=1) + "\n").encode())
    return path


def read(folder: Path) -> Results:
    """Read and validate results.json of a report folder; raise ResultsError."""
    return stored(Results, folder / FILE, "raycheck check", "results")


def schema() -> str:
    """The published JSON Schema, as committed in reports/schema/."""
    return json.dumps(Results.model_json_schema(), indent=2) + "\n"
