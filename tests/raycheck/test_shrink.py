"""raycheck check shrinks what fails first, writes it down, and says how to run it; tracers may do what they like."""

from __future__ import annotations

import json
import shlex
import subprocess
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from oracles.conventions import Convention, Slip
from oracles.verdict import Shrunk, Verdict
from raycheck import session
from raycheck import shrink as shrinking
from raycheck.commands import check as command
from raycheck.errors import StartError
from raycheck.known import Known
from raycheck.shrink import Failing, ShrinkPlan
from raycheck.subjects import Subject, attach
from reports import results
from reports.results import Results
from scenes.catalogue import rung
from scenes.files import load
from scenes.json_form import to_json
from scenes.text import to_text

Attached = Callable[..., Path]
Check = Callable[..., Results]
Raycheck = Callable[..., Any]
Patch = pytest.MonkeyPatch

GREY = "write(image, width, height, 0.5)"
FAULTS = ("exponent-plus-1", "upside-down", "far-root", "no-attenuation", "mirrored-by-2n-minus-i", "cosine-half")


@pytest.fixture(autouse=True)
def time_enough(monkeypatch: Patch) -> None:
    """A machine with other work to do ends no search that should come to its own end."""
    monkeypatch.setattr(command, "ShrinkPlan", partial(ShrinkPlan, seconds=120.0))


def order(spec: str, out: Path, **more: Any) -> session.Order:
    told: dict[str, Any] = {
        "subject": attach(spec),
        "scenes": ["background"],
        "size": (24, 18),
        "out": out,
        "seed": 0,
        "block": True,
        "known": Known({}),
        "command": "",
        "repeat": "raycheck check --scenes {scene}",
        "shrink": ShrinkPlan("raycheck check --scenes {scene}"),
    }
    return session.Order(**(told | more))


def of(found: Results, check: str) -> Shrunk | None:
    (verdict,) = (v for v in found.verdicts if v.check == check)
    return verdict.shrunk


@pytest.mark.parametrize("name", FAULTS)
def test_the_shrunk_scene_fails_the_fault_again_and_passes_the_reference(
    name: str, raycheck: Raycheck, check: Check, tmp_path: Path, monkeypatch: Patch
) -> None:
    monkeypatch.chdir(tmp_path)
    found = check(f"builtin:fault/{name}", "--size", "48x36", "--scenes", SHOWN[name])
    shrunk = of(found, f"image/{SHOWN[name].split(',')[0]}")
    assert shrunk is not None
    assert shrunk.least
    file = tmp_path / "report" / shrunk.file
    scene = load(file)
    assert to_json(scene) == file.read_text("utf-8") == shrunk.text
    assert len(scene.objects) <= len(rung(SHOWN[name].split(",")[0]).scene().objects)
    assert abs(shrunk.got[0] - shrunk.expected[0]) > shrunk.tolerance[0] or shrunk.got[1:] != shrunk.expected[1:]
    again = raycheck(*shlex.split(shrunk.judge)[1:], "--no-shrink", "--out", tmp_path / "again")
    assert again.code == 1
    assert results.read(tmp_path / "again").verdicts[0].check == f"image/{scene.name}"
    assert raycheck("check", "builtin:reference/numpy/32", "--scenes", file, "--out", tmp_path / "right").code == 0


SHOWN = {
    "exponent-plus-1": "phong-10",
    "upside-down": "headlight-plane",
    "far-root": "point-light",
    "no-attenuation": "attenuation-inverse",
    "mirrored-by-2n-minus-i": "mirror-imperfect",
    "cosine-half": "headlight-sphere",
}
"""A scene that notices the fault, alone, so that no convention is found to explain it."""


def test_a_program_gets_its_own_line_in_its_own_notation(attached: Attached, check: Check, tmp_path: Path) -> None:
    folder = attached(GREY, name="team 7")
    shrunk = of(check(folder, "--scenes", "background"), "image/background")
    assert shrunk is not None
    assert shrunk.file == "scenes/background.shrunk.txt"
    assert shrunk.text == to_text(load(tmp_path / "report" / shrunk.file))
    subprocess.run(["sh", "-c", shrunk.run], check=True, cwd=tmp_path)
    assert (tmp_path / "report" / "scenes" / "background.shrunk.pfm").read_bytes().startswith(b"PF\n1 1\n")
    assert shrunk.left == "nothing, depth 0, 1 pixel"
    assert shrunk.got == (0.5, 0.5, 0.5)
    assert shrunk.judge.startswith(f"raycheck check '{folder}' --scenes ")


