"""Pictures in a folder, Python objects, and the reference as a subject."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from oracles.images import write
from raycheck.lanes import best_lanes
from reference_tracer import plain
from reports.results import Results
from scenes.catalogue import rung

Check = Callable[..., Results]
HANDFUL = ("background", "depth-order", "plane-both-sides", "shadow-hard", "mirror-perfect", "glass-sphere")


@pytest.mark.parametrize("variant", ["", "/plain", "/numpy", "/numpy/32", "/numpy/64", "/drjit", "/drjit/32"])
def test_every_variant_of_the_reference_conforms(check: Check, variant: str) -> None:
    if "drjit" in variant and best_lanes() != "drjit":
        pytest.skip("no libLLVM that DrJit can use")
    found = check(f"builtin:reference{variant}", "--size", "40x30", "--scenes", ",".join(HANDFUL))
    assert {v.verdict for v in found.verdicts} == {"pass"}
    assert len(found.verdicts) == len(HANDFUL)
    assert found.subject.precision == ("float32" if variant.endswith("32") else "float64")


@pytest.fixture
def pictures(tmp_path: Path) -> Path:
    folder = tmp_path / "pictures"
    folder.mkdir()
    for name, ending in (("background", "png"), ("headlight-plane", "npy"), ("headlight-sphere", "exr")):
        scene = rung(name).scene().resized(40, 30)
        write(folder / f"{name}.{ending}", plain.render(scene).pixels, scene.display)
    return folder


def test_right_pictures_in_any_format_pass_and_a_missing_one_is_invalid(check: Check, pictures: Path) -> None:
    (pictures / "not-a-scene.png").write_bytes(b"extra")
    (pictures / "notes.txt").write_text("extra")
    scenes = "background,headlight-plane,headlight-sphere,depth-order"
    found = check(f"images:{pictures}", "--size", "40x30", "--scenes", scenes)
    assert [v.verdict for v in found.verdicts] == ["pass", "pass", "pass", "invalid"]
    assert "depth-order.pfm" in found.verdicts[-1].message
    assert [v.process for v in found.verdicts] == [None] * 4


def test_the_folder_one_stands_in_is_a_subject(check: Check, pictures: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(pictures)
    found = check("images:.", "--size", "40x30", "--scenes", "background")
    assert [v.verdict for v in found.verdicts] == ["pass"]
    assert found.subject.name == "images in pictures"
    assert found.subject.spec == "images:."


def test_a_picture_of_another_scene_fails(check: Check, pictures: Path) -> None:
    (pictures / "headlight-sphere.exr").rename(pictures / "depth-order.exr")
    found = check(f"images:{pictures}", "--size", "40x30", "--scenes", "depth-order")
    assert found.verdicts[0].verdict == "fail"


@pytest.mark.parametrize("make", [Path.mkdir, lambda p: p.symlink_to("/etc/passwd"), lambda p: p.write_bytes(b"PF")])
def test_a_picture_that_is_none_is_invalid_and_named(
    check: Check, tmp_path: Path, make: Callable[[Path], object]
) -> None:
    make(tmp_path / "background.pfm")
    verdict = check(f"images:{tmp_path}", "--scenes", "background").verdicts[0]
    assert verdict.verdict == "invalid"
    assert verdict.message.startswith("background.pfm: ")


def test_pictures_by_a_float64_tracer_are_held_to_float64(check: Check, tmp_path: Path) -> None:
    scene = rung("headlight-sphere").scene().resized(40, 30)
    pixels = plain.render(scene).pixels * (1.0 + 1e-9)
    np.save(tmp_path / "headlight-sphere.npy", pixels)
    words = (f"images:{tmp_path}", "--size", "40x30", "--scenes", "headlight-sphere")
    assert check(*words).verdicts[0].verdict == "pass"
    assert check(*words, "--precision", "float64").verdicts[0].verdict == "fail"


MODULE = """
import numpy as np, sys
from pathlib import Path
from reference_tracer import plain
from reference_tracer.vector import Vec
from scenes.files import load

class Renders:
    def render(self, path):
        return plain.render(load(Path(path))).pixels

