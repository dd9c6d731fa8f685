"""Reading a tracer's image: hostile bytes until proved otherwise.

Order of the checks: a regular file, not through a link, not longer than any lawful encoding of
the expected size; then the header; then the pixels. Nothing is allocated on a header's word.
"""

from __future__ import annotations

import io
import math
import os
import stat
import warnings
import zlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from oracles.images import exr
from oracles.images.picture import ENDINGS, ImageError, Picture, check, check_size

HEADER_ROOM = 2**20
Size = tuple[int, int]


def read(path: Path, width: int, height: int) -> Picture:
    """The image at `path`, which must be width x height; raise ImageError saying what is wrong."""
    decode = _DECODERS.get(path.suffix.removeprefix("."))
    if decode is None:
        raise ImageError(f"unknown image ending {path.suffix!r}", hint=", ".join("." + e for e in ENDINGS))
    # The widest lawful encoding is plain PPM: up to 6 characters a value, and a blank
    data = _read_regular(path, HEADER_ROOM + width * height * 3 * 8)
    # Signalling NaNs and the libraries' remarks about odd headers are no news: the checks decide
    with np.errstate(invalid="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return check(decode(data, (width, height)))


def _read_regular(path: Path, limit: int) -> bytes:
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:
        raise ImageError("no image was written") from None
    except OSError as error:
        raise ImageError(f"the image cannot be opened ({error.strerror})", hint="a regular file") from None
    try:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode):
            raise ImageError("the image is not a regular file")
        if status.st_size > limit:
            raise ImageError(f"the file has {status.st_size} bytes", hint=f"at most {limit} for this size")
        with os.fdopen(descriptor, "rb", closefd=False) as stream:
            return stream.read(limit)
    finally:
        os.close(descriptor)


def _pfm(data: bytes, expected: Size) -> Picture:
    words, offset = _header(data, 4, comments=False)
    if words[0] != b"PF":
        raise ImageError(f"not a colour PFM (starts with {words[0]!r})", "the header", "PF")
    width, height, scale = _integer(words[1]), _integer(words[2]), _real(words[3])
    check_size(width, height, expected)
    if scale == 0.0:
        raise ImageError("PFM scale 0", "the header", "a negative (little-endian) or positive number")
    pixels = _exactly(data[offset:], width * height * 12)
    values = np.frombuffer(pixels, dtype="<f4" if scale < 0 else ">f4").reshape(height, width, 3)
    return Picture(values[::-1].astype(np.float64), roundoff=2.0**-24)


def _ppm(data: bytes, expected: Size) -> Picture:
    words, offset = _header(data, 4, comments=True)
    if words[0] not in (b"P6", b"P3"):
        raise ImageError(f"not a colour PPM (starts with {words[0]!r})", "the header", "P6 or P3")
    width, height, maximum = (_integer(word) for word in words[1:])
    check_size(width, height, expected)
    if maximum not in (255, 65535):
        raise ImageError(f"PPM maximum {maximum}", "the header", "255 or 65535")
    count = width * height * 3
    if words[0] == b"P6":
        depth = "u1" if maximum == 255 else ">u2"
        codes = np.frombuffer(_exactly(data[offset:], count * np.dtype(depth).itemsize), dtype=depth)
    else:
        codes = _plain_codes(data[offset:], count, maximum)
    return Picture(codes.reshape(height, width, 3).astype(np.float64), maximum)


def _plain_codes(data: bytes, count: int, maximum: int) -> Any:
    words = data.split()
    if len(words) != count:
        raise ImageError(f"{len(words)} values", "the pixels", f"{count}")
    codes = np.array([_integer(word, "value", "the pixels") for word in words], dtype=np.int64)
    if codes.max(initial=0) > maximum:
        raise ImageError(f"value {codes.max()}", "the pixels", f"at most {maximum}")
    return codes


def _header(data: bytes, count: int, comments: bool) -> tuple[list[bytes], int]:
    """The first words of the file and where the pixels begin: one blank after the last word."""
    words: list[bytes] = []
    position = 0
    head = data[:1024]
    while len(words) < count:
        while head[position : position + 1].isspace():
            position += 1
        if comments and head[position : position + 1] == b"#":
            position = (head + b"\n").index(b"\n", position)
            continue
        end = position
        while end < len(head) and not head[end : end + 1].isspace():
            end += 1
        if end == position or end == len(head):
            raise ImageError("the header ends early", f"byte {end}", f"{count} words")
        words.append(head[position:end])
        position = end
    return words, position + 1


def _exactly(data: bytes, size: int) -> bytes:
    if len(data) != size:
        kind = "truncated" if len(data) < size else "too long"
        raise ImageError(f"{kind}: {len(data)} bytes of pixels", "the end of the file", f"{size}")
    return data


