"""Points for speed: a multiple of the reference tracer's, of right pictures, timed alone on the machine."""

from __future__ import annotations

import shutil
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from oracles.images import Picture
from raycheck.cli import main
from raycheck.examples import examples
from raycheck.grading import speed
from raycheck.grading.rubric import Rubric
from raycheck.grading.speed import Timing, machine, speed_verdicts, timed_scene, timing
from raycheck.sandbox.jail import missing
from raycheck.subjects import Attempt
from raycheck.subjects.inprocess import ReferenceSubject
from reports import grades
from scenes.model import Scene

SCENE = timed_scene(7, (40, 30))


class Clocked(ReferenceSubject):
    """The reference tracer's pictures, at a price: seconds to start, and for each pixel with something in it."""

    def __init__(self, start: float, pixel: float, spoilt: Callable[[Scene, Attempt], Attempt] | None = None) -> None:
        super().__init__("reference/numpy")
        self.start, self.pixel, self.spoilt = start, pixel, spoilt
        self.asked: list[tuple[int, int]] = []

    def render(self, scene: Scene, seed: int) -> Attempt:
        found = super().render(scene, seed)
        pixels = scene.image.width * scene.image.height
        self.asked.append((scene.image.width, scene.image.height))
        found = replace(found, seconds=self.start + (self.pixel * pixels if scene.objects else 0.0))
        return self.spoilt(scene, found) if self.spoilt else found


@pytest.fixture(autouse=True)
def reference(monkeypatch: pytest.MonkeyPatch) -> None:
    """A reference that takes a millisecond a pixel."""
    monkeypatch.setattr(speed, "ReferenceSubject", lambda _: Clocked(0.0, 1e-3))


@pytest.mark.parametrize(("pixel", "times"), [(1e-3, 1.0), (1e-4, 10.0), (1e-5, 100.0)])
def test_a_speed_is_a_multiple_of_the_references_without_the_start(pixel: float, times: float) -> None:
    # The start's 3 s are taken away again: what is left of a picture has their roundings
    rounded = 8 * 2.0**-53 * (1.0 + 3.0 / (pixel * 40 * 30))
    assert timing(Clocked(3.0, pixel), SCENE).times == pytest.approx(times, abs=times * rounded)


def test_a_fast_tracer_is_timed_on_a_larger_picture_and_a_slow_one_on_the_smallest() -> None:
    fast, slow = Clocked(0.1, 1e-5), Clocked(0.1, 1e-2)
    timing(fast, SCENE)
    timing(slow, SCENE)
    # 12 s for 1200 pixels is too long already; 0.9 s for 64 times as many is not
    assert (max(fast.asked), max(slow.asked)) == ((320, 240), (40, 30))


def black(scene: Scene, found: Attempt) -> Attempt:
    picture = found.picture
    assert picture is not None
    return replace(found, picture=Picture(0.0 * picture.values, roundoff=0.0))


def small_only(scene: Scene, found: Attempt) -> Attempt:
    return found if scene.image.width <= 40 else black(scene, found)


def late(scene: Scene, found: Attempt) -> Attempt:
    return Attempt(None, "timeout", "sphere 1 2 3")


@pytest.mark.parametrize(("spoilt", "word"), [(black, "blocked"), (small_only, "blocked"), (late, "timeout")])
def test_only_right_pictures_are_timed_and_the_scene_stays_unknown(
    spoilt: Callable[[Scene, Attempt], Attempt], word: str
) -> None:
    found = timing(Clocked(0.0, 1e-5, spoilt), SCENE)
    assert (found.times, found.word) == (None, word)
    assert not any(digit in found.message for digit in "0123456789")


def test_what_a_tracer_does_not_offer_is_not_timed() -> None:
    plain = Clocked(0.0, 1e-5)
    plain.features = ()
    assert timing(plain, SCENE).word == "unsupported"
    assert plain.asked == []


def test_steps_are_earned_up_to_the_speed() -> None:
    verdicts = speed_verdicts(Timing(12.0), (0.5, 10.0, 100.0))
    assert [(v.check, v.verdict) for v in verdicts] == [
        ("speed/0.5", "pass"),
        ("speed/10", "pass"),
        ("speed/100", "fail"),
    ]
    assert [v.verdict for v in speed_verdicts(Timing(None, "crash", "m"), (1.0, 2.0))] == ["crash", "crash"]
    group = {"name": "speed", "points": 6, "speed": [0.5, 10, 100]}
    assert Rubric.model_validate({"name": "r", "group": [group]}).group[0].checks == tuple(v.check for v in verdicts)


def test_the_timed_scene_follows_from_the_seed_and_is_no_simple_one() -> None:
    scenes = [timed_scene(seed, (40, 30)) for seed in range(0, 2000, 100)]
    assert all(len(scene.objects) >= 3 for scene in scenes)
    assert len({scene.content_hash() for scene in scenes}) == 20
    assert timed_scene(300, (40, 30)) == scenes[3]


def test_a_timing_is_alone_and_asking_is_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    inside: list[str] = []

    def time_it() -> None:
        with machine(alone=True):
            inside.append("alone")

    with machine(alone=False), machine(alone=False):
        waiting = threading.Thread(target=time_it)
        waiting.start()
        time.sleep(0.2)
        assert inside == []
    waiting.join(10.0)
    assert inside == ["alone"]


def test_a_lock_in_a_strangers_hands_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with machine(alone=True):
        (folder,) = tmp_path.iterdir()
    (folder / speed.LOCK).unlink()
    folder.rmdir()
    (tmp_path / "elsewhere").mkdir()
    folder.symlink_to(tmp_path / "elsewhere")
    with pytest.raises(speed.UsageError, match="not a folder of yours"), machine(alone=True):
        pass


@pytest.mark.skipif(bool(missing()) or not shutil.which("make"), reason="a sandbox and make are needed")
def test_a_submission_is_timed_in_the_jail_and_drawn_on_the_class_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()  # the true reference
    shutil.copytree(examples() / "cpp_lecture", tmp_path / "class" / "alice", ignore=shutil.ignore_patterns("tracer"))
    (tmp_path / "r.toml").write_text(
        'name = "r"\n[[group]]\nname = "fast"\npoints = 4\nrungs = ["background"]\nspeed = [1e-3, 1e6]\n', "utf-8"
    )
    words = ["grade", str(tmp_path / "class"), "--rubric", str(tmp_path / "r.toml"), "--out", str(tmp_path / "out")]
    assert main([*words, "--jobs", "2"]) == 0
    record = grades.read(tmp_path / "out" / "records" / "alice.json")
    assert record is not None
    assert record.speed is not None
    # Compiled code against Python's: between a thousandth and a million times as fast, on any machine
    assert (record.earned, [line.verdict for line in record.groups[0].lines]) == (2.67, ["pass", "pass", "fail"])
    assert "Speed and accuracy" in (tmp_path / "out" / "index.html").read_text("utf-8")
