"""EXR images, decoded by OpenEXR after the header has been checked."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Iterator

import numpy as np

from oracles.images.picture import ImageError, Picture, check_size


def decode(data: bytes, expected: tuple[int, int]) -> Picture:
    """The RGB of an EXR file of the expected (width, height); raise ImageError saying what is wrong."""
    import OpenEXR

    try:
        file = OpenEXR.File(io.BytesIO(data), header_only=True)
        parts, header = len(file.parts), file.header()
        low, high = header["dataWindow"]
        width, height = int(high[0]) - int(low[0]) + 1, int(high[1]) - int(low[1]) + 1
        sampled = {channel.name: (channel.xSampling, channel.ySampling) for channel in header["channels"]}
        kind = header.get("type", OpenEXR.scanlineimage)
    except Exception as error:  # whatever the library makes of hostile bytes
        raise ImageError(f"not an EXR file ({error})", "the header") from None
    check_size(width, height, expected)
    if parts != 1:
        raise ImageError(f"EXR of {parts} parts", "the header", "one part")
    missing = [name for name in "RGB" if name not in sampled]
    if missing:
        raise ImageError(f"channel {missing[0]} is missing (has {', '.join(sampled) or 'none'})", "the header", "R G B")
    if kind not in (OpenEXR.scanlineimage, OpenEXR.tiledimage) or any(sampled[c] != (1, 1) for c in "RGB"):
        raise ImageError("deep or subsampled EXR", "the header", "full-resolution scanlines or tiles")
    if len(sampled) > 16:
        raise ImageError(f"{len(sampled)} channels", "the header", "R G B")
    try:
        with _stdout_closed():
            channels = OpenEXR.File(io.BytesIO(data), separate_channels=True).channels()
        planes = [np.asarray(channels[name].pixels) for name in "RGB"]
    except Exception as error:  # whatever the library makes of hostile bytes
        raise ImageError(f"truncated or damaged EXR ({error})", "the pixels") from None
    if any(plane.shape != (height, width) or plane.dtype.kind != "f" for plane in planes):
        raise ImageError("EXR channels of another size or kind", "the pixels", "half or float")
    roundoff = max(2.0**-11 if plane.dtype == np.float16 else 2.0**-24 for plane in planes)
    return Picture(np.stack(planes, axis=-1).astype(np.float64), roundoff=roundoff)


@contextlib.contextmanager
def _stdout_closed() -> Iterator[None]:
    """Keep the library from printing its warnings about damaged files among our output."""
    sys.stdout.flush()
    kept = os.dup(1)
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 1)
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
