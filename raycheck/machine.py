"""The machine line: where numbers were taken."""

from __future__ import annotations

import os
import platform
import re
from importlib import metadata
from pathlib import Path

from raycheck.lanes import best_lanes
from raycheck.memory import physical
from reference_tracer import llvm
from reports.results import Machine

PACKAGES = ("numpy", "drjit", "mitsuba", "OpenEXR", "pydantic")


def machine() -> Machine:
    """This machine, as the report states it."""
    return Machine(
        processor=_processor(),
        cores=len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1,
        memory_gib=round(physical() / 2**30, 1),
        system=f"{platform.system()} {platform.release()}",
        python=platform.python_version(),
        packages={name: version for name in PACKAGES if (version := _version(name))},
        lanes=_lanes(),
    )


def _processor() -> str:
    try:
        found = re.search(r"model name\s*:\s*(.+)", Path("/proc/cpuinfo").read_text("utf-8"))
    except OSError:
        found = None
    return found.group(1).strip() if found else platform.processor() or platform.machine()


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _lanes() -> str:
    if best_lanes() == "numpy":
        return "NumPy"
    return f"DrJit with {Path(llvm.find() or '').name}"
