"""What killed processes left behind goes at the next start; what living ones use stays."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from raycheck import leftovers, workspace
from raycheck.sandbox import cgroup
from raycheck.sandbox.limits import Limits

ROOT = Path(__file__).resolve().parents[2]
HOLDS = """
import sys, time
from pathlib import Path
from raycheck.workspace import workspace
with workspace() as outer, workspace() as inner:
    (outer / "file").write_text("x")
    print(outer, inner, flush=True)
    time.sleep(60)
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    workspace._sweep.cache_clear()
    yield tmp_path
    workspace._sweep.cache_clear()


@pytest.fixture
def holder(place: Path) -> Iterator[subprocess.Popen[str]]:
    """Another process with two workspaces."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), "TMPDIR": str(place)}
    child = subprocess.Popen([sys.executable, "-P", "-c", HOLDS], env=environment, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    child.stdout.readline()
    yield child
    child.kill()
    child.communicate()


def test_a_killed_process_leaves_folders_that_the_next_start_removes(
    place: Path, holder: subprocess.Popen[str]
) -> None:
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    assert len(list(place.iterdir())) == 2
    with workspace.workspace() as own:
        assert list(place.iterdir()) == [own]


def test_a_living_process_keeps_its_folders(place: Path, holder: subprocess.Popen[str]) -> None:
    with workspace.workspace():
        assert len(list(place.iterdir())) == 3
        assert holder.poll() is None


def test_others_names_files_and_links_stay(place: Path) -> None:
    (place / "precious").mkdir()
    (place / f"{workspace.PREFIX}file").write_text("x")
    (place / f"{workspace.PREFIX}link").symlink_to(place / "precious")
    with workspace.workspace():
        pass
    assert {path.name for path in place.iterdir()} == {
        "precious",
        f"{workspace.PREFIX}file",
        f"{workspace.PREFIX}link",
    }


def test_a_folder_that_was_swept_before_it_was_locked_is_not_held(tmp_path: Path) -> None:
    with leftovers.claimed(tmp_path / "gone") as held:
        assert not held


def test_control_groups_of_killed_processes_go_too(tmp_path: Path) -> None:
    (tmp_path / "raycheck-1-dead").mkdir()
    (tmp_path / "raycheck-2-busy").mkdir()
    (tmp_path / "raycheck-2-busy" / "process").touch()  # a group in use cannot be removed
    with leftovers.claimed(tmp_path / "raycheck-1-dead"), cgroup.cgroup(Limits(), tmp_path):
        assert (tmp_path / "raycheck-1-dead").is_dir()
    cgroup._sweep.cache_clear()
    with cgroup.cgroup(Limits(), tmp_path):
        pass
    assert [path.name for path in tmp_path.iterdir()] == ["raycheck-2-busy"]