class Traces:
    def scene(self, path):
        self.tracer = plain.PlainTracer(load(Path(path)))
    def camera(self, i, j):
        assert i.shape == j.shape and i.ndim == 1
        return np.array([self.tracer.eye_ray(int(a), int(b)) for a, b in zip(i, j)])
    def trace(self, o, v):
        assert o.shape == v.shape and o.shape[1] == 3
        ray = lambda a, b: self.tracer.find_rgb(Vec(*map(float, a)), Vec(*map(float, b)), None, 0)
        return np.array([ray(a, b) for a, b in zip(o, v)])

class Raises:
    def render(self, path):
        raise ValueError("no such luck")

class Exits:
    def render(self, path):
        sys.exit(0)

class Flat:
    def render(self, path):
        return np.zeros((30, 40))

class Small:
    def render(self, path):
        return np.zeros((3, 4, 3))

class Nan:
    def render(self, path):
        return np.full((30, 40, 3), np.nan)

class Words:
    def render(self, path):
        return [["no", "numbers"]]

class Short(Traces):
    def trace(self, o, v):
        return np.zeros((7, 3))

class Half:
    def trace(self, o, v):
        return v

class Nothing:
    pass

renders, traces, raises, exits, flat, small, nan = Renders(), Traces(), Raises(), Exits(), Flat(), Small(), Nan()
words, short, half, nothing = Words(), Short(), Half(), Nothing()
"""


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The module above, importable from the current folder."""
    name = "raycheck_test_tracer"
    (tmp_path / f"{name}.py").write_text(MODULE, "utf-8")
    monkeypatch.chdir(tmp_path)
    yield name
    sys.modules.pop(name, None)


@pytest.mark.parametrize("attribute", ["renders", "traces"])
def test_a_right_python_object_passes(check: Check, module: str, attribute: str) -> None:
    words = ("--size", "40x30", "--scenes", "background,depth-order,glass-sphere", "--precision", "float64")
    found = check(f"python:{module}:{attribute}", *words)
    assert [v.verdict for v in found.verdicts] == ["pass"] * 3


@pytest.mark.parametrize(
    ("attribute", "word", "message"),
    [
        ("raises", "error", "ValueError: no such luck"),
        ("exits", "error", "SystemExit: 0"),
        ("flat", "invalid", "array of shape (30, 40)"),
        ("small", "invalid", "image is 4x3"),
        ("nan", "invalid", "nan in the image"),
        ("words", "error", "ValueError"),
        ("short", "invalid", "trace gives an array of shape (7, 3)"),
        ("half", "error", "AttributeError"),
    ],
)
def test_a_wrong_python_object_gets_its_verdict_and_the_run_goes_on(
    check: Check, module: str, attribute: str, word: str, message: str
) -> None:
    scenes = "background,headlight-plane"
    found = check(f"python:{module}:{attribute}", "--size", "40x30", "--scenes", scenes, "--no-block")
    assert [v.verdict for v in found.verdicts] == [word, word]
    assert message in found.verdicts[0].message


@pytest.mark.parametrize(
    ("spec", "message"),
    [
        ("python:{module}:nobody", "AttributeError"),
        ("python:{module}:nothing", "can neither render nor trace"),
        ("python:no_such_module:x", "ModuleNotFoundError"),
        ("python::x", "ValueError"),
    ],
)
def test_a_python_object_that_cannot_be_loaded_is_exit_3(
    raycheck: Callable[..., Any], module: str, spec: str, message: str
) -> None:
    told = raycheck("check", spec.format(module=module), "--scenes", "background")
    assert told.code == 3
    assert message in told.err


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("raise RuntimeError('broken')", "RuntimeError: broken"),
        ("import sys; sys.exit(0)", "SystemExit: 0"),
        ("syntax error", "SyntaxError"),
        ("import os; os.chdir('/'); 1/0", "ZeroDivisionError"),
    ],
)
def test_a_module_that_fails_on_import_is_exit_3(
    raycheck: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: str, message: str
) -> None:
    (tmp_path / "raycheck_test_broken.py").write_text(body, "utf-8")
    monkeypatch.chdir(tmp_path)
    path = list(sys.path)
    told = raycheck("check", "python:raycheck_test_broken:x", "--scenes", "background", "--out", tmp_path / "o")
    assert told.code == 3
    assert message in told.err
    assert sys.path == path
