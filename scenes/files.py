"""Scene files, in either notation, read with bounds."""

from __future__ import annotations

from pathlib import Path

from scenes.disk import TooLargeError, read_bounded
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
        data = read_bounded(path, MAX_BYTES)
    except TooLargeError as error:
        raise SceneError("file too large", str(path), str(error.strerror), f"at most {MAX_BYTES} bytes") from None
    except OSError as error:
        raise SceneError(error.strerror or "cannot be read", str(path), hint="a readable scene file") from None
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        byte = f"byte 0x{data[error.start]:02x} at offset {error.start}"
        raise SceneError("not text", str(path), byte, "UTF-8 text") from None
