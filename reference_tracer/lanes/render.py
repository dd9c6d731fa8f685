"""Whole images on lanes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer.image import Image
from reference_tracer.lanes.affine import Affine
from reference_tracer.lanes.backend import Backend, leaves
from reference_tracer.lanes.balls import Balls
from reference_tracer.lanes.branches import hull
from reference_tracer.lanes.floats import Floats, Numbers
from reference_tracer.lanes.margins import Margins
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.tables import Tables
from reference_tracer.lanes.wavefront import Wavefront
from reference_tracer.rulebook import LECTURE, Rulebook
from scenes.model import Scene

WIDE = 3e-4
"""Pixels with a larger radius are looked at again with affine forms; it decides about time, not about truth."""

SINGLE = 2.0**-40
"""A tracer with a larger roundoff reads a scene's numbers into float32."""

Progress = Callable[[float], Any]


@dataclass(frozen=True)
class Enclosure:
    """An image with what may be said about it at some unit roundoff.

    pixels: (height, width, 3), the midpoint, equal to the float64 lanes bit for bit;
    radius: (height, width, 3), how far a tracer of that roundoff may lie from it;
    doubts: (height, width), the kinds of decisions on its path that the roundoff cannot make
    (HIT, SHADOW, CRITICAL of the wavefront), 0 where all are certain.
    """

    pixels: NDArray[np.float64]
    radius: NDArray[np.float64]
    doubts: NDArray[np.int64]


def backend(name: str, precision: int) -> Backend:
    """NumPy or DrJit lanes; DrJit raises if no libLLVM that works is found."""
    if name == "numpy":
        return NumPyBackend(precision)
    from reference_tracer import llvm

    llvm.use()
    from reference_tracer.lanes.drjit_backend import DrJitBackend

    return DrJitBackend(precision)


def render(scene: Scene, lanes: Backend, rules: Rulebook = LECTURE, progress: Progress = lambda share: None) -> Image:
    """Render on these lanes; pixels (height, width, 3), linear, in the lanes' precision."""
    columns = _columns(scene, lanes, rules, Floats(), progress)
    return Image(_picture(scene, columns))


def enclose(
    scene: Scene,
    lanes: Backend,
    u: float,
    offset: float,
    rules: Rulebook = LECTURE,
    progress: Progress = lambda share: None,
) -> Enclosure:
    """Render on ball lanes (float64) for a tracer of unit roundoff u.

    Scene numbers are taken as that tracer reads them: rounded to float32 unless u is below
    2^-40; offset: how far from its start a ray may lawfully fail to see a surface.
    """
    balls = Balls(u, scene, rules, lanes, single=u > SINGLE, offset=offset)
    columns = _columns(scene, lanes, rules, balls, progress)
    mids, radii, doubts = columns[0:6:2], columns[1:6:2], columns[6]
    height, width = scene.image.height, scene.image.width
    return Enclosure(_picture(scene, mids), _picture(scene, radii), doubts.reshape(height, width).astype(np.int64))


def render_pixels(scene: Scene, pixels: NDArray[np.int64], rules: Rulebook = LECTURE) -> NDArray[np.float64]:
    """Some pixels only, counted row by row, on NumPy float64 lanes: (1, pixels, 3)."""
    lanes = NumPyBackend(64)
    front = Wavefront(scene, rules, lanes, Floats(), Tables(scene, lanes))
    with np.errstate(all="ignore"):
        colour, _ = front.colours(pixels)
    return np.stack(np.broadcast_arrays(*colour), axis=-1)[None]


def narrow(scene: Scene, found: Enclosure, u: float, offset: float, rules: Rulebook = LECTURE) -> Enclosure:
    """The same enclosure, its wide and doubtful pixels looked at again with affine forms and all their branches."""
    lanes = NumPyBackend(64)
    forms = Balls(u, scene, rules, lanes, single=u > SINGLE, offset=offset, ball=Affine)
    front = Wavefront(scene, rules, lanes, forms, Tables(scene, lanes), hull)
    radius, doubts = found.radius.reshape(-1, 3).copy(), found.doubts.ravel().copy()
    wanted = np.flatnonzero((doubts != 0) | (radius.max(axis=1) > WIDE))
    tile = tile_size(scene, lanes)
    with np.errstate(all="ignore"):
        for begin in range(0, wanted.size, tile):
            pixels = wanted[begin : begin + tile]
            colour, again = front.colours(pixels)
            doubts[pixels] &= again
            radius[pixels] = np.fmin(radius[pixels], np.stack([part.rad for part in colour], axis=-1))
    return Enclosure(found.pixels, radius.reshape(found.radius.shape), doubts.reshape(found.doubts.shape))


def margins(scene: Scene, rules: Rulebook = LECTURE) -> NDArray[np.float64]:
    """The smallest decision margin on each pixel's path, (height, width); inf where nothing was decided."""
    watching = Margins(rules)
    columns = _columns(scene, NumPyBackend(64), watching.rules(), watching, lambda share: None)
    with np.errstate(divide="ignore"):
        return (1.0 / columns[3]).reshape(scene.image.height, scene.image.width)


@dataclass(frozen=True)
class FirstHits:
    """What each eye ray meets first: distance (inf: nothing), outward normal, the object's place in the scene (-1)."""

    distance: NDArray[np.float64]
    normal: NDArray[np.float64]
    thing: NDArray[np.int64]


def first_hits(scene: Scene, rules: Rulebook = LECTURE) -> FirstHits:
    """The first hits of all eye rays, on NumPy float64 lanes."""
    lanes = NumPyBackend(64)
    front = Wavefront(scene, rules, lanes, Floats(), Tables(scene, lanes))
    height, width = scene.image.height, scene.image.width
    with np.errstate(all="ignore"):
        distance, normal, row = front.first_hits(0, width * height)
    order = scene.tie_order or (-1,)
    thing = np.where(row >= 0, np.array(order)[np.maximum(row, 0)], -1)
    return FirstHits(
        distance.reshape(height, width),
        np.stack(normal, axis=-1).reshape(height, width, 3),
        thing.reshape(height, width),
    )


def _picture(scene: Scene, columns: list[NDArray[Any]]) -> NDArray[Any]:
    return np.stack(columns, axis=-1).reshape(scene.image.height, scene.image.width, 3)


def _columns(scene: Scene, lanes: Backend, rules: Rulebook, numbers: Numbers, progress: Progress) -> list[NDArray[Any]]:
    """The leaves of the colours of all pixels, tile by tile."""
    front = Wavefront(scene, rules, lanes, numbers, Tables(scene, lanes))
    total = scene.image.width * scene.image.height
    tile = tile_size(scene, lanes)
    parts = []
    with np.errstate(all="ignore"):  # lanes that have nothing to compute may divide by zero
        for begin in range(0, total, tile):
            end = min(begin + tile, total)
            parts.append([lanes.numpy(leaf) for leaf in leaves(front.colours(lanes.indices(begin, end)))])
            progress(end / total)
    if len(parts) == 1:
        return parts[0]
    return [np.concatenate(column) for column in zip(*parts, strict=True)]


def tile_size(scene: Scene, lanes: Backend) -> int:
    """Rays of a tile: fewer where both branches can double a generation, so that memory stays bounded."""
    splits = any(any(m.reflect) and any(m.transmit) for m in scene.materials.values())
    return max(64, lanes.tile >> max(0, scene.depth - 3)) if splits else lanes.tile
