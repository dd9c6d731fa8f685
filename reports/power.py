"""power.html and power.json: which scenes and laws notice which known mistake."""

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


class LawKill(Frozen):
    """A law that a tracer breaks, by how many tolerances (None: none was tolerated)."""

    law: str
    excess: float | None


class FaultPower(Frozen):
    """One fault before all scenes and laws; fate and reason as the dictionary says."""

    name: str
    group: str
    fate: Literal["killed", "survives", "equivalent"]
    reason: str
    kills: tuple[SceneKill, ...]
    laws: tuple[LawKill, ...]

    @property
    def worst(self) -> float:
        """The most tolerances by which a scene fails it; 0 for none, inf where none is tolerated."""
        return max((inf if kill.excess is None else kill.excess for kill in self.kills), default=0.0)


class TwinPower(Frozen):
    """One correct tracer, and the scenes and laws that wrongly fail it."""

    name: str
    how: str
    kills: tuple[SceneKill, ...]
    laws: tuple[LawKill, ...]

    @property
    def failed_by(self) -> tuple[str, ...]:
        """Names of those scenes and laws."""
        return (*(kill.scene for kill in self.kills), *(kill.law for kill in self.laws))


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
    laws: tuple[str, ...]
    faults: tuple[FaultPower, ...]
    twins: tuple[TwinPower, ...]

    @property
    def missed(self) -> tuple[FaultPower, ...]:
        """Faults that no scene notices although the dictionary says that one does."""
        return tuple(fault for fault in self.faults if not fault.kills and fault.fate == "killed")

    @property
    def refuted(self) -> tuple[FaultPower, ...]:
        """Faults that a scene or a law notices although the dictionary says that none can."""
        return tuple(fault for fault in self.faults if (fault.kills or fault.laws) and fault.fate == "equivalent")

    @property
    def wronged(self) -> tuple[TwinPower, ...]:
        """Correct tracers that a scene or a law fails."""
        return tuple(twin for twin in self.twins if twin.failed_by)

    @property
    def idle(self) -> tuple[str, ...]:
        """Scenes and laws that notice no fault."""
        used = {kill.scene for fault in self.faults for kill in fault.kills}
        used |= {kill.law for fault in self.faults for kill in fault.laws}
        return tuple(check for check in (*self.scenes, *self.laws) if check not in used)

    @property
    def holds(self) -> bool:
        """Every fault is noticed or excused with a reason, no correct tracer is failed, no scene or law is idle."""
        return not (self.missed or self.refuted or self.wronged or self.idle)


def lines(found: Power) -> Iterator[str]:
    """One line a fault, then what is wrong, then the sum."""
    yield f"{'fault':<40} {'scenes':>6} {'laws':>5} {'tolerances':>11}  first scene and law"
    for fault in found.faults:
        worst = measured.number(fault.worst)
        yield f"{fault.name:<40} {len(fault.kills):>6} {len(fault.laws):>5} {worst:>11}  {_first(fault)}"
    yield from (f"MISSED: no scene notices {fault.name}" for fault in found.missed)
    for fault in found.refuted:
        yield f"REFUTED: {_first(fault)} notices {fault.name}, said to be equivalent"
    for twin in found.wronged:
        yield f"WRONGED: {twin.failed_by[0]} fails {twin.name}, which is correct ({twin.how})"
    yield from (f"IDLE: {check} notices no fault" for check in found.idle)
    noticed = sum(bool(fault.kills) for fault in found.faults)
    by_laws = sum(bool(fault.laws) for fault in found.faults)
    yield (
        f"{noticed} of {len(found.faults)} faults are noticed on {len(found.scenes)} scenes ({found.size}), "
        f"{by_laws} by {len(found.laws)} laws; "
        f"{len(found.wronged)} of {len(found.twins)} correct tracers are failed"
    )


def _first(fault: FaultPower) -> str:
    """The first scene and law that notice it, else why none does."""
    names = [kill.scene for kill in fault.kills[:1]] + [kill.law for kill in fault.laws[:1]]
    return ", ".join(names) or (f"{fault.fate}: {fault.reason}" if fault.reason else "-")


def schema() -> str:
    """The published JSON Schema."""
    return json.dumps(Power.model_json_schema(), indent=2) + "\n"


def write(found: Power, folder: Path) -> Path:
    """Write both files whole or not at all; return the page's path."""
    write_whole(folder / DATA, (found.model_dump_json(indent=1) + "\n").encode())
    write_whole(folder / FILE, measured.page(FILE, found=found, said=list(lines(found))[-1]).encode())
    return folder / FILE
