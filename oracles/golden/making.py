"""Making goldens: certified pictures, written so that a kill at any moment leaves no half golden."""

from __future__ import annotations

import io
import os
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.golden.record import (
    Entry,
    GoldenError,
    Manifest,
    changed_file,
    hash_of,
    read_manifest,
    write_manifest,
)
from oracles.images.writing import png_bytes
from reference_tracer import certified
from reference_tracer.dialects import Dialect, rules
from reference_tracer.formulas.display import encode
from reference_tracer.lanes import render as lanes
from scenes.disk import write_whole
from scenes.json_form import to_json
from scenes.model import Scene

Told = Callable[[str, int, int], Any]


def make(folder: Path, scenes: Iterable[Scene], made_by: Manifest, backend: str, jobs: int, told: Told) -> Manifest:
    """Goldens of these scenes; those that already stand in the folder are kept.

    made_by: provenance, its goldens empty; told(name, done, all) is called as each is finished.
    """
    kept = _standing(folder, made_by)
    wanted = list(scenes)
    open_scenes = [s for s in wanted if not _stands(folder, kept.get(s.name), s)]
    done = len(wanted) - len(open_scenes)
    manifest = made_by.model_copy(update={"goldens": kept})
    for name, entry in _entries(folder, open_scenes, made_by.spoken(), backend, jobs):
        manifest = manifest.model_copy(update={"goldens": {**manifest.goldens, name: entry}})
        write_manifest(folder, manifest)
        done += 1
        told(name, done, len(wanted))
    write_manifest(folder, manifest)
    return manifest


def _standing(folder: Path, made_by: Manifest) -> dict[str, Entry]:
    """The goldens already there, if the same suite made them."""
    try:
        before = read_manifest(folder)
    except GoldenError:
        return {}
    return before.goldens if (before.suite, before.dialect) == (made_by.suite, made_by.dialect) else {}


def _stands(folder: Path, entry: Entry | None, scene: Scene) -> bool:
    return (
        entry is not None
        and entry.scene_hash == scene.content_hash()
        and changed_file(folder, scene.name, entry) is None
    )


def _entries(
    folder: Path, scenes: list[Scene], dialect: Dialect, backend: str, jobs: int
) -> Iterable[tuple[str, Entry]]:
    if jobs == 1 or len(scenes) < 2:
        for scene in scenes:
            yield scene.name, _one(folder, scene, dialect, backend)
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        waiting = {pool.submit(_one, folder, scene, dialect, backend): scene.name for scene in scenes}
        for future in as_completed(waiting):
            yield waiting[future], future.result()


def _one(folder: Path, scene: Scene, dialect: Dialect, backend: str) -> Entry:
    """Certify one scene and write its four files."""
    found = certified.render(scene, lanes.backend(backend, 64), rules(dialect))
    first = lanes.first_hits(scene, rules(dialect))
    contents = {
        "exr": _layers(found, first),
        "npz": _full(found),
        "png": png_bytes(encode(found.value, scene.display)),
        "json": to_json(scene).encode(),
    }
    for ending, data in contents.items():
        write_whole(folder / f"{scene.name}.{ending}", data)
    return Entry(
        scene_hash=scene.content_hash(),
        files={ending: hash_of(data) for ending, data in contents.items()},
        largest_bound=float(found.bound.max()),
        undecided_pixels=int((~found.decided).sum()),
        bits=int(found.bits.max()),
    )


def _full(found: certified.Certified) -> bytes:
    stream = io.BytesIO()
    np.savez_compressed(
        stream, value=found.value, bound=found.bound, decided=found.decided, bits=found.bits, margin=found.margin
    )
    return stream.getvalue()


def _layers(found: certified.Certified, first: lanes.FirstHits) -> bytes:
    """A float32 EXR; the rounding of the values to float32 is added to the bound."""
    import OpenEXR

    stored = found.value.astype(np.float32)
    bound = np.nextafter((np.abs(stored - found.value) + found.bound).astype(np.float32), np.float32(np.inf))
    channels: dict[str, NDArray[np.float32]] = {}
    for k, name in enumerate("RGB"):
        channels[name] = stored[:, :, k]
        channels[f"bound.{name}"] = bound[:, :, k]
    channels["decided.V"] = found.decided.astype(np.float32)
    channels["margin.V"] = found.margin.astype(np.float32)
    channels["depth.Z"] = first.distance.astype(np.float32)
    for k, name in enumerate("XYZ"):
        channels[f"normal.{name}"] = first.normal[:, :, k].astype(np.float32)
    channels["object.id"] = first.thing.astype(np.float32)
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with tempfile.TemporaryDirectory(prefix="raycheck-") as folder:
        name = os.path.join(folder, "golden.exr")
        OpenEXR.File(header, {key: np.ascontiguousarray(plane) for key, plane in channels.items()}).write(name)
        return Path(name).read_bytes()
