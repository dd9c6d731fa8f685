"""Whatever bytes a tracer leaves behind: a picture or an ImageError that says what is wrong, and no memory lost."""

from __future__ import annotations

import io
import os
import socket
import struct
import subprocess
import sys
import tracemalloc
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from PIL import Image

from oracles.images import ENDINGS, ImageError, read, write

WIDTH, HEIGHT = 4, 3
SHAPE = (HEIGHT, WIDTH, 3)
VALUES = np.random.default_rng(5).random(SHAPE)


def good(ending: str, folder: Path) -> bytes:
    path = folder / f"good.{ending}"
    write(path, VALUES, "lecture")
    return path.read_bytes()


def refusal(path: Path, width: int = WIDTH, height: int = HEIGHT) -> str:
    with pytest.raises(ImageError) as caught:
        read(path, width, height)
    return str(caught.value)


def refused(folder: Path, ending: str, data: bytes) -> str:
    path = folder / f"hostile.{ending}"
    path.write_bytes(data)
    return refusal(path)


# Every format


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("size", [(3, 4), (4, 4), (5, 3), (12, 1), (1, 1)])
def test_another_size_is_named_with_the_expected_one(tmp_path: Path, ending: str, size: tuple[int, int]) -> None:
    good(ending, tmp_path)
    message = refusal(tmp_path / f"good.{ending}", *size)
    assert message == f"image is 4x3 at the header; expected {size[0]}x{size[1]}"


@pytest.mark.parametrize("ending", ENDINGS)
@pytest.mark.parametrize("lost", [1, 5, 20])
def test_a_truncated_file_is_called_so(tmp_path: Path, ending: str, lost: int) -> None:
    message = refused(tmp_path, ending, good(ending, tmp_path)[:-lost])
    assert "truncated" in message


@pytest.mark.parametrize("ending", ["pfm", "npy", "ppm", "png"])
def test_bytes_after_the_pixels_are_called_too_long(tmp_path: Path, ending: str) -> None:
    assert "too long" in refused(tmp_path, ending, good(ending, tmp_path) + b"x")


