"""Which libLLVM DrJit may load, found out in a child process.

DrJit takes the first libLLVM of the system; versions 14 to 16 abort the whole
process on ordinary kernels. So each candidate runs a small kernel in a child
once, the answer is remembered by file and version, and this process only ever
loads one that worked.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from pathlib import Path

from scenes.disk import write_whole

FOLDERS = (
    "/usr/lib",
    "/usr/lib64",
    "/usr/local/lib",
    "/usr/lib/x86_64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/usr/lib/llvm-*/lib",
    "/opt/homebrew/opt/llvm/lib",
)
PROBE = """
import drjit as dr
from drjit.llvm import Float64, Float, Int32
for T in (Float, Float64):
    x = dr.opaque(T, 2.0, 40) + T(dr.arange(Int32, 40))
    y = dr.while_loop((Int32(0), x), lambda k, x: k < 3, lambda k, x: (k + 1, dr.select(x > 3, dr.sqrt(x), x * x)))[1]
    dr.eval(dr.minimum(dr.maximum(y, 0), x), dr.compress(y > 1))
print("works")
"""
REMEDY = "apt-get install libllvm19, or set DRJIT_LIBLLVM_PATH to a libLLVM 17 or newer"


@dataclass(frozen=True)
class NoLLVMError(Exception):
    """No libLLVM that DrJit can use."""

    tried: tuple[str, ...]

    def __str__(self) -> str:
        tried = ", ".join(self.tried) or "none found"
        return f"DrJit lanes need a libLLVM that works (tried: {tried}); {REMEDY}"


@cache
def find() -> str | None:
    """Path of a libLLVM that passed the probe, or None; the DRJIT_LIBLLVM_PATH of the caller goes first."""
    return next((path for path in candidates() if works(path)), None)


def use() -> None:
    """Let DrJit load the one that works; raise NoLLVMError if there is none."""
    path = find()
    if path is None:
        raise NoLLVMError(tuple(candidates()))
    os.environ["DRJIT_LIBLLVM_PATH"] = path


def candidates() -> list[str]:
    """LibLLVM files of this machine, newest first, the caller's choice before all."""
    chosen = os.environ.get("DRJIT_LIBLLVM_PATH")
    found = {str(path.resolve()): path for path in _files()}
    newest = sorted(found, key=lambda path: _version(Path(path).name), reverse=True)
    return ([chosen] if chosen else []) + [path for path in newest if path != chosen]


def _files() -> Iterator[Path]:
    for folder in FOLDERS:
        root, _, pattern = folder.partition("*")
        bases = Path(root).parent.glob(Path(root).name + "*" + pattern) if pattern or "*" in folder else [Path(folder)]
        for base in bases:
            for name in ("libLLVM*.so*", "libLLVM*.dylib"):
                yield from base.glob(name)


def _version(name: str) -> int:
    digits = re.search(r"(\d+)", name.removeprefix("libLLVM"))
    return int(digits.group(1)) if digits else 0


def works(path: str) -> bool:
    """Does a small kernel run with this libLLVM? Remembered between processes by file, size and time."""
    try:
        stat = Path(path).stat()
    except OSError:
        return False
    key = f"{path}:{stat.st_size}:{stat.st_mtime_ns}:{metadata.version('drjit')}"
    memory = _memory()
    if key not in memory:
        memory[key] = _probe(path)
        _remember(memory)
    return memory[key]


def _probe(path: str) -> bool:
    environment = {**os.environ, "DRJIT_LIBLLVM_PATH": path}
    try:
        child = subprocess.run(
            [sys.executable, "-P", "-c", PROBE], env=environment, capture_output=True, timeout=60, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return child.returncode == 0 and b"works" in child.stdout


def cache_folder() -> Path:
    """Where raycheck keeps what it may forget."""
    base = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return Path(base) / "raycheck"


def _memory() -> dict[str, bool]:
    try:
        data = json.loads((cache_folder() / "llvm.json").read_text("utf-8"))
    except (OSError, ValueError):
        return {}
    return {k: v for k, v in data.items() if isinstance(v, bool)} if isinstance(data, dict) else {}


def _remember(memory: dict[str, bool]) -> None:
    try:
        cache_folder().mkdir(parents=True, exist_ok=True)
        write_whole(cache_folder() / "llvm.json", json.dumps(memory).encode())
    except OSError:
        pass  # a cache that cannot be written costs half a second the next time
