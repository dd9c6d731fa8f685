"""Archives as strangers pack them: plain ones are unpacked, all else is refused by name, within bounds."""

from __future__ import annotations

import gzip
import io
import lzma
import os
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

from raycheck.grading import archive
from raycheck.grading.archive import unpack
from raycheck.sandbox import intake
from raycheck.sandbox.intake import IntakeError, copy, digest

Make = Callable[[Path], None]


def member(name: str, data: bytes = b"abc", **more: object) -> tuple[tarfile.TarInfo, bytes]:
    info = tarfile.TarInfo(name)
    info.size = len(data)
    for key, value in more.items():
        setattr(info, key, value)
    return info, data


def tar(mode: str, *members: tuple[tarfile.TarInfo, bytes]) -> Make:
    def make(path: Path) -> None:
        with tarfile.open(path, mode) as made:  # type: ignore[call-overload]
            for info, data in members:
                made.addfile(info, io.BytesIO(data))

    return make


def packed(entries: dict[str, bytes], mode: int = 0o100644) -> Make:
    def make(path: Path) -> None:
        with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
            for name, data in entries.items():
                info = zipfile.ZipInfo(name)
                info.external_attr = mode << 16
                made.writestr(info, data, zipfile.ZIP_DEFLATED)

    return make


def endless(opened: Callable[..., io.BufferedIOBase], header: tarfile.TarInfo) -> Make:
    """A header that promises gigabytes, and zeros that shrink to nothing."""

    def make(path: Path) -> None:
        with opened(path, "wb") as stream:
            stream.write(header.tobuf())
            for _ in range(8):
                stream.write(bytes(2**20))

    return make


GOOD = {
    "a.tar": tar("w", member("sub/a.txt", mode=0o755), member("./b")),
    "a.tar.gz": tar("w:gz", member("sub/a.txt", mode=0o755), member("./b")),
    "a.tgz": tar("w:gz", member("sub/a.txt", mode=0o755), member("./b")),
    "a.tar.xz": tar("w:xz", member("sub/a.txt", mode=0o755), member("./b")),
    "a.tar.bz2": tar("w:bz2", member("sub/a.txt", mode=0o755), member("./b")),
    "a.zip": packed({"sub/a.txt": b"abc", "b": b"abc"}, 0o100755),
}


@pytest.mark.parametrize("name", GOOD)
def test_a_plain_archive_is_unpacked(tmp_path: Path, name: str) -> None:
    GOOD[name](tmp_path / name)
    unpack(tmp_path / name, tmp_path / "out")
    files = {p.relative_to(tmp_path / "out").as_posix() for p in (tmp_path / "out").rglob("*") if p.is_file()}
    assert files == {"sub/a.txt", "b"}
    assert (tmp_path / "out" / "sub" / "a.txt").read_bytes() == b"abc"
    assert os.access(tmp_path / "out" / "sub" / "a.txt", os.X_OK)


BAD: dict[str, tuple[Make, str]] = {
    "up.tar": (tar("w", member("../x")), "leads out"),
    "up-inside.tar": (tar("w", member("a/../../x")), "leads out"),
    "absolute.tar": (tar("w", member("/etc/x")), "leads out"),
    "slip.zip": (packed({"../../evil": b"x"}), "leads out"),
    "absolute.zip": (packed({"/etc/evil": b"x"}), "leads out"),
    "backslash.zip": (packed({"a\\..\\evil": b"x"}), "no file name"),
    "link.tar": (tar("w", member("l", b"", type=tarfile.SYMTYPE, linkname="/etc/passwd")), "neither file nor folder"),
    "hard.tar": (tar("w", member("l", b"", type=tarfile.LNKTYPE, linkname="/etc/passwd")), "neither file nor folder"),
    "device.tar": (tar("w", member("l", b"", type=tarfile.CHRTYPE)), "neither file nor folder"),
    "pipe.tar": (tar("w", member("l", b"", type=tarfile.FIFOTYPE)), "neither file nor folder"),
    "link.zip": (packed({"l": b"/etc/passwd"}, 0o120777), "neither file nor folder"),
    "control.tar": (tar("w", member("a\x1b[31m")), "no file name"),
    "newline.zip": (packed({"a\nb": b"x"}), "no file name"),
    "reordered.tar": (tar("w", member("a\u202eb")), "no file name"),
    "twice.tar": (tar("w", member("a"), member("a")), "twice"),
    "file-and-folder.tar": (tar("w", member("a"), member("a/b")), "both a file and a folder"),
    "deep.tar": (tar("w", member("/".join("a" * 60))), "too long"),
    "bomb.zip": (packed({"a": bytes(5 * 2**20)}), "zip bomb"),
    "many.zip": (packed({f"{k}": b"" for k in range(300)}), "files"),
    "bomb.tar.gz": (endless(gzip.open, member("z", b"", size=2**32)[0]), "MiB unpacked"),  # type: ignore[arg-type]
    "bomb.tar.xz": (endless(lzma.open, member("z", b"", size=2**32)[0]), "MiB unpacked"),  # type: ignore[arg-type]
    "header-bomb.tar.gz": (
        endless(gzip.open, member("z", b"", type=tarfile.XHDTYPE, size=2**32)[0]),  # type: ignore[arg-type]
        "MiB unpacked",
    ),
    "junk.zip": (lambda path: path.write_bytes(b"hello") and None, "damaged"),
    "junk.tar": (lambda path: path.write_bytes(b"hello" * 300) and None, "damaged"),
    "cut.tar.gz": (lambda path: path.write_bytes(gzip.compress(bytes(9999))[:20]) and None, "damaged"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_archive_is_refused_by_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    # Bounds of a submission a hundredth of what they are, so that bombs need not be large
    monkeypatch.setattr(intake, "MAX_BYTES", 5 * 2**20)
    monkeypatch.setattr(archive, "MAX_BYTES", 5 * 2**20)
    monkeypatch.setattr(intake, "MAX_ENTRIES", 200)
    monkeypatch.setattr(archive, "MAX_ENTRIES", 200)
    make, message = BAD[name]
    make(tmp_path / name)
    with pytest.raises(IntakeError, match=message):
        unpack(tmp_path / name, tmp_path / "sub" / "out")
    assert {p.name for p in tmp_path.iterdir()} <= {name, "sub"}
    assert all(p.is_relative_to(tmp_path / "sub" / "out") for p in (tmp_path / "sub").rglob("*") if p.is_file())


def test_a_folder_with_a_link_a_pipe_or_a_socket_is_refused(tmp_path: Path) -> None:
    for k, make in enumerate((lambda p: p.symlink_to("/"), os.mkfifo)):
        source = tmp_path / f"{k}"
        source.mkdir()
        make(source / "odd")
        with pytest.raises(IntakeError, match="'odd' is"):
            copy(source, tmp_path / f"copy-{k}")


def test_the_digest_tells_content_names_and_execute_bits_apart(tmp_path: Path) -> None:
    digests = set()
    for k, (name, text, mode) in enumerate(
        [("a", "x", 0o644), ("a", "y", 0o644), ("b", "x", 0o644), ("a", "x", 0o755)]
    ):
        (tmp_path / f"{k}").mkdir()
        (tmp_path / f"{k}" / name).write_text(text)
        (tmp_path / f"{k}" / name).chmod(mode)
        digests.add(digest(tmp_path / f"{k}"))
    assert len(digests) == 4
