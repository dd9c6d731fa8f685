"""Taking in a stranger's files: copied one by one, so that what arrives is plain files and folders of bounded size."""

from __future__ import annotations

import errno
import hashlib
import os
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO

from raycheck.errors import RaycheckError

CHUNK = 2**20
MAX_ENTRIES = 20_000
MAX_BYTES = 512 * 2**20
MAX_PARTS = 40
MAX_NAME = 255  # bytes, as file systems have it


@dataclass
class IntakeError(RaycheckError):
    """A stranger's folder or archive holds what is not taken in."""


@dataclass
class Intake:
    """A new folder being filled. Raises IntakeError for names that leave it, and beyond its bounds."""

    folder: Path
    entries: int = 0
    size: int = 0
    seen: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.folder.mkdir(parents=True)

    def make(self, name: str) -> None:
        """A folder; one that is there already is no harm."""
        path = self._place(name)
        self._make(path)

    def put(self, name: str, stream: IO[bytes], executable: bool) -> None:
        """A file, its bytes counted as they come."""
        path = self._place(name)
        if name in self.seen or path.exists():
            raise IntakeError(f"{name!r:.200} is there twice", "each name once")
        self.seen.add(name)
        self._make(path.parent)
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o755 if executable else 0o644)
        with os.fdopen(descriptor, "wb") as target:
            while chunk := stream.read(CHUNK):
                self.size += len(chunk)
                if self.size > MAX_BYTES:
                    raise IntakeError(f"more than {MAX_BYTES // 2**20} MiB unpacked", "sources only, no build results")
                target.write(chunk)

    def _make(self, path: Path) -> None:
        try:
            path.mkdir(parents=True, exist_ok=True)
        except (FileExistsError, NotADirectoryError):
            name = str(path.relative_to(self.folder))
            raise IntakeError(f"{name!r:.200} is both a file and a folder", "each name once") from None

    def _place(self, name: str) -> Path:
        self.entries += 1
        if self.entries > MAX_ENTRIES:
            raise IntakeError(f"more than {MAX_ENTRIES} files", "sources only, no build results")
        return self.folder.joinpath(*parts_of(name))


def parts_of(name: str) -> list[str]:
    """The parts of a relative path; raise IntakeError if it is none, or unprintable."""
    parts = name.rstrip("/").split("/")
    if not name or name.startswith("/") or any(part in ("", ".", "..") for part in parts):
        raise IntakeError(f"{name!r:.200} leads out of the folder", "relative names without `..`")
    if "\\" in name or not name.isprintable():  # surrogates are not printable either
        raise IntakeError(f"{name!r:.200} is no file name", "printable characters, no backslash")
    if len(parts) > MAX_PARTS or any(len(part.encode()) > MAX_NAME for part in parts):
        raise IntakeError(f"{name!r:.200} is too long", f"at most {MAX_PARTS} parts of {MAX_NAME} bytes")
    return parts


def copy(source: Path, target: Path) -> None:
    """Copy a folder; links, devices and pipes are refused by name."""
    intake = Intake(target)
    left = [("", source)]
    while left:
        prefix, folder = left.pop()
        with os.scandir(folder) as found:
            entries = sorted(found, key=lambda entry: entry.name)
        for entry in entries:
            name = prefix + entry.name
            if entry.is_symlink():
                raise IntakeError(f"{name!r:.200} is a link", "files and folders only")
            if entry.is_dir():
                intake.make(name)
                left.append((f"{name}/", Path(entry.path)))
            elif entry.is_file():
                _take(intake, name, entry)
            else:
                raise IntakeError(f"{name!r:.200} is neither file nor folder", "files and folders only")


def _take(intake: Intake, name: str, entry: os.DirEntry[str]) -> None:
    try:
        descriptor = os.open(entry.path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.ENOENT, errno.ENXIO):  # another thing by now
            raise IntakeError(f"{name!r:.200} changes while it is read") from None
        raise
    with os.fdopen(descriptor, "rb") as stream:
        intake.put(name, stream, bool(os.fstat(descriptor).st_mode & 0o100))


def digest(folder: Path) -> str:
    """SHA-256 over names, execute bits and bytes: the same content, the same digest."""
    total = hashlib.sha256()
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        with open(path, "rb") as stream:
            content = hashlib.file_digest(stream, "sha256").hexdigest()
        executable = bool(path.stat().st_mode & 0o100)
        total.update(f"{path.relative_to(folder).as_posix()}\0{executable}\0{content}\n".encode())
    return total.hexdigest()


def remove(folder: Path) -> None:
    """Remove what was taken in and whatever became of it; nothing is followed."""
    shutil.rmtree(folder, ignore_errors=True)
