"""What was handed in: a folder of folders and archives."""

from __future__ import annotations

import hashlib
import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from raycheck import manifest
from raycheck.errors import UsageError
from raycheck.grading import archive
from raycheck.sandbox import intake

JUNK = ("__MACOSX",)
"""What archivers add and nobody wrote."""


@dataclass(frozen=True)
class Submission:
    """One hand-in. name: as found; slug: the same as a file name that harms nobody."""

    name: str
    slug: str
    path: Path


def found(folder: Path) -> list[Submission]:
    """Folders and archives in a folder, by name; hidden ones and other files are left out."""
    try:
        entries = sorted(entry for entry in folder.iterdir() if not entry.name.startswith("."))
    except OSError as error:
        raise UsageError(f"{folder}: {error.strerror}", "a folder with one folder or archive a submission") from None
    entries = [entry for entry in entries if entry.is_symlink() or entry.is_dir() or _archived(entry)]
    if not entries:
        raise UsageError(f"{folder}: no submission", f"one folder or archive each: {', '.join(archive.ENDINGS)}")
    stems = Counter(_stem(entry) for entry in entries)
    names = [entry.name if stems[_stem(entry)] > 1 else _stem(entry) for entry in entries]
    return [Submission(name, slug(name), entry) for name, entry in zip(names, entries, strict=True)]


def _archived(entry: Path) -> bool:
    return entry.name.lower().endswith(archive.ENDINGS)


def _stem(entry: Path) -> str:
    """The name without the archive's ending."""
    if entry.is_dir():
        return entry.name
    endings = [ending for ending in archive.ENDINGS if entry.name.lower().endswith(ending)]
    return entry.name[: -max(map(len, endings))] if endings else entry.name


def slug(name: str) -> str:
    """A file name of harmless letters; a changed name gets a mark of its own, so that no two become one."""
    plain = re.sub(r"[^A-Za-z0-9._-]", "_", name)[:60].lstrip(".")
    if plain == name and name == name.lower():
        return name
    mark = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:8]
    return f"{plain}-{mark}"


def take_in(submission: Submission, folder: Path) -> Path:
    """Copy or unpack into folder/tracer; return the folder in it that holds the manifest or the sources."""
    target = folder / "tracer"
    if submission.path.is_symlink():
        raise intake.IntakeError(f"{submission.name!r:.200} is a link", "a folder or an archive")
    if submission.path.is_dir():
        intake.copy(submission.path, target)
    else:
        archive.unpack(submission.path, target)
    return _root(target)


def _root(folder: Path) -> Path:
    """Down through folders that hold nothing but one folder: archives often have one around everything."""
    while not (folder / manifest.FILE).exists():
        inside = [entry for entry in folder.iterdir() if entry.name not in JUNK and not entry.name.startswith("._")]
        if len(inside) != 1 or not inside[0].is_dir():
            break
        folder = inside[0]
    return folder
