"""Archives as strangers pack them: unpacked within bounds, or refused by name."""

from __future__ import annotations

import bz2
import contextlib
import gzip
import io
import lzma
import stat
import tarfile
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, cast

from raycheck.sandbox.intake import MAX_BYTES, MAX_ENTRIES, Intake, IntakeError

ENDINGS = (".zip", ".tar", ".tar.gz", ".tgz", ".tar.xz", ".txz", ".tar.bz2", ".tbz2")
MAX_ARCHIVE = 128 * 2**20
MAX_RATIO = 1000
"""Unpacked over packed size beyond which a zip entry is a bomb: sources shrink 3 to 20 times, deflate at most 1032."""
DIRECTORY_ENTRY = 46
"""Least bytes of an entry in a zip's central directory (PKWARE APPNOTE 4.3.12)."""
XZ_MEMORY = 256 * 2**20
"""Memory that unpacking xz may ask for: xz -9 needs 65 MiB."""

_CHUNK = 2**16


def unpack(archive: Path, target: Path) -> None:
    """Unpack into a new folder; raise IntakeError for links, devices, names that lead out, bombs and damage."""
    if archive.stat().st_size > MAX_ARCHIVE:
        raise IntakeError(f"{archive.name}: over {MAX_ARCHIVE // 2**20} MiB", "sources only, no build results")
    take = _zip if archive.name.lower().endswith(".zip") else _tar
    try:
        take(archive, Intake(target))
    except (zipfile.BadZipFile, tarfile.TarError, zlib.error, lzma.LZMAError, EOFError, NotImplementedError) as error:
        raise IntakeError(f"{archive.name}: damaged: {error}", "an archive that can be unpacked") from None
    except (UnicodeError, ValueError, RuntimeError, gzip.BadGzipFile) as error:  # RuntimeError: encrypted
        raise IntakeError(f"{archive.name}: cannot be unpacked: {error}", "a plain archive") from None


def _zip(archive: Path, intake: Intake) -> None:
    _directory_bounded(archive)
    with zipfile.ZipFile(archive) as packed:
        for entry in packed.infolist():
            mode = entry.external_attr >> 16
            if stat.S_IFMT(mode) not in (0, stat.S_IFREG, stat.S_IFDIR):
                raise IntakeError(f"{entry.filename!r:.200} is neither file nor folder", "files and folders only")
            if entry.is_dir():
                intake.make(entry.filename)
                continue
            if entry.file_size > MAX_RATIO * max(1, entry.compress_size):
                raise IntakeError(f"{entry.filename!r:.200} is a zip bomb", "an archive of sources")
            with packed.open(entry) as stream:
                intake.put(entry.filename, stream, bool(mode & 0o100))


def _directory_bounded(archive: Path) -> None:
    """Refuse a directory of millions of entries before zipfile reads it into memory."""
    with open(archive, "rb") as stream:
        size = stream.seek(0, io.SEEK_END)
        stream.seek(max(0, size - 65557))  # the end record and the longest comment after it
        end = stream.read()
    at = end.rfind(b"PK\x05\x06")
    if at < 0 or len(end) < at + 22:
        raise zipfile.BadZipFile("no end of central directory")
    if int.from_bytes(end[at + 12 : at + 16], "little") > MAX_ENTRIES * (DIRECTORY_ENTRY + 300):
        raise IntakeError(f"more than {MAX_ENTRIES} files", "sources only, no build results")


def _tar(archive: Path, intake: Intake) -> None:
    with _unpacked(archive) as stream, tarfile.open(fileobj=cast(IO[bytes], _Bounded(stream)), mode="r|") as packed:
        for entry in packed:
            name = entry.name.removeprefix("./")
            if name in ("", "."):
                continue
            if entry.isdir():
                intake.make(name)
            elif entry.isreg() and (content := packed.extractfile(entry)) is not None:
                intake.put(name, content, bool(entry.mode & 0o100))
            else:
                raise IntakeError(f"{name!r:.200} is neither file nor folder", "files and folders only, no links")


@contextlib.contextmanager
def _unpacked(archive: Path) -> Iterator[IO[bytes]]:
    """The bytes of the tar itself, by what the archive begins with."""
    with open(archive, "rb") as raw:
        start = raw.read(6)
        raw.seek(0)
        if start.startswith(b"\x1f\x8b"):
            yield cast(IO[bytes], gzip.GzipFile(fileobj=raw))
        elif start.startswith(b"BZh"):
            yield io.BufferedReader(_Stream(raw, bz2.BZ2Decompressor()))
        elif start == b"\xfd7zXZ\x00":
            yield io.BufferedReader(_Stream(raw, lzma.LZMADecompressor(lzma.FORMAT_XZ, memlimit=XZ_MEMORY)))
        else:
            yield raw


class _Stream(io.RawIOBase):
    """What a decompressor makes of a file, a bounded piece at a time."""

    def __init__(self, raw: IO[bytes], decompressor: bz2.BZ2Decompressor | lzma.LZMADecompressor) -> None:
        self.raw, self.decompressor = raw, decompressor

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]
        while not self.decompressor.eof:
            packed = self.raw.read(_CHUNK) if self.decompressor.needs_input else b""
            if self.decompressor.needs_input and not packed:
                raise EOFError("the archive ends early")
            piece = self.decompressor.decompress(packed, len(buffer))
            if piece:
                buffer[: len(piece)] = piece
                return len(piece)
        return 0


class _Bounded:
    """A stream that ends in an error after as much as a submission may hold, headers and padding included."""

    def __init__(self, stream: IO[bytes]) -> None:
        self.stream, self.left = stream, MAX_BYTES + MAX_ENTRIES * 2048

    def read(self, size: int) -> bytes:
        data = self.stream.read(size)
        self.left -= len(data)
        if self.left < 0:
            raise IntakeError(f"more than {MAX_BYTES // 2**20} MiB unpacked", "sources only, no build results")
        return data
