"""What a golden is on disk: four files a scene, and one manifest that names and hashes them.

NAME.exr: float32 layers for people and tools (R G B, bound, decided, depth, normal, object);
NAME.npz: the full-precision values and bounds; NAME.png: a preview; NAME.json: the scene.
A scene counts only once the manifest has its entry, and the manifest is replaced whole.
"""

from __future__ import annotations

import hashlib
import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationError

from oracles.verdict import Frozen
from reference_tracer.dialects import Dialect
from scenes.disk import read_bounded, write_whole
from scenes.errors import SceneError
from scenes.files import load as load_scene
from scenes.model import Scene

MANIFEST = "manifest.json"
ENDINGS = ("exr", "npz", "png", "json")
MAX_MANIFEST = 16 * 2**20


class GoldenError(Exception):
    """A golden that cannot be used, and why."""


class Entry(Frozen):
    """One scene's golden: the scene it was made of, its files, and how well it is known."""

    scene_hash: str
    files: dict[str, str]
    largest_bound: float
    undecided_pixels: int
    bits: int


class Manifest(Frozen):
    """All goldens of a folder, and by what they were made."""

    format: Literal[1] = 1
    suite: str
    machine: str
    packages: dict[str, str]
    command: str
    dialect: dict[str, bool | str] = Field(default_factory=dict)
    goldens: dict[str, Entry]

    def spoken(self) -> Dialect:
        """The dialect that the goldens follow; raise GoldenError where there is none of that name."""
        try:
            return Dialect(**self.dialect)  # type: ignore[arg-type]
        except (TypeError, ValueError) as error:
            raise GoldenError(f"dialect: {error}") from None


@dataclass(frozen=True)
class Golden:
    """A scene with its stored truth under a dialect: |truth - value| <= bound, (height, width, 3)."""

    scene: Scene
    dialect: Dialect
    value: NDArray[np.float64]
    bound: NDArray[np.float64]
    decided: NDArray[np.bool_]


def hash_of(data: bytes) -> str:
    """SHA-256, in hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a folder; raise GoldenError if there is none that this version reads."""
    path = folder / MANIFEST
    try:
        data = read_bounded(path, MAX_MANIFEST)
    except OSError as error:
        raise GoldenError(f"{path}: {error.strerror}; expected a folder written by `raycheck golden make`") from None
    try:
        return Manifest.model_validate_json(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(str(part) for part in first["loc"]) or "the file"
        raise GoldenError(f"{path}: {place}: {first['msg']}; expected goldens of format 1") from None


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Replace the manifest."""
    write_whole(folder / MANIFEST, (manifest.model_dump_json(indent=1) + "\n").encode())


def changed_file(folder: Path, name: str, entry: Entry) -> str | None:
    """The first file of an entry that is missing or not as written, in words."""
    for ending in ENDINGS:
        path = folder / f"{name}.{ending}"
        try:
            data = path.read_bytes() if path.is_file() and not path.is_symlink() else None
        except OSError as error:
            return f"{path.name}: {error.strerror}"
        if data is None:
            return f"{path.name}: missing"
        if hash_of(data) != entry.files.get(ending):
            return f"{path.name}: not as it was written (its hash differs)"
    return None


def load(path: Path) -> Golden:
    """The golden whose .exr, .npz, .png or .json is named, its files checked against the manifest."""
    manifest = read_manifest(path.parent)
    entry = manifest.goldens.get(path.stem)
    if entry is None:
        known = ", ".join(list(manifest.goldens)[:5])
        raise GoldenError(f"{path}: no golden {path.stem!r} in the manifest (it has {known}, ...)")
    problem = changed_file(path.parent, path.stem, entry)
    if problem:
        raise GoldenError(problem)
    try:
        scene = load_scene(path.with_suffix(".json"))
        with np.load(io.BytesIO(path.with_suffix(".npz").read_bytes()), allow_pickle=False) as stored:
            return Golden(scene, manifest.spoken(), stored["value"], stored["bound"], stored["decided"])
    except (SceneError, OSError, ValueError, KeyError, zipfile.BadZipFile) as error:
        raise GoldenError(f"{path}: {error}") from None
