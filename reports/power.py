"""power.html and power.json: which scenes notice which known mistake."""

from __future__ import annotations

import json
from collections.abc import Iterator
from math import inf
from pathlib import Path
from typing import Literal

from oracles.verdict import Frozen
from reports import measured
from reports.results import Machine
from scenes.disk import write_whole

FILE, DATA = "power.html", "power.json"


class SceneKill(Frozen):
    """A scene that fails a tracer: pixels outside their bound, the worst in tolerances (None: none was tolerated)."""

    scene: str
    pixels: int
    excess: float | None


class FaultPower(Frozen):
    """One fault before all scenes; fate and reason as the dictionary says."""

    name: str
    group: str
    fate: Literal["killed", "survives", "equivalent"]
    reason: str
    kills: tuple[SceneKill, ...]

    @property
    def worst(self) -> float:
        """The most tolerances by which a scene fails it; 0 for none, inf where none is tolerated."""
        return max((inf if kill.excess is None else kill.excess for kill in self.kills), default=0.0)


class TwinPower(Frozen):
    """One correct tracer, and the scenes that wrongly fail it."""

    name: str
    how: str
    kills: tuple[SceneKill, ...]


class Power(Frozen):
    """One run of `raycheck power`."""

    schema_version: Literal[1] = 1
    suite: str
    machine: Machine
    started: str
    command: str
    seconds: float
    size: str
    scenes: tuple[str, ...]
    faults: tuple[FaultPower, ...]
    twins: tuple[TwinPower, ...]

    @property
    def missed(self) -> tuple[FaultPower, ...]:
        """Faults that no scene notices although the dictionary says that one does."""
        return tuple(fault for fault in self.faults if not fault.kills and fault.fate == "killed")

    @property
    def refuted(self) -> tuple[FaultPower, ...]:
        """Faults that a scene notices although the dictionary says that none can."""
        return tuple(fault for fault in self.faults if fault.kills and fault.fate == "equivalent")

    @property
    def wronged(self) -> tuple[TwinPower, ...]:
        """Correct tracers that a scene fails."""
        return tuple(twin for twin in self.twins if twin.kills)

    @property
    def idle(self) -> tuple[str, ...]:
        """Scenes that notice no fault."""
        used = {kill.scene for fault in self.faults for kill in fault.kills}
        return tuple(scene for scene in self.scenes if scene not in used)

    @property
    def holds(self) -> bool:
        """Every fault is noticed or excused with a reason, no correct tracer is failed, and no scene is idle."""
        return not (self.missed or self.refuted or self.wronged or self.idle)


def lines(found: Power) -> Iterator[str]:
    """One line a fault, then what is wrong, then the sum."""
    yield f"{'fault':<40} {'scenes':>6} {'tolerances':>11}  first scene"
    for fault in found.faults:
        first = fault.kills[0].scene if fault.kills else f"{fault.fate}: {fault.reason}" if fault.reason else "-"
        yield f"{fault.name:<40} {len(fault.kills):>6} {measured.number(fault.worst):>11}  {first}"
    yield from (f"MISSED: no scene notices {fault.name}" for fault in found.missed)
    for fault in found.refuted:
        yield f"REFUTED: {fault.kills[0].scene} notices {fault.name}, said to be equivalent"
    for twin in found.wronged:
        yield f"WRONGED: {twin.kills[0].scene} fails {twin.name}, which is correct ({twin.how})"
    yield from (f"IDLE: {scene} notices no fault" for scene in found.idle)
    noticed = sum(bool(fault.kills) for fault in found.faults)
    yield (
        f"{noticed} of {len(found.faults)} faults are noticed on {len(found.scenes)} scenes ({found.size}); "
        f"{len(found.wronged)} of {len(found.twins)} correct tracers are failed"
    )


def schema() -> str:
    """The published JSON Schema."""
    return json.dumps(Power.model_json_schema(), indent=2) + "\n"


def write(found: Power, folder: Path) -> Path:
    """Write both files whole or not at all; return the page's path."""
    write_whole(folder / DATA, (found.model_dump_json(indent=1) + "\n").encode())
    write_whole(folder / FILE, measured.page(FILE, found=found, said=list(lines(found))[-1]).encode())
    return folder / FILE