@pytest.mark.parametrize("ending", ENDINGS)
def test_an_empty_file_is_refused(tmp_path: Path, ending: str) -> None:
    assert "at the header" in refused(tmp_path, ending, b"") or "header" in refused(tmp_path, ending, b"")


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_file_too_large_for_its_size_is_refused_unread(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"hostile.{ending}"
    with path.open("wb") as stream:
        stream.truncate(2**40)
    assert refusal(path).startswith("the file has 1099511627776 bytes; expected at most ")


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_fifo_is_refused_without_waiting_for_a_writer(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"hostile.{ending}"
    os.mkfifo(path)
    assert refusal(path) == "the image is not a regular file"  # who waited would wait for ever


@pytest.mark.parametrize("target", ["good", "nowhere", "/dev/zero", "hostile"])
def test_a_symbolic_link_is_not_followed(tmp_path: Path, target: str) -> None:
    good("pfm", tmp_path)
    path = tmp_path / "hostile.pfm"
    path.symlink_to(target if target.startswith("/") else f"{target}.pfm")
    assert refusal(path).startswith("the image cannot be opened")


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_directory_is_refused(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"hostile.{ending}"
    path.mkdir()
    assert refusal(path) == "the image is not a regular file"


def test_a_socket_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # socket paths are short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("hostile.pfm")
        assert refusal(tmp_path / "hostile.pfm").startswith("the image cannot be opened")


def test_a_device_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "hostile.pfm"
    try:
        os.mknod(path, 0o600 | 0o020000, os.makedev(1, 5))
        path.open("rb").close()
    except PermissionError:
        pytest.skip("this user may not make or open device files")
    assert refusal(path) == "the image is not a regular file"


def test_a_missing_file_is_said_to_be_missing(tmp_path: Path) -> None:
    assert refusal(tmp_path / "nothing.pfm") == "no image was written"


@pytest.mark.parametrize("name", ["a.jpg", "a", "a.PFM", "a.pfm.gz"])
def test_another_ending_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"PF")
    assert "unknown image ending" in refusal(tmp_path / name)


# NaN and infinity


def pfm(values: Any) -> bytes:
    return b"PF\n4 3\n-1.0\n" + np.asarray(values)[::-1].astype("<f4").tobytes()


def npy(values: Any) -> bytes:
    stream = io.BytesIO()
    np.save(stream, values)
    return stream.getvalue()


def exr(values: Any, folder: Path, **header: Any) -> bytes:
    path = folder / "written.exr"
    OpenEXR.File({"type": OpenEXR.scanlineimage, **header}, {"RGB": np.asarray(values, np.float32)}).write(str(path))
    return path.read_bytes()


@pytest.mark.parametrize("ending", ["pfm", "npy", "exr"])
@pytest.mark.parametrize(("value", "shown"), [(np.nan, "nan"), (np.inf, "inf"), (-np.inf, "-inf")])
@pytest.mark.parametrize(("i", "j", "c"), [(0, 0, 0), (3, 2, 2), (1, 2, 1)])
def test_a_value_that_is_not_finite_is_named_with_its_pixel_and_channel(
    tmp_path: Path, ending: str, value: float, shown: str, i: int, j: int, c: int
) -> None:
    values = VALUES.copy()
    values[j, i, c] = value
    data = {"pfm": pfm, "npy": npy, "exr": lambda v: exr(v, tmp_path)}[ending](values)
    expected = f"{shown} in the image at pixel ({i}, {j}) channel {'RGB'[c]}; expected finite numbers"
    assert refused(tmp_path, ending, data) == expected


def test_several_values_that_are_not_finite_are_counted_and_the_first_is_named(tmp_path: Path) -> None:
    values = VALUES.copy()
    values[1, 2, 0] = values[2] = np.nan
    message = refused(tmp_path, "npy", npy(values))
    assert message == "nan in the image, 13 such values at pixel (2, 1) channel R; expected finite numbers"


def test_a_signalling_nan_is_a_nan(tmp_path: Path) -> None:
    data = bytearray(pfm(VALUES))
    data[-4:] = struct.pack("<I", 0x7FA00000)
    assert (
        refused(tmp_path, "pfm", bytes(data)) == "nan in the image at pixel (3, 0) channel B; expected finite numbers"
    )


# PFM and PPM

PIXELS = bytes(WIDTH * HEIGHT * 12)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"Pf\n4 3\n-1.0\n" + PIXELS, "not a colour PFM (starts with b'Pf') at the header; expected PF"),
        (b"P6\n4 3\n255\n" + PIXELS, "not a colour PFM"),
        (b"PF\n4 3\n0\n" + PIXELS, "PFM scale 0 at the header"),
        (b"PF\n4 3\nnan\n" + PIXELS, "b'nan' is not a number"),
        (b"PF\n4 3\n-inf\n" + PIXELS, "b'-inf' is not a number"),
        (b"PF\n4 3\n1,0\n" + PIXELS, "b'1,0' is not a number"),
        (b"PF\n-4 3\n-1.0\n" + PIXELS, "b'-4' is not a size"),
        (b"PF\n4.0 3\n-1.0\n" + PIXELS, "b'4.0' is not a size"),
        (b"PF\n0 0\n-1.0\n", "image is 0x0"),
        (b"PF\n999999999 999999999\n-1.0\n", "image is 999999999x999999999"),
        (b"PF\n" + b"9" * 100 + b" 3\n-1.0\n", "is not a size"),
        (b"PF\n4 3\n", "the header ends early"),
        (b"PF\n4 3\n-1.0", "the header ends early"),
        (b"PF\n# comment\n4 3\n-1.0\n" + PIXELS, "is not a size"),
        (b"PF" + b" " * 5000, "the header ends early"),
        (b"x" * 5000, "the header ends early"),
    ],
)
def test_a_wrong_pfm_header_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in refused(tmp_path, "pfm", data)


