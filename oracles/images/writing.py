"""Writing images: linear where the format can, display-encoded where it cannot."""

from __future__ import annotations

import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.images.picture import ENDINGS, ImageError
from reference_tracer.formulas.display import encode
from scenes.disk import write_whole

Pixels = NDArray[np.floating[Any]]


def write(path: Path, pixels: Pixels, display: str) -> None:
    """Write linear pixels (height, width, 3) by the ending of `path`, whole or not at all.

    .exr .pfm: float32; .npy: as given; .ppm .png: 8 bit, encoded as `display` says.
    """
    encoder = _ENCODERS.get(path.suffix.removeprefix("."))
    if encoder is None:
        raise ImageError(f"unknown image ending {path.suffix!r}", str(path), ", ".join("." + e for e in ENDINGS))
    write_whole(path, encoder(pixels, display))


def png_bytes(codes: NDArray[np.integer[Any]]) -> bytes:
    """An 8-bit PNG of codes (height, width, 3)."""
    from PIL import Image

    stream = io.BytesIO()
    Image.fromarray(codes.astype(np.uint8)).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def _pfm(pixels: Pixels, display: str) -> bytes:
    height, width, _ = pixels.shape
    return b"PF\n%d %d\n-1.0\n" % (width, height) + pixels[::-1].astype("<f4").tobytes()


def _npy(pixels: Pixels, display: str) -> bytes:
    stream = io.BytesIO()
    np.save(stream, pixels, allow_pickle=False)
    return stream.getvalue()


def _ppm(pixels: Pixels, display: str) -> bytes:
    height, width, _ = pixels.shape
    return b"P6\n%d %d\n255\n" % (width, height) + encode(pixels, display).astype(np.uint8).tobytes()


def _png(pixels: Pixels, display: str) -> bytes:
    return png_bytes(encode(pixels, display))


def _exr(pixels: Pixels, display: str) -> bytes:
    import tempfile

    import OpenEXR

    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    with tempfile.TemporaryDirectory(prefix="raycheck-") as folder:
        name = os.path.join(folder, "image.exr")
        OpenEXR.File(header, {"RGB": np.ascontiguousarray(pixels, dtype=np.float32)}).write(name)
        return Path(name).read_bytes()


_ENCODERS: dict[str, Callable[[Pixels, str], bytes]] = {
    "pfm": _pfm,
    "npy": _npy,
    "ppm": _ppm,
    "png": _png,
    "exr": _exr,
}