def test_a_command_gets_its_line_from_where_it_stands(
    script: Callable[..., list[str]], check: Check, tmp_path: Path, monkeypatch: Patch
) -> None:
    monkeypatch.chdir(tmp_path)
    shrunk = of(check("--scenes", "background", "--scene", "text", "--", *script(GREY)), "image/background")
    assert shrunk is not None
    assert "cd " not in shrunk.run
    subprocess.run(["sh", "-c", shrunk.run], check=True, cwd=tmp_path)
    assert (tmp_path / "report" / "scenes" / "background.shrunk.pfm").is_file()
    assert "--size" not in shrunk.judge
    assert shrunk.judge.partition(" -- ")[0].endswith(f"--scenes {tmp_path}/report/scenes/background.shrunk.txt")


def test_only_the_first_failures_that_build_on_none_are_shrunk(check: Check) -> None:
    scenes = "headlight-plane,headlight-sphere,depth-order,ambient-diffuse,point-light,directional-light"
    found = check("builtin:fault/cosine-half", "--size", "24x18", "--no-block", "--scenes", scenes)
    shrunk = [v for v in found.verdicts if v.shrunk]
    failed = {v.check.removeprefix("image/") for v in found.verdicts if v.verdict == "fail"}
    assert 1 <= len(shrunk) <= 3
    assert all(failed.isdisjoint(v.requires) for v in shrunk)
    assert len(failed) > 3


def test_no_shrink_leaves_it_out_and_removes_what_was(check: Check, tmp_path: Path) -> None:
    check("builtin:fault/exponent-plus-1", "--size", "24x18", "--scenes", "phong-10")
    assert len(list((tmp_path / "report" / "scenes").iterdir())) == 1
    (tmp_path / "report" / "scenes" / "mine.json").write_text("")
    found = check("builtin:fault/exponent-plus-1", "--size", "24x18", "--scenes", "background", "--no-shrink")
    assert of(found, "image/background") is None
    assert [path.name for path in (tmp_path / "report" / "scenes").iterdir()] == ["mine.json"]


def test_what_passes_is_not_shrunk(check: Check, tmp_path: Path) -> None:
    check("builtin:reference/numpy/32", "--size", "16x12", "--scenes", "background,phong-10")
    assert not (tmp_path / "report" / "scenes").exists()


def test_a_picture_that_crashes_the_tracer_is_another_complaint(attached: Attached, check: Check) -> None:
    body = "if width < 5: sys.exit(3)\n" + GREY
    shrunk = of(check(attached(body), "--scenes", "background"), "image/background")
    assert shrunk is not None
    assert shrunk.left == "nothing, depth 0, 8x6 pixels"


def counted(folder: Path) -> int:
    return len((folder / "count").read_text("utf-8"))


COUNT = 'with open("count", "a") as log: log.write("x")\ncount = len(open("count").read())\n'


def test_a_tracer_that_fails_at_random_ends(attached: Attached, tmp_path: Path) -> None:
    folder = attached(COUNT + "import random\nrandom.seed(count)\nwrite(image, width, height, random.random() // 0.5)")
    plan = ShrinkPlan("{scene}", tries=60, seconds=60.0)
    found, _ = session.check(order(str(folder), tmp_path / "report", shrink=plan))
    assert found.complete
    assert counted(folder) <= 62


@pytest.mark.parametrize("wrong", [1, 2, 5])
def test_what_fails_by_chance_is_not_shown(wrong: int, attached: Attached, check: Check, tmp_path: Path) -> None:
    right = "with open(image, 'wb') as f:\n    f.write(b'PF\\n%d %d\\n-1.0\\n' % (width, height))"
    right += "\n    f.write(struct.pack('<3f', *background) * (width * height))"
    folder = attached(
        COUNT + f"write(image, width, height, 0.5)\nif count > {wrong}:\n  " + right.replace("\n", "\n  ")
    )
    assert of(check(folder, "--scenes", "background"), "image/background") is None
    assert not (tmp_path / "report" / "scenes").exists()


