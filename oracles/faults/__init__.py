"""The dictionary of faults: known mistakes as rulebooks with a wrong entry, and correct tracers that differ.

No tracer has a flag for any of them. docs/faults.md is written from here.
"""

from __future__ import annotations

import difflib
from functools import cache

from oracles.faults import branches, camera, files, fresnel, glass, highlights, lights, numbers, spheres, sums, surfaces
from oracles.faults.fault import Fault, Twin
from oracles.faults.twins import TWINS

FAULTS: tuple[Fault, ...] = (
    *camera.FAULTS,
    *spheres.FAULTS,
    *surfaces.FAULTS,
    *lights.FAULTS,
    *sums.FAULTS,
    *highlights.FAULTS,
    *glass.FAULTS,
    *fresnel.FAULTS,
    *branches.FAULTS,
    *files.FAULTS,
    *numbers.FAULTS,
)
"""All entries, in the lecture's order."""


@cache
def _by_name() -> dict[str, Fault]:
    return {fault.name: fault for fault in FAULTS}


def fault(name: str) -> Fault:
    """The entry of that name; raise KeyError with the nearest names."""
    found = _by_name().get(name)
    if found is None:
        close = difflib.get_close_matches(name, _by_name(), n=3, cutoff=0.3) or list(_by_name())[:3]
        raise KeyError(", ".join(close))
    return found


__all__ = ["FAULTS", "TWINS", "Fault", "Twin", "fault"]
