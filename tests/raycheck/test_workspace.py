"""The folder of one exchange goes away, whatever a program made of it."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from raycheck.workspace import workspace


def fill(folder: Path) -> None:
    (folder / "file").write_text("x")
    (folder / "sub").mkdir()


def nest_deeper_than_the_stack(folder: Path) -> None:
    here = Path.cwd()
    os.chdir(folder)
    try:
        for _ in range(1500):
            os.mkdir("d")
            os.chdir("d")
    finally:
        os.chdir(here)


def remove(folder: Path) -> None:
    folder.rmdir()


def become_a_file(folder: Path) -> None:
    folder.rmdir()
    folder.write_text("x")


def become_a_dangling_link(folder: Path) -> None:
    folder.rmdir()
    folder.symlink_to("/nowhere/at/all")


def lock(folder: Path) -> None:
    (folder / "sub").mkdir()
    (folder / "sub" / "file").write_text("x")
    (folder / "sub").chmod(0)


@pytest.mark.parametrize(
    "mischief", [fill, nest_deeper_than_the_stack, remove, become_a_file, become_a_dangling_link, lock]
)
def test_nothing_is_left_of_a_workspace(mischief: Callable[[Path], None]) -> None:
    with workspace() as folder:
        mischief(folder)
    assert not os.path.lexists(folder)


def test_a_link_in_the_place_of_a_workspace_is_removed_and_not_followed(tmp_path: Path) -> None:
    (tmp_path / "precious").write_text("x")
    with workspace() as folder:
        shutil.rmtree(folder)
        folder.symlink_to(tmp_path)
    assert not os.path.lexists(folder)
    assert (tmp_path / "precious").read_text() == "x"


def test_a_workspace_goes_away_under_an_error() -> None:
    with pytest.raises(KeyError), workspace() as folder:
        raise KeyError
    assert not folder.exists()
