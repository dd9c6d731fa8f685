"""Pictures that would not fit are refused before they are begun, and the bytes a pixel are those it takes."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from oracles.compare import compare
from oracles.images import Picture
from oracles.truth import truth
from raycheck import memory
from raycheck.errors import UsageError
from reference_tracer import certified
from reference_tracer.lanes.render import backend
from scenes.catalogue import rung
from scenes.json_form import to_json
from scenes.model import Scene

SCENE = rung("headlight-sphere").scene()


def certify(scene: Scene) -> None:
    certified.render(scene, backend("numpy", 64))


def judge(scene: Scene) -> None:
    expected = truth(scene, "float32")
    compare(Picture(expected.pixels.copy(), roundoff=2.0**-24), expected)


def peak(run: Callable[[Scene], None], width: int, height: int) -> int:
    """Bytes at the peak, what the lanes of a tile take among them."""
    scene = SCENE.resized(width, height)
    tracemalloc.start()
    try:
        run(scene)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("run", [certify, judge])
def test_a_pixel_takes_no_more_than_is_said_and_most_of_it(run: Callable[[Scene], None]) -> None:
    small, large = (peak(run, side, side) for side in (512, 1024))
    each = (large - small) / (1024**2 - 512**2)
    assert memory.PIXEL / 2 < each <= memory.PIXEL


@pytest.mark.parametrize(
    "words",
    [
        ("check", "builtin:reference"),
        ("render", "glass-sphere", "x.pfm"),
        ("needs", "glass-sphere"),
        ("golden", "make", "goldens"),
        ("peers",),
        ("power",),
    ],
    ids=lambda words: words[0],
)
def test_a_size_beyond_the_memory_is_exit_2_and_named(
    raycheck: Any, words: tuple[str, ...], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(memory, "memory", lambda: 2**34)
    told = raycheck(*words, "--size", "16384x16384")
    assert told.code == 2
    assert "--size 16384x16384: 16384x16384 pixels with their proof take 64 GiB of memory, there are 16 GiB" in told.err
    assert "a smaller --size WxH" in told.err
    assert list(tmp_path.iterdir()) == []


def test_a_scene_files_own_size_is_refused_too_and_a_smaller_one_drawn(
    raycheck: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(memory, "memory", lambda: memory.PIXEL * 1000)
    scene = tmp_path / "large.json"
    scene.write_text(to_json(SCENE.resized(40, 30)), "utf-8")
    told = raycheck("render", scene, tmp_path / "x.pfm")
    assert told.code == 2
    assert f"{scene}: 40x30 pixels" in told.err
    assert raycheck("render", scene, tmp_path / "x.pfm", "--size", "20x15").code == 0


def test_what_fits_once_may_not_fit_in_several_jobs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "memory", lambda: memory.PIXEL * 100)
    memory.check_fits(10, 10, "x")
    with pytest.raises(UsageError, match="2 at once") as caught:
        memory.check_fits(10, 10, "x", at_once=2)
    assert "fewer --jobs" in str(caught.value.hint)


def test_a_containers_limit_counts_and_none_does_not(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    whole = memory.memory()
    limit, none = tmp_path / "limit", tmp_path / "none"
    limit.write_text("1000000\n")
    none.write_text("max\n")
    monkeypatch.setattr(memory, "_LIMITS", (limit, none, tmp_path / "missing"))
    assert memory.memory() == 1_000_000 < whole
