"""Scene files, in either notation, read with bounds."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from scenes.errors import SceneError
from scenes.json_form import from_json
from scenes.model import Scene
from scenes.text import from_text

MAX_BYTES = 8 * 2**20


def load(path: Path) -> Scene:
    """Read a scene file, JSON or text by its ending; raise SceneError naming file, place and value."""
    if path.suffix not in (".json", ".txt"):
        raise SceneError("not a scene file", str(path), path.suffix, "an ending .json or .txt")
    text = _read_bounded(path)
    return from_json(text, str(path)) if path.suffix == ".json" else from_text(text, str(path))


def _read_bounded(path: Path) -> str:
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK)  # a FIFO must not keep us waiting
        with os.fdopen(descriptor, "rb") as stream:
            data = stream.read(MAX_BYTES + 1) if stat.S_ISREG(os.fstat(descriptor).st_mode) else None
    except OSError as error:
        raise SceneError(error.strerror or "cannot be read", str(path), hint="a readable scene file") from None
    if data is None:
        raise SceneError("not a regular file", str(path), hint="a readable scene file")
    if len(data) > MAX_BYTES:
        raise SceneError("file too large", str(path), f"over {MAX_BYTES} bytes", f"at most {MAX_BYTES} bytes")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        byte = f"byte 0x{data[error.start]:02x} at offset {error.start}"
        raise SceneError("not text", str(path), byte, "UTF-8 text") from None
