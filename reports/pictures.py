"""Pictures for a page of one file: PNG files beside the results, as data: URIs.

The paths come from results.json and are not trusted: a picture is embedded only if it is a regular
file inside the folder, reached through no symbolic link, a PNG, and small.
"""

from __future__ import annotations

import os
import stat
from base64 import b64encode
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

MAX_BYTES = 4 * 2**20
MAX_PIXELS = 2**24  # a browser decodes every picture of a page: 64 MiB each
MAX_TOTAL = 12 * 2**20  # characters of all pictures on a page

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_HEADER = 24  # bytes up to and including the height


@dataclass(frozen=True)
class Picture:
    """A picture ready to embed, or why there is none.

    uri: "data:image/png;base64,…", empty if missing; missing: the reason, empty if there is one.
    """

    uri: str = ""
    width: int = 0
    height: int = 0
    missing: str = ""


class PictureError(Exception):
    """A picture that must not or cannot be embedded; the message says why."""


def gallery(folder: Path, names: Iterable[str]) -> dict[str, Picture]:
    """Each named picture once, in order; none after MAX_TOTAL characters."""
    found: dict[str, Picture] = {}
    spent = 0
    for name in names:
        if name not in found:
            found[name] = embed(folder, name) if spent < MAX_TOTAL else Picture(missing="the page is full")
            spent += len(found[name].uri)
    return found


def embed(folder: Path, name: str) -> Picture:
    """The PNG file called name, relative to folder."""
    try:
        data = _read(_inside(folder, name))
        width, height = _size(data)
    except PictureError as reason:
        return Picture(missing=str(reason))
    except OSError as error:
        return Picture(missing=(error.strerror or "it cannot be read").lower())
    return Picture(f"data:image/png;base64,{b64encode(data).decode()}", width, height)


def _inside(folder: Path, name: str) -> Path:
    """The path, if it stays in folder and no part of it is a link."""
    relative = Path(name)
    if relative.is_absolute() or ".." in relative.parts or "\0" in name:
        raise PictureError("its path leaves the report's folder")
    path = folder
    for part in relative.parts:
        path = path / part
        if path.is_symlink():
            raise PictureError("its path is a symbolic link")
    return path


def _read(path: Path) -> bytes:
    """The bytes of a regular file."""
    with open(path, "rb", opener=_open) as stream:
        if not stat.S_ISREG(os.fstat(stream.fileno()).st_mode):
            raise PictureError("it is not a regular file")
        data = stream.read(MAX_BYTES + 1)
    if len(data) > MAX_BYTES:
        raise PictureError(f"it is over {MAX_BYTES:,} bytes")
    return data


def _open(path: str, flags: int) -> int:
    """Open without following a link, and without waiting for the writer of a pipe."""
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))


def _size(data: bytes) -> tuple[int, int]:
    """Width and height by the PNG header."""
    if len(data) < _HEADER or not data.startswith(_SIGNATURE) or data[12:16] != b"IHDR":
        raise PictureError("it is not a PNG file")
    width, height = int.from_bytes(data[16:20]), int.from_bytes(data[20:24])
    if not 0 < width * height <= MAX_PIXELS:
        raise PictureError(f"it has {width} × {height} pixels")
    return width, height
