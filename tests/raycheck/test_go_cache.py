"""The Go library's cache: shown to jails that build Go programs, read only; done without where it cannot be made."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from raycheck import process
from raycheck.sandbox import Jail, go_cache
from raycheck.sandbox.jail import missing

needs_a_sandbox = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")


@pytest.fixture(autouse=True)
def forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.setenv("RAYCHECK_CACHE", str(tmp_path / "cache"))
    go_cache._filled.cache_clear()
    yield
    go_cache._filled.cache_clear()


def compiler(fails: bool = False) -> tuple[list[str], object]:
    """A Go that tells its version and leaves a file in its cache, and what it was called with."""
    calls: list[str] = []

    def go(*words: str, cache: Path | None = None) -> str:
        calls.append(words[0])
        if cache is not None:
            (cache / "compiled").write_text("x")
            if fails:
                raise subprocess.CalledProcessError(1, "go")
        return "go version go1.99"

    return calls, go


def test_the_cache_is_made_once_and_only_for_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls, go = compiler()
    monkeypatch.setattr(go_cache, "_go", go)
    source = tmp_path / "tracer" / "deep"
    source.mkdir(parents=True)
    assert go_cache.wanted((tmp_path / "tracer",)) is None
    (source / "tracer.go").touch()
    found = go_cache.wanted((tmp_path / "tracer",))
    assert found is not None
    assert found.parent == tmp_path / "cache-go"
    assert [path.name for path in found.iterdir()] == ["compiled"]
    go_cache._filled.cache_clear()
    assert go_cache.wanted((tmp_path / "tracer",)) == found
    assert calls == ["version", "build", "version"]


def test_where_it_cannot_be_made_go_does_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(go_cache, "_go", compiler(fails=True)[1])
    (tmp_path / "tracer.go").touch()
    assert go_cache.wanted((tmp_path,)) is None
    assert list((tmp_path / "cache-go").iterdir()) == []


@needs_a_sandbox
def test_a_jail_reads_the_cache_and_cannot_write_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(go_cache, "_go", compiler()[1])
    folder = tmp_path / "tracer"
    folder.mkdir()
    (folder / "tracer.go").touch()
    script = 'cat "$GOCACHE/compiled"; touch "$GOCACHE/mine" || echo " kept out"'
    with Jail().hold(read=(), write=(folder,)) as hold:
        ended = process.run(["sh", "-c", script], folder, 10.0, 2**20, hold=hold)
    assert ended.tail.startswith("x")
    assert "kept out" in ended.tail
    (folder / "tracer.go").unlink()
    with Jail().hold(read=(), write=(folder,)) as hold:
        ended = process.run(["sh", "-c", 'echo "[$GOCACHE]"'], folder, 10.0, 2**20, hold=hold)
    assert ended.tail == "[]"