CODES = bytes(WIDTH * HEIGHT * 3)
NUMBERS = b"1 " * (WIDTH * HEIGHT * 3)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"P5\n4 3\n255\n" + CODES[:12], "not a colour PPM (starts with b'P5') at the header; expected P6 or P3"),
        (b"P2\n4 3\n255\n" + NUMBERS[:24], "not a colour PPM"),
        (b"P6\n4 3\n100\n" + CODES, "PPM maximum 100 at the header; expected 255 or 65535"),
        (b"P6\n4 3\n0\n" + CODES, "PPM maximum 0"),
        (b"P6\n4 3\n65535\n" + CODES, "truncated: 36 bytes of pixels at the end of the file; expected 72"),
        (b"P6\n4 3\n255\n" + CODES * 2, "too long: 72 bytes of pixels at the end of the file; expected 36"),
        (b"P6\n4 -3\n255\n" + CODES, "b'-3' is not a size"),
        (b"P6\n99999999999 3\n255\n" + CODES, "is not a size"),
        (b"P6\n4 3\n# 255\n", "the header ends early"),
        (b"P6\n#" + b"x" * 5000 + b"\n4 3\n255\n" + CODES, "the header ends early"),
        (b"P3\n4 3\n255\n" + NUMBERS[:-2], "35 values at the pixels; expected 36"),
        (b"P3\n4 3\n255\n" + NUMBERS + b"1", "37 values at the pixels; expected 36"),
        (b"P3\n4 3\n255\n" + NUMBERS[:-2] + b"256", "value 256 at the pixels; expected at most 255"),
        (b"P3\n4 3\n255\n" + NUMBERS[:-2] + b"-1", "b'-1' is not a value at the pixels"),
        (b"P3\n4 3\n255\n" + NUMBERS[:-2] + b"nan", "b'nan' is not a value at the pixels"),
        (b"P3\n4 3\n255\n" + NUMBERS[:-2] + b"9" * 500, "is not a value at the pixels"),
    ],
)
def test_a_wrong_ppm_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in refused(tmp_path, "ppm", data)


# NPY


def npy_header(text: str, version: bytes = b"\x01\x00") -> bytes:
    return b"\x93NUMPY" + version + struct.pack("<H", len(text)) + text.encode("latin1") + bytes(WIDTH * HEIGHT * 12)


def npy_fields(descr: str = "'<f4'", shape: str = "(3, 4, 3)") -> str:
    return f"{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (npy_header(npy_fields("'|u1'")), "dtype uint8 at the header; expected float32 or float64"),
        (npy_header(npy_fields("'<f2'")), "dtype float16"),
        (npy_header(npy_fields("'<c8'")), "dtype complex64"),
        (npy_header(npy_fields("'|O'")), "dtype object"),
        (npy_header(npy_fields("'a3'")), "dtype |S3"),
        (npy_header(npy_fields("[('r', '<f4')]")), "dtype [('r', '<f4')]"),
        (npy_header(npy_fields("'nonsense'")), "not an NPY file"),
        (npy_header(npy_fields(shape="(3, 4)")), "shape (3, 4) at the header; expected (height, width, 3)"),
        (npy_header(npy_fields(shape="(3, 4, 1)")), "shape (3, 4, 1)"),
        (npy_header(npy_fields(shape="(3, 4, 4)")), "shape (3, 4, 4)"),
        (npy_header(npy_fields(shape="(4, 3, 3)")), "image is 3x4"),
        (npy_header(npy_fields(shape="(-3, 4, 3)")), "image is 4x-3"),
        (npy_header(npy_fields(shape=f"({10**30}, 4, 3)")), f"image is 4x{10**30}"),
        (npy_header(npy_fields(shape="3")), "not an NPY file"),
        (npy_header(npy_fields(shape="(3.0, 4, 3)")), "not an NPY file"),
        (npy_header("-" * 4000 + "1"), "not an NPY file"),
        (npy_header("(" * 4000), "not an NPY file"),
        (npy_header("'''"), "not an NPY file"),
        (npy_header("{[]: 1}"), "not an NPY file"),
        (npy_header(""), "not an NPY file"),
        (npy_header(npy_fields().ljust(5000)), "not an NPY file"),
        (npy_header(npy_fields(), b"\x09\x09"), "not an NPY file"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff", "not an NPY file"),
        (b"\x93NUM", "not an NPY file"),
    ],
)
def test_a_wrong_npy_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in refused(tmp_path, "npy", data)


