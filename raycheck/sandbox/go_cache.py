"""The Go compiler's cache of its own standard library, for jails to read.

A jail's /tmp is empty, so each `go build` in it would compile the library anew: some 15 s. The cache is filled once
by building packages of the library, never by a submission, and a jail sees it read only: Go works on with what it can
read and leaves the rest unwritten.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from oracles import kept
from raycheck.process import own_environment

PACKAGES = (
    *("bufio", "bytes", "container/heap", "container/list", "context", "encoding/binary", "encoding/json", "errors"),
    *("flag", "fmt", "hash/crc32", "image/color", "image/png", "io", "log", "math", "math/bits", "math/cmplx"),
    *("math/rand", "math/rand/v2", "os", "path/filepath", "regexp", "runtime", "slices", "sort", "strconv", "strings"),
    *("sync", "sync/atomic", "time", "unicode"),
)
"""What programs that read a scene and write a picture import."""
PATIENCE = 300.0


def wanted(folders: Sequence[Path]) -> Path | None:
    """The cache, if there is Go and something to build with it in these folders."""
    if any(path.suffix == ".go" for folder in folders for path in folder.rglob("*.go")):
        return _filled()
    return None


@cache
def _filled() -> Path | None:
    """The cache of this version of Go and these packages, made where there is none; None where it cannot be made."""
    with contextlib.suppress(OSError, subprocess.SubprocessError):
        kept_at = kept.folder().absolute()
        place = kept_at.with_name(f"{kept_at.name}-go")
        place.mkdir(parents=True, exist_ok=True)
        version = _go("version")
        name = hashlib.sha256("\n".join((version, *PACKAGES)).encode()).hexdigest()[:16]
        if not (place / name).is_dir():
            _fill(place / name)
        return place / name
    return None


def _fill(folder: Path) -> None:
    """Filled beside its place and moved there whole: a second process that does the same makes the same."""
    making = Path(tempfile.mkdtemp(dir=folder.parent, prefix="making-"))
    try:
        _go("build", *PACKAGES, cache=making)
        making.chmod(0o755)  # the jail's user is another
        with contextlib.suppress(OSError):
            making.rename(folder)
    finally:
        shutil.rmtree(making, ignore_errors=True)


def _go(*words: str, cache: Path | None = None) -> str:
    """A call of Go in a folder without a module; raise OSError or SubprocessError where it fails."""
    environment = own_environment() | ({"GOCACHE": os.fspath(cache)} if cache else {})
    call = ["go", *words]
    done = subprocess.run(call, env=environment, cwd="/", capture_output=True, text=True, timeout=PATIENCE, check=True)
    return done.stdout
