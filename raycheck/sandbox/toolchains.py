"""Folders of compilers and interpreters that live outside /usr: the jail shows them, read only."""

from __future__ import annotations

import os
import shutil
import subprocess
from functools import cache
from pathlib import Path

_ASKED = (
    ("rustc", ("--print", "sysroot")),
    ("go", ("env", "GOROOT")),
    ("python3", ("-S", "-c", "import sys; print(sys.base_prefix)")),
)
"""Programs that tell the folder they live in."""
_FOUND = ("java", "node")
"""Programs whose folder is the one above their bin."""
_STANDARD = ("/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin", "/sbin", "/bin")


@cache
def folders() -> tuple[Path, ...]:
    """The folders of the toolchains that are installed."""
    told = [_told(name, words) for name, words in _ASKED] + [_above(name) for name in _FOUND]
    found = [folder for folder in told if folder is not None and (folder / "bin").is_dir()]
    return tuple(dict.fromkeys(found))


def search_path() -> str:
    """PATH of the jail: the toolchains, then the system's."""
    return os.pathsep.join([*(str(f / "bin") for f in folders() if str(f / "bin") not in _STANDARD), *_STANDARD])


def _told(name: str, words: tuple[str, ...]) -> Path | None:
    try:
        done = subprocess.run([name, *words], capture_output=True, text=True, timeout=20, check=True)
    except (OSError, subprocess.SubprocessError):
        return None
    told = done.stdout.strip()
    return Path(told).resolve() if told.startswith("/") else None


def _above(name: str) -> Path | None:
    path = shutil.which(name)
    return Path(path).resolve().parent.parent if path else None
