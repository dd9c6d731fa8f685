"""From what the user typed to a subject."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from raycheck import manifest
from raycheck.errors import UsageError
from raycheck.manifest import DialectTable, Manifest
from raycheck.sandbox import Jail
from raycheck.sandbox.intake import copy
from raycheck.subjects.command import CommandSubject
from raycheck.subjects.fault import FaultSubject
from raycheck.subjects.images import ImagesSubject
from raycheck.subjects.inprocess import PythonSubject, ReferenceSubject
from raycheck.subjects.mitsuba import MitsubaSubject
from raycheck.subjects.povray import PovraySubject
from raycheck.subjects.subject import Subject
from reference_tracer.dialects import SCENE_MODEL, Dialect

FORMS = "a folder with raycheck.toml, builtin:reference, images:DIR, python:module:attr, or -- COMMAND"


def attach(spec: str, precision: str = "float32", dialect: Dialect = SCENE_MODEL) -> Subject:
    """The subject of a SUBJECT argument; `precision` and `dialect` are those of images and Python objects."""
    kind, _, rest = spec.partition(":")
    match kind:
        case "builtin" if rest.split("/")[0] == "reference":
            return ReferenceSubject(rest)
        case "builtin" if rest.split("/")[0] == "mitsuba":
            return MitsubaSubject(rest)
        case "builtin" if rest.split("/")[0] == "povray":
            return PovraySubject(rest)
        case "builtin" if rest.split("/")[0] == "fault":
            return FaultSubject(rest)
        case "builtin":
            raise UsageError(f"{spec}: no such tracer is built in", "builtin:reference, mitsuba, povray or fault/NAME")
        case "images" if not rest:
            raise UsageError(f"{spec}: no such folder", "images:DIR, images:. for the one you are in")
        case "images":
            return ImagesSubject(Path(rest), precision, dialect)
        case "python" if rest.count(":") == 1:
            module, attribute = rest.split(":")
            return PythonSubject(module, attribute, precision, dialect)
        case "python":
            raise UsageError(f"{spec}: not a Python object", "python:module:attr")
    folder = Path(spec)
    if not folder.is_dir():
        raise UsageError(f"{spec}: no such folder", FORMS)
    return CommandSubject(folder.resolve(), manifest.load(folder), spec)


def attach_command(words: list[str], scene: str, image: str, precision: str, dialect: dict[str, str]) -> Subject:
    """A tracer given as its command line, without a manifest; `dialect` holds the words of its table."""
    name = Path(words[0]).name[:200] or repr(words[0])
    table: dict[str, Any] = {"name": name, "render": tuple(words), "scene": scene, "image": image}
    table |= {"precision": precision, "dialect": dialect_of(dialect)}
    try:
        return CommandSubject(Path.cwd(), Manifest.model_validate(table), spec="")
    except ValidationError as error:
        raise UsageError(f"the command after --: {manifest.explain(error)}") from None


def dialect_of(words: dict[str, str]) -> DialectTable:
    """The dialect of key=value words; raise UsageError naming the wrong one."""
    values = {key: {"true": True, "false": False}.get(value, value) for key, value in words.items()}
    try:
        return DialectTable.model_validate(values)
    except ValidationError as error:
        raise UsageError(f"--dialect: {manifest.explain(error)}") from None


def jailed(subject: Subject, folder: Path) -> Subject:
    """The same tracer as a copy in this folder, built and run in a jail."""
    if not isinstance(subject, CommandSubject) or not subject.spec:
        raise UsageError("--sandbox needs a folder with raycheck.toml", "what is not one folder cannot be locked in")
    room = Jail()
    copy(subject.folder, folder / "tracer")
    return replace(subject, folder=folder / "tracer", room=room)