def test_a_slow_tracer_is_not_asked_again(attached: Attached, tmp_path: Path) -> None:
    folder = attached(COUNT + "import time\ntime.sleep(0.4)\n" + GREY)
    plan = ShrinkPlan("{scene}", seconds=1.0)
    found, _ = session.check(order(str(folder), tmp_path / "report", shrink=plan))
    assert of(found, "image/background") is None
    assert counted(folder) == 1


def test_a_tracer_that_hangs_on_small_pictures_costs_no_more_than_the_time_there_is(
    attached: Attached, tmp_path: Path
) -> None:
    folder = attached("import time\nif width < 24: time.sleep(25)\n" + GREY)
    begin = time.monotonic()
    found, _ = session.check(order(str(folder), tmp_path / "report", shrink=ShrinkPlan("{scene}", seconds=2.0)))
    assert time.monotonic() - begin < 20.0
    assert found.complete
    assert [v.verdict for v in found.verdicts] == ["fail"]


def test_an_interrupt_loses_nothing(tmp_path: Path, monkeypatch: Patch, capsys: pytest.CaptureFixture[str]) -> None:
    asked = Failing.__call__
    calls: list[object] = []

    def interrupted(self: Failing, scene: Any) -> Any:
        calls.append(scene)
        if len(calls) == 3:
            raise KeyboardInterrupt
        return asked(self, scene)

    monkeypatch.setattr(Failing, "__call__", interrupted)
    out = tmp_path / "report"
    found, code = session.check(order("builtin:fault/exponent-plus-1", out, scenes=["background", "phong-10"]))
    assert code == 1
    assert found == results.read(out)
    assert found.complete
    assert [(v.verdict, v.shrunk) for v in found.verdicts] == [("pass", None), ("fail", None)]
    assert "interrupted" in capsys.readouterr().err


def test_a_tracer_that_is_gone_leaves_the_verdicts(tmp_path: Path, monkeypatch: Patch) -> None:
    def gone(self: Failing, scene: Any) -> Any:
        raise StartError("gone")

    monkeypatch.setattr(Failing, "__call__", gone)
    found, code = session.check(order("builtin:fault/exponent-plus-1", tmp_path, scenes=["phong-10"]))
    assert (code, found.complete, found.verdicts[0].shrunk) == (1, True, None)


def test_a_file_in_the_way_is_named_before_anything_is_asked(raycheck: Raycheck, tmp_path: Path) -> None:
    (tmp_path / "scenes").write_text("")
    told = raycheck("check", "builtin:fault/exponent-plus-1", "--scenes", "phong-10", "--out", tmp_path)
    assert told.code == 2
    assert "scenes: not a folder" in told.err


