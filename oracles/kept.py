"""Truths kept between runs, by the content of everything that they follow from.

A truth is a function of its scene, the precision, the dialect and the code that computes it; all of them are in
its name, so a kept one is never stale. What cannot be read whole is computed again.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import zipfile
from functools import cache
from pathlib import Path

import numpy as np

import reference_tracer
from oracles import truth as truths
from oracles.truth import Truth
from reference_tracer import dialects
from reference_tracer.dialects import SCENE_MODEL, Dialect
from scenes.disk import read_bounded, write_whole
from scenes.model import Scene

FOLDER_VARIABLE = "RAYCHECK_CACHE"
MOST_BYTES = 2**29
"""All that is kept; the oldest goes first."""
LARGEST = 2**22
"""Pixels of a picture whose truth is kept."""


def truth(scene: Scene, precision: str, backend: str, dialect: Dialect = SCENE_MODEL) -> Truth:
    """The truth of `oracles.truth.truth`, from an earlier run if there is one."""
    if scene.image.width * scene.image.height > LARGEST:
        return truths.truth(scene, precision, backend, dialects.rules(dialect))
    path = folder() / f"{_name(scene, precision, dialect)}.npz"
    found = _read(path, scene, precision)
    if found is None:
        found = truths.truth(scene, precision, backend, dialects.rules(dialect))
        with contextlib.suppress(OSError):  # nothing is lost but time
            _write(path, found)
    return found


def folder() -> Path:
    """Where truths are kept: $RAYCHECK_CACHE, or raycheck in the user's cache."""
    said = os.environ.get(FOLDER_VARIABLE)
    if said:
        return Path(said)
    home = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return Path(home) / "raycheck"


def _name(scene: Scene, precision: str, dialect: Dialect) -> str:
    parts = (scene.content_hash(), precision, *dialect.lines(), _code())
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


@cache
def _code() -> str:
    """A hash of the source that truths are computed by, and of NumPy's version."""
    digest = hashlib.sha256(np.__version__.encode())
    for path in sorted(Path(reference_tracer.__file__).parent.rglob("*.py")):
        digest.update(path.read_bytes())
    digest.update(Path(truths.__file__).read_bytes())
    return digest.hexdigest()


def _read(path: Path, scene: Scene, precision: str) -> Truth | None:
    shape = (scene.image.height, scene.image.width)
    try:
        with np.load(io.BytesIO(read_bounded(path, MOST_BYTES)), allow_pickle=False) as stored:
            pixels, tolerance, doubts = stored["pixels"], stored["tolerance"], stored["doubts"]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return None
    if pixels.shape != (*shape, 3) or tolerance.shape != pixels.shape or doubts.shape != shape:
        return None
    return Truth(scene, precision, pixels, tolerance, doubts.astype(np.int64))


def _write(path: Path, found: Truth) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    _make_room(path.parent)
    stream = io.BytesIO()
    np.savez(stream, pixels=found.pixels, tolerance=found.tolerance, doubts=found.doubts.astype(np.uint8))
    write_whole(path, stream.getvalue())


def _make_room(place: Path) -> None:
    """Remove the oldest truths while all together are too large; others may be at the same."""
    found = []
    for path in place.iterdir():
        with contextlib.suppress(OSError):
            told = path.stat()
            found.append((told.st_mtime, told.st_size, path))
    total = sum(size for _, size, _ in found)
    for _, size, path in sorted(found):
        if total <= MOST_BYTES:
            break
        path.unlink(missing_ok=True)
        total -= size
