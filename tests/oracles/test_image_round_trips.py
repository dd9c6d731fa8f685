"""What a lawful writer writes is what we read, and what we write is what other readers read."""

from __future__ import annotations

import io
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from numpy.typing import NDArray
from PIL import Image

from oracles.images import ENDINGS, ImageError, Picture, read, write

WIDTH, HEIGHT = 4, 3
SHAPE = (HEIGHT, WIDTH, 3)
RANDOM = np.random.default_rng(11)
LINEAR = (RANDOM.random(SHAPE) * 4.0 - 1.0).astype(np.float64)
CODES_8 = RANDOM.integers(0, 256, SHAPE).astype(np.uint8)
CODES_16 = RANDOM.integers(0, 65536, SHAPE).astype(np.uint16)


def put(folder: Path, name: str, data: bytes) -> Picture:
    path = folder / name
    path.write_bytes(data)
    return read(path, WIDTH, HEIGHT)


def same_bits(a: NDArray[Any], b: NDArray[Any]) -> bool:
    return a.astype(np.float64).tobytes() == b.astype(np.float64).tobytes()


def pfm_value(value: float, order: str) -> bytes:
    return struct.pack(f"{order}f", value)


@pytest.mark.parametrize(("order", "scale"), [("<", b"-1.0"), (">", b"1.0"), ("<", b"-0.5"), (">", b"255")])
def test_pfm_is_read_bottom_up_in_the_byte_order_of_its_scale(tmp_path: Path, order: str, scale: bytes) -> None:
    values = LINEAR.astype(np.float32)
    body = b"".join(
        pfm_value(float(values[j, i, c]), order)
        for j in reversed(range(HEIGHT))
        for i in range(WIDTH)
        for c in range(3)
    )
    picture = put(tmp_path, "a.pfm", b"PF\n4 3\n" + scale + b"\n" + body)
    assert same_bits(picture.values, values)
    assert (picture.maximum, picture.roundoff) == (None, 2.0**-24)


@pytest.mark.parametrize("header", [b"PF 4 3 -1.0 ", b"PF\n4\n3\n-1.0\n", b"PF\n4 3\n-1\n", b"PF\t4  3\n-1e0\t"])
def test_a_pfm_header_may_use_any_blanks(tmp_path: Path, header: bytes) -> None:
    values = LINEAR.astype("<f4")
    assert same_bits(put(tmp_path, "a.pfm", header + values[::-1].tobytes()).values, values)


@pytest.mark.parametrize("separator", [b" ", b"\n", b"\t\r\n"])
@pytest.mark.parametrize(("codes", "maximum"), [(CODES_8, 255), (CODES_16, 65535)])
def test_a_plain_ppm_is_read(tmp_path: Path, separator: bytes, codes: NDArray[Any], maximum: int) -> None:
    body = separator.join(b"%d" % code for code in codes.ravel())
    picture = put(tmp_path, "a.ppm", b"P3\n# by hand\n4 3\n# white\n%d\n" % maximum + body)
    assert same_bits(picture.values, codes)
    assert (picture.maximum, picture.roundoff) == (maximum, 0.0)


def test_a_raw_ppm_of_8_bit_is_read(tmp_path: Path) -> None:
    body = bytes(int(code) for code in CODES_8.ravel())
    picture = put(tmp_path, "a.ppm", b"P6 # comment\n4 3\n255\n" + body)
    assert same_bits(picture.values, CODES_8)
    assert picture.maximum == 255


def test_a_raw_ppm_of_16_bit_is_read_with_the_high_byte_first(tmp_path: Path) -> None:
    body = b"".join(bytes(divmod(int(code), 256)) for code in CODES_16.ravel())
    picture = put(tmp_path, "a.ppm", b"P6\n4 3\n65535\n" + body)
    assert same_bits(picture.values, CODES_16)
    assert picture.maximum == 65535


def test_a_raw_ppm_may_begin_its_pixels_with_a_blank_byte(tmp_path: Path) -> None:
    codes = np.full(SHAPE, 10, dtype=np.uint8)
    assert same_bits(put(tmp_path, "a.ppm", b"P6\n4 3\n255\n" + codes.tobytes()).values, codes)


