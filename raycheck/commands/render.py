"""raycheck render: a scene through the reference tracer."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

import numpy as np

from oracles.images import ENDINGS, ImageError, write
from raycheck.commands.options import picture_of
from raycheck.errors import CONFORMS, UsageError
from raycheck.lanes import best_lanes
from raycheck.progress import Progress
from reference_tracer import llvm, plain
from reference_tracer.image import Image
from reference_tracer.lanes import render as lanes
from scenes.model import Scene


def run(options: Namespace) -> int:
    """Render and write."""
    path = Path(options.image)
    if path.suffix.removeprefix(".") not in ENDINGS:
        raise UsageError(f"{path}: unknown image ending {path.suffix!r}", ", ".join("." + e for e in ENDINGS))
    if not path.parent.is_dir():
        raise UsageError(f"{path.parent}: no such folder")
    scene = _scene(options)
    progress = Progress(f"rendering {scene.name}", 1)
    try:
        image = _image(scene, options.arithmetic or best_lanes(), options.precision, progress)
    except llvm.NoLLVMError as error:
        raise UsageError(str(error)) from None
    finally:
        progress.close()
    try:
        write(path, image.pixels, scene.display)
    except (OSError, ImageError) as error:
        raise UsageError(f"{path}: {error}") from None
    return CONFORMS


def _scene(options: Namespace) -> Scene:
    scene = picture_of(options.scene, options.size)
    if options.depth is None:
        return scene
    if not 0 <= options.depth <= 16:
        raise UsageError(f"--depth {options.depth}: out of range", "0 to 16")
    return scene.with_depth(options.depth)


def _image(scene: Scene, arithmetic: str, precision: int, progress: Progress) -> Image:
    if arithmetic in ("numpy", "drjit"):
        return lanes.render(scene, lanes.backend(arithmetic, precision), progress=progress.share)
    if precision != 64:
        raise UsageError(f"the {arithmetic} tracer computes in 64 bits or more", "--arithmetic numpy or drjit for 32")
    if arithmetic == "plain":
        return plain.render(scene, progress=progress.share)
    return _certified(scene, arithmetic, progress)


def _certified(scene: Scene, arithmetic: str, progress: Progress) -> Image:
    """An image with its proof, of which the proof is told on stderr."""
    from reference_tracer import certified

    if arithmetic == "exact":
        found = certified.render_exact(scene, progress=progress.share)
    else:
        found = certified.render(scene, lanes.backend(best_lanes(), 64), progress=progress.share)
    progress.close()
    open_pixels = int((~found.decided).sum())
    print(
        f"{scene.name}: every value proved to {found.bound.max():.2g} (median {np.median(found.bound):.2g}), "
        f"at most {found.bits.max()} bits, {open_pixels} pixels are hulls of undecided branches; "
        f"the closest decision has the margin {found.margin.min():.2g}",
        file=sys.stderr,
    )
    return Image(found.value)
