"""Do goldens still stand: made of today's scenes, unchanged, and confirmed by computing them again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from oracles.golden.record import Entry, GoldenError, changed_file, load, read_manifest
from reference_tracer import certified
from reference_tracer.dialects import rules
from reference_tracer.lanes import render as lanes
from scenes.model import Scene

Told = Callable[[str, int, int], Any]


def verify(folder: Path, today: Callable[[str], Scene | None], backend: str, told: Told) -> dict[str, str]:
    """What is wrong with each golden, by name; empty if all stand.

    today(name): the scene of that name as it is now, None if it is not of the catalogue.
    """
    manifest = read_manifest(folder)
    problems = {}
    for done, (name, entry) in enumerate(manifest.goldens.items(), start=1):
        problem = _problem(folder, name, entry, today(name), backend)
        if problem:
            problems[name] = problem
        told(name, done, len(manifest.goldens))
    return problems


def _problem(folder: Path, name: str, entry: Entry, today: Scene | None, backend: str) -> str | None:
    changed = changed_file(folder, name, entry)
    if changed:
        return changed
    try:
        golden = load(folder / f"{name}.npz")
    except GoldenError as error:
        return str(error)
    if golden.scene.content_hash() != entry.scene_hash:
        return "its scene is not the one it was made of"
    if today is not None and today.resized(*_size(golden.scene)).content_hash() != entry.scene_hash:
        return "stale: the catalogue's scene has changed since"
    found = certified.render(golden.scene, lanes.backend(backend, 64), rules(golden.dialect))
    if golden.value.shape != found.value.shape:
        return f"its picture has shape {golden.value.shape}, not {found.value.shape}"
    apart = np.abs(golden.value - found.value) > golden.bound + found.bound
    if apart.any():
        j, i, channel = (int(x) for x in np.argwhere(apart)[0])
        return f"pixel ({i}, {j}) {'RGB'[channel]} is not what is computed now: {golden.value[j, i, channel]:.17g}"
    return None


def _size(scene: Scene) -> tuple[int, int]:
    return scene.image.width, scene.image.height