@pytest.mark.parametrize("kind", ["PNG", "PPM"])
def test_what_pillow_writes_is_read(tmp_path: Path, kind: str) -> None:
    stream = io.BytesIO()
    Image.fromarray(CODES_8).save(stream, kind)
    picture = put(tmp_path, f"a.{kind.lower()}", stream.getvalue())
    assert same_bits(picture.values, CODES_8)
    assert picture.maximum == 255


def test_the_alpha_of_an_rgba_png_is_left_out(tmp_path: Path) -> None:
    stream = io.BytesIO()
    rgba = np.dstack([CODES_8, np.full((HEIGHT, WIDTH), 7, np.uint8)])
    Image.fromarray(rgba).save(stream, "PNG")
    assert same_bits(put(tmp_path, "a.png", stream.getvalue()).values, CODES_8)


def png(codes: NDArray[Any], pieces: int) -> bytes:
    """A PNG of 8 or 16 bit RGB by the specification (W3C PNG, 2003), filter 0, IDAT in pieces."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.astype(row.dtype.newbyteorder(">")).tobytes() for row in codes)
    packed = zlib.compress(rows)
    step = -(-len(packed) // pieces)
    idat = b"".join(chunk(b"IDAT", packed[k : k + step]) for k in range(0, len(packed), step))
    head = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8 * codes.itemsize, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + idat + chunk(b"IEND", b"")


@pytest.mark.parametrize("pieces", [1, 2, 5])
@pytest.mark.parametrize("codes", [CODES_8, CODES_16], ids=["8bit", "16bit"])
def test_a_png_of_either_depth_is_read(tmp_path: Path, codes: NDArray[Any], pieces: int) -> None:
    picture = put(tmp_path, "a.png", png(codes, pieces))
    assert same_bits(picture.values, codes)
    assert picture.maximum == np.iinfo(codes.dtype).max


@pytest.mark.parametrize("fortran", [False, True])
@pytest.mark.parametrize("dtype", ["<f4", ">f4", "<f8", ">f8"])
@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_npy_is_read_in_every_lawful_form(tmp_path: Path, dtype: str, fortran: bool, version: tuple[int, int]) -> None:
    values = LINEAR.astype(dtype, order="F" if fortran else "C")
    assert np.isfortran(values) is fortran
    stream = io.BytesIO()
    np.lib.format.write_array(stream, values, version=version)
    picture = put(tmp_path, "a.npy", stream.getvalue())
    assert same_bits(picture.values, LINEAR.astype(dtype))
    assert picture.roundoff == (2.0**-24 if dtype.endswith("4") else 0.0)


COMPRESSIONS = [OpenEXR.NO_COMPRESSION, OpenEXR.RLE_COMPRESSION, OpenEXR.ZIPS_COMPRESSION, OpenEXR.ZIP_COMPRESSION]


@pytest.mark.parametrize("compression", [*COMPRESSIONS, OpenEXR.PIZ_COMPRESSION])
@pytest.mark.parametrize(("dtype", "roundoff"), [(np.float16, 2.0**-11), (np.float32, 2.0**-24)])
@pytest.mark.parametrize("extra", [(), ("A",), ("A", "Z", "depth.Y")])
def test_an_exr_of_lossless_compression_is_read(
    tmp_path: Path, compression: Any, dtype: Any, roundoff: float, extra: tuple[str, ...]
) -> None:
    values = LINEAR.astype(dtype)
    channels = {name: np.ascontiguousarray(values[..., k]) for k, name in enumerate("RGB")}
    channels |= {name: np.zeros((HEIGHT, WIDTH), dtype) for name in extra}
    path = tmp_path / "a.exr"
    OpenEXR.File({"compression": compression, "type": OpenEXR.scanlineimage}, channels).write(str(path))
    picture = read(path, WIDTH, HEIGHT)
    assert same_bits(picture.values, values)
    assert (picture.maximum, picture.roundoff) == (None, roundoff)


def test_an_exr_is_as_coarse_as_its_coarsest_channel(tmp_path: Path) -> None:
    kinds = {"R": np.float32, "G": np.float16, "B": np.float32}
    channels = {n: np.ascontiguousarray(LINEAR[..., k].astype(d)) for k, (n, d) in enumerate(kinds.items())}
    path = tmp_path / "a.exr"
    OpenEXR.File({"type": OpenEXR.scanlineimage}, channels).write(str(path))
    assert read(path, WIDTH, HEIGHT).roundoff == 2.0**-11


def test_a_tiled_exr_is_read(tmp_path: Path) -> None:
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 2
    path = tmp_path / "a.exr"
    values = np.ascontiguousarray(LINEAR.astype(np.float32))
    OpenEXR.File({"type": OpenEXR.tiledimage, "tiles": tiles}, {"RGB": values}).write(str(path))
    assert same_bits(read(path, WIDTH, HEIGHT).values, values)


singles = hnp.arrays(np.float32, SHAPE, elements=st.floats(width=32, allow_nan=False, allow_infinity=False))


@pytest.mark.parametrize("ending", ["pfm", "exr", "npy"])
@given(values=singles)
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow], max_examples=50)
def test_any_float32_picture_comes_back_bit_for_bit(tmp_path: Path, ending: str, values: NDArray[Any]) -> None:
    path = tmp_path / f"a.{ending}"
    write(path, values, "lecture")
    assert same_bits(read(path, WIDTH, HEIGHT).values, values)


@given(values=hnp.arrays(np.float64, SHAPE, elements=st.floats(allow_nan=False, allow_infinity=False)))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow], max_examples=50)
def test_any_float64_picture_comes_back_from_npy_bit_for_bit(tmp_path: Path, values: NDArray[Any]) -> None:
    path = tmp_path / "a.npy"
    write(path, values, "lecture")
    assert same_bits(read(path, WIDTH, HEIGHT).values, values)


def lecture_code(c: float) -> int:
    return int(255.0 * min(max(c, 0.0), 1.0))


def srgb_code(c: float) -> int:
    """IEC 61966-2-1, in its own words."""
    c = min(max(c, 0.0), 1.0)
    encoded = 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
    return round(255.0 * encoded)


@pytest.mark.parametrize(("display", "code"), [("lecture", lecture_code), ("srgb", srgb_code)])
@pytest.mark.parametrize("ending", ["png", "ppm"])
def test_pillow_reads_what_we_write_for_display(tmp_path: Path, ending: str, display: str, code: Any) -> None:
    path = tmp_path / f"a.{ending}"
    write(path, LINEAR, display)
    with Image.open(path) as image:
        assert image.mode == "RGB"
        found = np.asarray(image)
    np.testing.assert_array_equal(found, np.vectorize(code)(LINEAR))
    np.testing.assert_array_equal(read(path, WIDTH, HEIGHT).values, found)


def test_openexr_reads_what_we_write(tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    write(path, LINEAR, "lecture")
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    for k, name in enumerate("RGB"):
        assert same_bits(channels[name].pixels, LINEAR[..., k].astype(np.float32))


def test_our_pfm_is_the_format_s_own(tmp_path: Path) -> None:
    path = tmp_path / "a.pfm"
    write(path, LINEAR, "lecture")
    head, size, scale, body = path.read_bytes().split(b"\n", 3)
    assert (head, size, float(scale)) == (b"PF", b"4 3", -1.0)
    assert body == b"".join(struct.pack("<12f", *row.ravel()) for row in LINEAR[::-1])


@pytest.mark.parametrize("ending", ENDINGS)
def test_writing_leaves_no_temporary_file(tmp_path: Path, ending: str) -> None:
    write(tmp_path / f"a.{ending}", LINEAR, "lecture")
    assert [path.name for path in tmp_path.iterdir()] == [f"a.{ending}"]


def test_an_unknown_ending_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ImageError, match=r"unknown image ending '.jpg'.*expected .pfm, .exr, .npy, .ppm, .png"):
        write(tmp_path / "a.jpg", LINEAR, "lecture")
    assert not list(tmp_path.iterdir())
