"""raycheck doctor: what is there, what is missing, what that costs, and the command that adds it."""

from __future__ import annotations

import shutil
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import dataclass

from raycheck.errors import CONFORMS
from raycheck.machine import machine
from raycheck.sandbox import jail
from reference_tracer import llvm

NO_SANDBOX = "no sandbox: `grade` and `check --sandbox` refuse"


@dataclass(frozen=True)
class Part:
    """One thing the suite can use."""

    name: str
    found: str | None
    without: str
    remedy: str


def run(options: Namespace) -> int:
    """One line a part; missing parts name their remedy."""
    here = machine()
    print(f"machine   {here.processor}, {here.cores} cores, {here.memory_gib} GiB, {here.system}, Python {here.python}")
    print("packages  " + ", ".join(f"{name} {version}" for name, version in here.packages.items()))
    print(f"lanes     {here.lanes}")
    for part in parts():
        print(f"{part.name:<9} {part.found or f'missing: {part.without}; add it with: {part.remedy}'}")
    return CONFORMS


def parts() -> Iterator[Part]:
    """System software, and what each is for."""
    path = llvm.find()
    tried = ", ".join(llvm.candidates()) or "none"
    yield Part("libLLVM", path, f"no DrJit lanes, NumPy serves (unfit: {tried})", "apt-get install libllvm19")
    programs = (
        ("g++", "`raycheck demo` cannot build its examples", "apt-get install g++ make"),
        *((name, NO_SANDBOX, f"apt-get install {package}") for name, package in jail.TOOLS.items()),
        ("chromium", "the report's browser test is skipped", "apt-get install chromium"),
        ("povray", "POV-Ray cannot be a peer", "apt-get install povray"),
    )
    for name, without, remedy in programs:
        yield Part(name, shutil.which(name), without, remedy)
    reason = jail.inspect()
    yield Part("sandbox", None if reason else "works", f"{reason}; `grade` refuses", "a kernel with user namespaces")