def _integer(word: bytes, what: str = "size", place: str = "the header") -> int:
    if not word.isdigit() or len(word) > 9:
        raise ImageError(f"{word[:20]!r} is not a {what}", place, "an integer, not negative")
    return int(word)


def _real(word: bytes) -> float:
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise ImageError(f"{word[:20]!r} is not a number", "the header")
    return value


_NPY_HEADERS = {
    (1, 0): np.lib.format.read_array_header_1_0,
    (2, 0): np.lib.format.read_array_header_2_0,
    (3, 0): np.lib.format.read_array_header_2_0,  # differs in the encoding of field names, and we allow none
}


def _npy(data: bytes, expected: Size) -> Picture:
    stream = io.BytesIO(data)
    try:
        read_header = _NPY_HEADERS[np.lib.format.read_magic(stream)]
        shape, fortran, dtype = read_header(stream, max_header_size=4096)
    except Exception as error:  # numpy parses the header as a Python literal, which may raise almost anything
        raise ImageError(f"not an NPY file ({error})", "the header") from None
    if dtype not in (np.dtype("<f4"), np.dtype("<f8"), np.dtype(">f4"), np.dtype(">f8")):
        raise ImageError(f"dtype {dtype}", "the header", "float32 or float64")
    if len(shape) != 3 or shape[2] != 3:
        raise ImageError(f"shape {shape}", "the header", "(height, width, 3)")
    check_size(shape[1], shape[0], expected)
    pixels = _exactly(data[stream.tell() :], int(np.prod(shape)) * dtype.itemsize)
    values = np.frombuffer(pixels, dtype=dtype).reshape(shape, order="F" if fortran else "C")
    return Picture(values.astype(np.float64), roundoff=2.0**-24 if dtype.itemsize == 4 else 0.0)


def _png(data: bytes, expected: Size) -> Picture:
    import png

    depth, channels = _png_size(data, expected)
    width, height = expected
    try:
        _, _, rows, _ = png.Reader(bytes=data).read()
        codes = np.vstack([np.asarray(row, dtype=np.int64) for row in rows])
    except Exception as error:  # whatever the library makes of hostile bytes
        raise ImageError(f"damaged PNG ({error})", "the pixels") from None
    if codes.shape != (height, width * channels):
        raise ImageError("PNG rows of another size", "the pixels")
    values = codes.reshape(height, width, channels)[:, :, :3]
    return Picture(values.astype(np.float64), 2**depth - 1)


def _png_size(data: bytes, expected: Size) -> tuple[int, int]:
    """Bit depth and channels, after proving that the pixels unpack to just the expected size."""
    if data[:8] != b"\x89PNG\r\n\x1a\n" or data[12:16] != b"IHDR" or len(data) < 33:
        raise ImageError("not a PNG file", "the header")
    width, height = int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")
    depth, colour, interlaced = data[24], data[25], data[28]
    check_size(width, height, expected)
    if colour not in (2, 6) or depth not in (8, 16) or interlaced:
        kind = f"colour type {colour}, {depth} bit{', interlaced' if interlaced else ''}"
        raise ImageError(f"PNG of {kind}", "the header", "RGB or RGBA of 8 or 16 bit, not interlaced")
    channels = 3 if colour == 2 else 4
    size = height * (1 + width * channels * depth // 8)
    try:
        packed = b"".join(chunk for kind, chunk in _png_chunks(data) if kind == b"IDAT")
        unpacked = zlib.decompressobj().decompress(packed, size + 1)
    except zlib.error as error:
        raise ImageError(f"damaged PNG ({error})", "the pixels") from None
    _exactly(unpacked, size)
    return depth, channels


def _png_chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Kind and contents of each chunk: one IHDR, and IEND just at the end of the file."""
    position, kind = 8, b""
    while position + 12 <= len(data) and kind != b"IEND":
        size = int.from_bytes(data[position : position + 4], "big")
        kind = data[position + 4 : position + 8]
        if kind == b"IHDR" and position != 8:
            raise ImageError("a second IHDR chunk", f"byte {position}", "one PNG header")
        yield kind, data[position + 8 : position + 8 + size]
        position += 12 + size
    if kind != b"IEND" or position > len(data):
        raise ImageError("truncated: no complete IEND chunk", "the end of the file")
    if position < len(data):
        raise ImageError(f"too long: {len(data) - position} bytes after IEND", "the end of the file")


_DECODERS: dict[str, Callable[[bytes, Size], Picture]] = {
    "pfm": _pfm,
    "ppm": _ppm,
    "npy": _npy,
    "exr": exr.decode,
    "png": _png,
}
