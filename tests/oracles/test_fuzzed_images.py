"""Random and damaged bytes: a picture or an ImageError, never anything else."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from oracles.images import ENDINGS, ImageError, Picture, read, write

WIDTH, HEIGHT = 4, 3
SHAPE = (HEIGHT, WIDTH, 3)


def written(ending: str) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"good.{ending}"
        write(path, np.random.default_rng(5).random(SHAPE), "lecture")
        return path.read_bytes()


GOOD = {ending: written(ending) for ending in ENDINGS}


def outcome(folder: Path, ending: str, data: bytes) -> Picture | ImageError:
    path = folder / f"random.{ending}"
    path.write_bytes(data)
    try:
        return read(path, WIDTH, HEIGHT)
    except ImageError as error:
        return error


STARTS = {
    "pfm": b"PF\n4 3\n-1.0\n",
    "ppm": b"P6\n4 3\n255\n",
    "npy": b"\x93NUMPY\x01\x00",
    "exr": b"\x76\x2f\x31\x01\x02\x00\x00\x00",
    "png": b"\x89PNG\r\n\x1a\n",
}
FUZZ = settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow], max_examples=200)


@pytest.mark.parametrize("ending", ENDINGS)
@given(data=st.data())
@FUZZ
def test_random_bytes_give_a_picture_or_an_image_error(tmp_path: Path, ending: str, data: st.DataObject) -> None:
    start = data.draw(st.sampled_from((b"", STARTS[ending])))
    outcome(tmp_path, ending, start + data.draw(st.binary(max_size=300)))


@pytest.mark.parametrize("ending", ENDINGS)
@given(data=st.data())
@FUZZ
def test_damaged_files_give_a_picture_or_an_image_error(tmp_path: Path, ending: str, data: st.DataObject) -> None:
    damaged = bytearray(GOOD[ending])
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(damaged) - 1))
        damaged[at] = data.draw(st.sampled_from((0, 1, 127, 128, 255)) | st.integers(0, 255))
    found = outcome(tmp_path, ending, bytes(damaged))
    assert isinstance(found, ImageError) or found.values.shape == SHAPE