class Trap:
    """Unpickling it would make a file."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[Any, ...]:
        return (Path.touch, (self.path,))


def test_a_pickled_object_in_npy_is_refused_and_not_unpickled(tmp_path: Path) -> None:
    sprung = tmp_path / "sprung"
    stream = io.BytesIO()
    np.save(stream, np.full(SHAPE, Trap(sprung), dtype=object), allow_pickle=True)
    assert "dtype object" in refused(tmp_path, "npy", stream.getvalue())
    assert not sprung.exists()


# PNG


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def ihdr(width: int = WIDTH, height: int = HEIGHT, depth: int = 8, colour: int = 2, interlace: int = 0) -> bytes:
    return chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlace))


SIGNATURE = b"\x89PNG\r\n\x1a\n"
ROWS = (b"\0" + bytes(3 * WIDTH)) * HEIGHT
IDAT = chunk(b"IDAT", zlib.compress(ROWS))
IEND = chunk(b"IEND", b"")


def test_the_png_that_is_spoilt_here_is_good(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    path.write_bytes(SIGNATURE + ihdr() + IDAT + IEND)
    assert read(path, WIDTH, HEIGHT).maximum == 255


@pytest.mark.parametrize("mode", ["L", "P", "1", "LA", "I;16"])
def test_a_png_that_is_not_rgb_is_refused(tmp_path: Path, mode: str) -> None:
    stream = io.BytesIO()
    Image.new(mode, (WIDTH, HEIGHT)).save(stream, "PNG")
    message = refused(tmp_path, "png", stream.getvalue())
    assert message.startswith("PNG of colour type ")
    assert message.endswith("expected RGB or RGBA of 8 or 16 bit, not interlaced")


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"\x89PNG\r\n\x1a\n", "not a PNG file"),
        (b"GIF89a" + bytes(100), "not a PNG file"),
        (SIGNATURE + ihdr(10**6, 10**6) + IDAT + IEND, "image is 1000000x1000000"),
        (SIGNATURE + ihdr(2**32 - 1, 3) + IDAT + IEND, "image is 4294967295x3"),
        (SIGNATURE + ihdr(interlace=1) + IDAT + IEND, "interlaced"),
        (SIGNATURE + ihdr(depth=4) + IDAT + IEND, "colour type 2, 4 bit"),
        (SIGNATURE + ihdr() + IEND, "truncated: 0 bytes of pixels"),
        (SIGNATURE + ihdr() + IDAT, "truncated"),
        (SIGNATURE + ihdr() + IDAT[:-2], "truncated"),
        (SIGNATURE + ihdr() + IDAT + IEND + IDAT, "bytes after IEND"),
        (SIGNATURE + ihdr() + IDAT[:-1] + b"?" + IEND, "damaged PNG"),
        (SIGNATURE + ihdr() + chunk(b"IDAT", b"no deflate") + IEND, "damaged PNG"),
        (SIGNATURE + ihdr() + chunk(b"IDAT", zlib.compress(ROWS[:-1])) + IEND, "truncated: 38 bytes of pixels"),
        (SIGNATURE + ihdr() + chunk(b"IDAT", zlib.compress(ROWS + b"x")) + IEND, "too long: 40 bytes of pixels"),
        (SIGNATURE + ihdr() + chunk(b"IDAT", zlib.compress(b"\x09" + ROWS[1:])) + IEND, "damaged PNG"),
        (SIGNATURE + ihdr() + ihdr(2**20, 2**12, interlace=1) + IDAT + IEND, "a second IHDR chunk at byte 33"),
        (SIGNATURE + ihdr() + ihdr(colour=3) + IDAT + IEND, "a second IHDR chunk"),
    ],
)
def test_a_wrong_png_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    assert words in refused(tmp_path, "png", data)


def peak_of_refusal(path: Path) -> tuple[str, int]:
    tracemalloc.start()
    try:
        return refusal(path), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("pieces", [1, 7])
def test_a_png_bomb_of_a_gibibyte_is_refused_within_8_mib(tmp_path: Path, pieces: int) -> None:
    packer = zlib.compressobj(9)
    packed = b"".join(packer.compress(bytes(2**20)) for _ in range(1024)) + packer.flush()
    assert len(packed) < 2**20 + 1000
    step = -(-len(packed) // pieces)
    data = b"".join(chunk(b"IDAT", packed[k : k + step]) for k in range(0, len(packed), step))
    path = tmp_path / "bomb.png"
    path.write_bytes(SIGNATURE + ihdr() + data + IEND)
    message, peak = peak_of_refusal(path)
    assert message == "too long: 40 bytes of pixels at the end of the file; expected 39"
    assert peak < 8 * 2**20


# EXR


def attribute(name: str, kind: str, data: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


Channels = tuple[tuple[str, int, int], ...]
RGB: Channels = (("B", 1, 1), ("G", 1, 1), ("R", 1, 1))


def exr_header(width: int, height: int, channels: Channels = RGB, extra: bytes = b"") -> bytes:
    """Magic number and header of a scan-line file by the OpenEXR file layout, float channels."""
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", 2, 0, x, y) for name, x, y in channels) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    return (
        struct.pack("<ii", 20000630, 2)
        + attribute("channels", "chlist", listed)
        + attribute("compression", "compression", b"\0")
        + attribute("dataWindow", "box2i", box)
        + attribute("displayWindow", "box2i", box)
        + attribute("lineOrder", "lineOrder", b"\0")
        + attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0))
        + attribute("screenWindowCenter", "v2f", bytes(8))
        + attribute("screenWindowWidth", "float", struct.pack("<f", 1.0))
        + extra
        + b"\0"
    )


MEASURE = """
import resource, sys
from pathlib import Path
import OpenEXR, png
from oracles.images import ImageError, read
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    read(Path(sys.argv[1]), 4, 3)
except ImageError as error:
    print(error)
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024)
"""


def refusal_and_growth(path: Path) -> tuple[str, int]:
    """The message, and by how many bytes a fresh process grew: the library allocates outside Python."""
    root = Path(__file__).parents[2]
    command = [sys.executable, "-P", "-c", MEASURE, str(path)]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, env={**os.environ, "PYTHONPATH": str(root)}
    )
    *message, growth = done.stdout.splitlines()
    return "\n".join(message), int(growth)


@pytest.mark.parametrize("size", [(10**6, 10**6), (4, 2**30), (2**30, 3), (2**31 - 1, 2**31 - 1), (20000, 20000)])
def test_an_exr_header_of_a_huge_picture_allocates_nothing(tmp_path: Path, size: tuple[int, int]) -> None:
    path = tmp_path / "huge.exr"
    path.write_bytes(exr_header(*size) + bytes(1000))
    message, growth = refusal_and_growth(path)
    assert message.startswith((f"image is {size[0]}x{size[1]} at the header", "not an EXR file"))
    assert growth < 32 * 2**20


def part(size: tuple[int, int], name: str) -> Any:
    window = (np.array([0, 0], np.int32), np.array([WIDTH - 1, HEIGHT - 1], np.int32))
    header = {"type": OpenEXR.scanlineimage, "compression": OpenEXR.ZIP_COMPRESSION, "displayWindow": window}
    return OpenEXR.Part(header, {"RGB": np.zeros((*size, 3), np.float32)}, name)


def test_a_second_part_of_an_exr_is_never_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "parts.exr"
    OpenEXR.File([part((HEIGHT, WIDTH), "small"), part((4096, 4096), "bomb")]).write(str(path))
    assert path.stat().st_size < 2**20
    message, growth = refusal_and_growth(path)
    assert message == "EXR of 2 parts at the header; expected one part"
    assert growth < 32 * 2**20


@pytest.mark.parametrize(
    ("channels", "words"),
    [
        ((("G", 1, 1), ("R", 1, 1)), "channel B is missing (has G, R) at the header; expected R G B"),
        ((("Y", 1, 1),), "channel R is missing (has Y)"),
        ((("b", 1, 1), ("g", 1, 1), ("r", 1, 1)), "channel R is missing"),
        ((("B", 2, 1), ("G", 1, 1), ("R", 1, 1)), "deep or subsampled EXR"),
        ((*((f"A{k:02d}", 1, 1) for k in range(14)), *RGB), "17 channels at the header; expected R G B"),
    ],
)
def test_an_exr_without_full_rgb_is_refused(tmp_path: Path, channels: Channels, words: str) -> None:
    data = exr_header(WIDTH, HEIGHT, channels) + bytes(2000)
    assert words in refused(tmp_path, "exr", data)


def test_a_deep_exr_is_refused(tmp_path: Path) -> None:
    samples = np.empty((HEIGHT, WIDTH), dtype=object)
    for j, i in np.ndindex(samples.shape):
        samples[j, i] = np.ones(2, np.float32)
    path = tmp_path / "deep.exr"
    header = {"type": OpenEXR.deepscanline, "compression": OpenEXR.ZIPS_COMPRESSION}
    OpenEXR.File(header, dict.fromkeys("RGB", samples)).write(str(path))
    assert refusal(path).startswith("deep or subsampled EXR at the header")


def test_an_exr_of_integers_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "integers.exr"
    whole = np.zeros((HEIGHT, WIDTH), np.uint32)
    OpenEXR.File({"type": OpenEXR.scanlineimage}, dict.fromkeys("RGB", whole)).write(str(path))
    assert refusal(path) == "EXR channels of another size or kind at the pixels; expected half or float"
