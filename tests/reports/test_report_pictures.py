"""A picture is embedded only from a small, regular PNG file inside the report's folder."""

from __future__ import annotations

import os
import shutil
import struct
from base64 import b64decode
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from oracles.verdict import Pictures, Verdict
from reports import page, pictures
from reports.pictures import Picture, embed, gallery
from reports.results import Results


def header(width: int, height: int) -> bytes:
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I4sII", 13, b"IHDR", width, height) + b"\x08\x02\0\0\0"


def test_a_picture_is_embedded_byte_by_byte(folder: Path) -> None:
    found = embed(folder, "images/got.png")
    assert b64decode(found.uri.removeprefix("data:image/png;base64,")) == (folder / "images/got.png").read_bytes()
    assert (found.width, found.height, found.missing) == (16, 12, "")


@pytest.mark.parametrize("name", ["../secret.png", "images/../../secret.png", "images/\0.png"])
def test_a_path_out_of_the_folder_is_refused(folder: Path, name: str) -> None:
    shutil.copy(folder / "images/got.png", folder.parent / "secret.png")
    assert embed(folder, name) == Picture(missing="its path leaves the report's folder")


def test_an_absolute_path_is_refused_even_into_the_folder(folder: Path) -> None:
    assert embed(folder, str(folder / "images/got.png")).missing == "its path leaves the report's folder"


def test_a_link_to_a_file_is_not_followed(folder: Path) -> None:
    (folder / "images/link.png").symlink_to(folder / "images/got.png")
    assert embed(folder, "images/link.png").missing == "its path is a symbolic link"


def test_a_link_to_a_folder_is_not_followed(folder: Path) -> None:
    (folder / "pictures").symlink_to(folder / "images")
    assert embed(folder, "pictures/got.png").missing == "its path is a symbolic link"


@pytest.mark.parametrize("name", ["images", ".", ""])
def test_a_folder_is_no_picture(folder: Path, name: str) -> None:
    assert embed(folder, name).missing == "is a directory"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_refused_without_waiting_for_a_writer(folder: Path) -> None:
    os.mkfifo(folder / "pipe.png")
    assert embed(folder, "pipe.png").missing == "it is not a regular file"


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "it is not a PNG file"),
        (b"GIF89a" + bytes(40), "it is not a PNG file"),
        (header(8, 8)[:20], "it is not a PNG file"),
        (header(8, 8).replace(b"IHDR", b"tEXt"), "it is not a PNG file"),
        (header(0, 8), "it has 0 × 8 pixels"),
        (header(2**31, 2**31), "it has 2147483648 × 2147483648 pixels"),
        (header(8, 8) + bytes(pictures.MAX_BYTES), "it is over 4,194,304 bytes"),
    ],
)
def test_a_file_that_is_no_small_png_is_refused(folder: Path, data: bytes, reason: str) -> None:
    (folder / "x.png").write_bytes(data)
    assert embed(folder, "x.png").missing == reason


@pytest.mark.parametrize(
    ("name", "reason"),
    [("images/none.png", "no such file or directory"), ("x" * 5000, "file name too long")],
)
def test_a_file_that_cannot_be_opened_is_missing(folder: Path, name: str, reason: str) -> None:
    assert embed(folder, name).missing == reason


def test_a_picture_named_twice_is_read_once(folder: Path) -> None:
    assert list(gallery(folder, ["images/got.png", "images/got.png"])) == ["images/got.png"]


def test_a_full_page_takes_no_more_pictures(folder: Path) -> None:
    names = [f"{number}.png" for number in range(5)]
    for name in names:
        (folder / name).write_bytes(header(8, 8) + bytes(pictures.MAX_BYTES - 64))
    missing = [picture.missing for picture in gallery(folder, names).values()]
    assert missing == ["", "", "", "the page is full", "the page is full"]


def test_the_page_embeds_no_stranger_and_says_so(
    run: Callable[..., Results], make: Callable[..., Verdict], folder: Path
) -> None:
    Image.new("RGB", (16, 12), (1, 2, 3)).save(folder.parent / "secret.png")
    (folder / "link.png").symlink_to(folder.parent / "secret.png")
    stolen = Pictures(expected="../secret.png", got="link.png", difference="/etc/hostname")
    html = page.render(run(make("fail", pictures=stolen), make("pass", pictures=stolen)), folder)
    assert "data:image/png" not in html
    assert html.count("picture missing") == 4
