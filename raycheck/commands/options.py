"""What several commands read from their options."""

from __future__ import annotations

import re
import shlex
from argparse import Namespace
from pathlib import Path

from raycheck.errors import UsageError
from raycheck.filed import is_file
from raycheck.memory import check_fits
from raycheck.subjects import Subject, attach, attach_command, dialect_of
from scenes.catalogue import rung
from scenes.files import load
from scenes.model import MAX_SIDE, Scene


def subject_of(options: Namespace) -> Subject:
    """The tracer: SUBJECT, or the command after --; just one of them."""
    if options.tracer is not None and options.subject is not None:
        raise UsageError(f"both {options.subject!r} and a command after -- are given", "one tracer")
    if options.tracer is None and options.subject is None:
        raise UsageError("no tracer is given", "a SUBJECT, or a command after --")
    if options.subject is not None:
        return _attached(options)
    if not options.tracer:
        raise UsageError("no command follows --", "for example -- ./tracer {scene} {image}")
    return attach_command(
        options.tracer,
        options.scene or "text",
        options.image or "pfm",
        options.precision or "float32",
        dialect_words(options.dialect),
    )


def dialect_words(said: list[str] | None) -> dict[str, str]:
    """The KEY=VALUE words of --dialect."""
    words: dict[str, str] = {}
    for word in said or ():
        key, equals, value = word.partition("=")
        if not equals or key in words:
            raise UsageError(f"--dialect {word}: not one new KEY=VALUE", "for example --dialect specular=blinn")
        words[key] = value
    return words


def _attached(options: Namespace) -> Subject:
    """A SUBJECT; options that it states itself must not be given."""
    free = options.subject.startswith(("images:", "python:"))
    for name in ("scene", "image") if free else ("scene", "image", "precision", "dialect"):
        if getattr(options, name) is not None:
            where = "raycheck.toml" if Path(options.subject).is_dir() else "SUBJECT"
            said = " ".join(options.dialect) if name == "dialect" else getattr(options, name)
            raise UsageError(f"--{name} {said} does not go with {options.subject}", f"{where} says it")
    dialect = dialect_of(dialect_words(options.dialect)).choices()
    return attach(options.subject, options.precision or "float32", dialect)


def command_line(options: Namespace) -> str:
    """The call as it can be typed again."""
    tail = ["--", *options.tracer] if options.tracer is not None else []
    return shlex.join(["raycheck", *options.words, *tail])


def size_of(text: str | None, at_once: int = 1) -> tuple[int, int] | None:
    """(width, height) of WxH; so many pictures of this size must fit into memory together."""
    if text is None:
        return None
    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if found is None:
        raise UsageError(f"--size {text}: not a size", "WxH, for example 320x240")
    width, height = int(found[1]), int(found[2])
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE):
        raise UsageError(f"--size {text}: out of range", f"sides from 1 to {MAX_SIDE}")
    check_fits(width, height, f"--size {text}", at_once)
    return width, height


def picture_of(name: str, size: str | None) -> Scene:
    """A scene to be rendered, by file or by name, in the size that is asked for or its own."""
    scene, asked = scene_of(name), size_of(size)
    if asked:
        return scene.resized(*asked)
    check_fits(scene.image.width, scene.image.height, name)
    return scene


def scene_of(name: str) -> Scene:
    """A scene by file, or by name in the catalogue."""
    return load(Path(name)) if is_file(name) else rung(name).scene()