def test_a_scene_that_cannot_be_written_keeps_the_verdicts(
    raycheck: Raycheck, tmp_path: Path, monkeypatch: Patch
) -> None:
    def full(path: Path, data: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(shrinking, "write_whole", full)
    words = ("--scenes", "phong-10", "--size", "24x18", "--out", tmp_path)
    told = raycheck("check", "builtin:fault/exponent-plus-1", *words)
    assert told.code == 2
    assert "No space left" in told.err
    assert results.read(tmp_path).verdicts[0].verdict == "fail"


def test_images_and_draws_are_not_shrunk(raycheck: Raycheck, tmp_path: Path, monkeypatch: Patch) -> None:
    raycheck("render", "background", tmp_path / "phong-10.npy", "--size", "24x18")
    plan = {"scenes": ["phong-10"], "size": (24, 18)}
    found, _ = session.check(order(f"images:{tmp_path}", tmp_path / "report", **plan))
    assert [(v.verdict, v.shrunk) for v in found.verdicts] == [("fail", None)]
    drawn = attach("builtin:fault/exponent-plus-1")
    drawn.spp = 4
    hearing = session.Hearing(drawn, session.Plan([rung("phong-10")], None, 0, True, Known({}), ""), tmp_path)
    failed = Verdict(check="image/phong-10", verdict="fail", message="")
    assert list(shrinking.shrunk(hearing, ShrinkPlan(""), [failed], tmp_path, print)) == []


def failing(spec: str, convention: Convention) -> Failing:
    subject: Subject = attach(spec)
    return Failing(subject, 0, convention, time.monotonic() + 60.0)


def test_slips_that_were_found_are_undone_before_a_picture_is_judged() -> None:
    scene = rung("point-light").scene().resized(24, 18)
    assert failing("builtin:fault/upside-down", Convention())(scene) is not None
    assert failing("builtin:fault/upside-down", Convention(slip=Slip(flip="upside down")))(scene) is None


def test_one_pixel_cannot_be_divided_by_width_minus_one() -> None:
    stretched = failing("builtin:fault/far-root", Convention(slip=Slip(pixel="w-1")))
    scene = rung("point-light").scene()
    assert stretched(scene.resized(1, 8)) is None
    assert stretched(scene.resized(24, 18)) is not None


def test_pixels_in_doubt_count_only_where_all_are() -> None:
    asked = failing("builtin:fault/far-root", Convention())
    assert asked(rung("point-light").scene().resized(24, 18)) is not None
    assert asked.clear is True
    (i, j), told = asked.worst["pixel"], asked.worst  # type: ignore[misc]
    assert told["got"] != told["expected"]
    assert (i, j) != (0, 0)


def test_a_convention_that_was_allowed_for_is_said(attached: Attached, tmp_path: Path) -> None:
    plan = session.Plan([rung("point-light")], (24, 18), 0, True, Known({}), "")
    hearing = session.Hearing(attach("builtin:fault/far-root"), plan, tmp_path)
    verdicts = list(hearing.verdicts())
    hearing.convention = replace(hearing.convention, slip=Slip(channels="BGR"))
    ((_, verdict),) = shrinking.shrunk(hearing, ShrinkPlan("{scene}"), verdicts, tmp_path, print)
    assert verdict.shrunk is not None
    assert verdict.shrunk.under == "have red and blue exchanged"


def test_a_shrunk_scene_is_not_shrunk_again(raycheck: Raycheck, check: Check, tmp_path: Path) -> None:
    shrunk = of(check("builtin:fault/cosine-half", "--scenes", "headlight-sphere"), "image/headlight-sphere")
    assert shrunk is not None
    file = tmp_path / "report" / shrunk.file
    before = file.read_bytes()
    (again,) = check("builtin:fault/cosine-half", "--scenes", file).verdicts
    assert (again.verdict, again.shrunk) == ("fail", None)
    assert file.read_bytes() == before
    assert str(file) in again.reproduce


@pytest.mark.parametrize("form", ["json", "txt"])
def test_check_judges_scene_files(form: str, check: Check, tmp_path: Path) -> None:
    file = tmp_path / f"mine.{form}"
    scene = rung("phong-10").scene().resized(16, 12).model_copy(update={"name": "mine", "source": "a book"})
    file.write_text(to_json(scene) if form == "json" else to_text(scene), "utf-8")
    found = check("builtin:reference/numpy/32", "--scenes", f"background,{file}")
    assert [(v.check, v.verdict) for v in found.verdicts] == [("image/background", "pass"), ("image/mine", "pass")]
    assert found.verdicts[1].reproduce.endswith(f"--scenes {file}")
    assert (found.verdicts[1].slide, found.verdicts[1].formula) == ("", "")


def test_a_scene_file_that_is_none_and_two_of_one_name_are_misuse(raycheck: Raycheck, tmp_path: Path) -> None:
    told = raycheck("check", "builtin:reference", "--scenes", tmp_path / "no.json", "--out", tmp_path / "report")
    assert told.code == 2
    assert "no.json" in told.err
    file = tmp_path / "other.json"
    file.write_text(to_json(rung("background").scene()), "utf-8")
    told = raycheck("check", "builtin:reference", "--scenes", f"background,{file}", "--out", tmp_path / "report")
    assert told.code == 2
    assert "another scene is called background" in told.err


def test_two_runs_shrink_to_the_same_scene(check: Check, tmp_path: Path) -> None:
    seen = []
    for _ in range(2):
        check("builtin:fault/far-root", "--size", "24x18", "--scenes", "point-light,phong-10")
        found = json.loads((tmp_path / "report" / "results.json").read_text("utf-8"))
        seen.append([verdict["shrunk"] for verdict in found["verdicts"]])
    assert seen[0] == seen[1]
    assert any(seen[0])


def test_large_pictures_are_not_tried_again() -> None:
    asked = failing("builtin:fault/far-root", Convention())
    large = rung("point-light").scene().resized(200, 150)
    assert asked(large) is not None
    assert asked(large) is None
    assert asked(large.resized(20, 15)) is not None
