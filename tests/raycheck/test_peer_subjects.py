"""Mitsuba and POV-Ray as subjects: both come out as they deserve, and a death inside them is a verdict."""

from __future__ import annotations

import shutil
import xml.etree.ElementTree as ET
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from oracles.peers import aov
from oracles.peers.formulas import errors, exactly
from oracles.peers.strata import strata
from raycheck.errors import UsageError
from raycheck.subjects import attach
from raycheck.subjects.child import Child
from raycheck.subjects.mitsuba import MitsubaSubject
from raycheck.subjects.mitsuba_process import VARIANTS, MitsubaProcess
from reference_tracer import llvm
from reports import results
from scenes.catalogue import rung

from .conftest import Told

Check = Callable[..., results.Results]
needs_mitsuba = pytest.mark.skipif(find_spec("mitsuba") is None, reason="Mitsuba is not installed")
needs_povray = pytest.mark.skipif(shutil.which("povray") is None, reason="POV-Ray is not installed")
HANDFUL = "background,plane-scaled-normal,shadow-hard,phong-100,attenuation-inverse,invisible-sphere,strays"
OFFSET = "shadow-touching,refract-plane,under-water,inside-glass,lecture-final,mirror-perfect,glass-sphere"


def variants() -> list[str]:
    return [variant for variant in VARIANTS if not variant.startswith("llvm") or llvm.find()]


@needs_mitsuba
@pytest.mark.parametrize("variant", variants())
def test_mitsuba_conforms_and_its_offsets_are_known(check: Check, variant: str) -> None:
    found = check(f"builtin:mitsuba/{variant}", "--scenes", f"{HANDFUL},{OFFSET}", "--no-block")
    words = {v.check.removeprefix("image/"): v.verdict for v in found.verdicts}
    assert {words[name] for name in HANDFUL.split(",")} == {"pass"}
    assert {words[name] for name in OFFSET.split(",")} == {"known"}
    assert found.conforms


@needs_mitsuba
@pytest.mark.parametrize("variant", variants())
def test_a_stock_mitsuba_shares_three_scenes_to_the_pixel(check: Check, variant: str) -> None:
    scenes = "background,physical-lights,mirror-chain,phong-10,glass-fresnel"
    found = check(f"builtin:mitsuba/{variant}/stock", "--scenes", scenes, "--no-block")
    assert [v.verdict for v in found.verdicts] == ["pass", "unsupported", "unsupported", "pass", "pass"]


@needs_povray
def test_povray_conforms_and_its_total_reflection_is_known(check: Check) -> None:
    found = check("builtin:povray", "--scenes", f"{HANDFUL},lecture-final,glass-fresnel,air-bubble", "--no-block")
    words = {v.check.removeprefix("image/"): v.verdict for v in found.verdicts}
    assert words.pop("air-bubble") == "known"
    assert set(words.values()) == {"pass"}


@needs_mitsuba
@pytest.mark.parametrize("variant", variants())
@pytest.mark.parametrize("name", ["lecture-final", "plane-both-sides", "pixel-corner", "inside-sphere"])
def test_what_mitsubas_eye_rays_meet_is_what_ours_meet(variant: str, name: str) -> None:
    scene = rung(name).scene().resized(64, 48)
    process = MitsubaProcess(variant)
    process.prepare()
    answer = process.ask("aov", scene)
    assert answer.values is not None, answer.message
    found = aov.agree(aov.met(scene, "numpy"), answer.values)
    assert (found.outside, found.misplaced) == (0, 0)
    assert found.doubtful < 0.05 * found.pixels
    shifted = np.roll(answer.values, 1, axis=1)
    assert aov.agree(aov.met(scene, "numpy"), shifted).outside > 0


@needs_mitsuba
@pytest.mark.parametrize("variant", variants())
def test_mitsubas_formulas_lie_inside_their_budgets(variant: str) -> None:
    process = MitsubaProcess(variant)
    process.prepare()
    for stratum in strata(seed=5, cases=50):
        found = errors(stratum, exactly(stratum), process.evaluate(stratum.formula, stratum.rows).astype(np.float64))
        assert found.outside == 0, (stratum.formula, stratum.name, found)


@needs_mitsuba
def test_one_process_serves_many_scenes() -> None:
    subject = MitsubaSubject("mitsuba")
    subject.prepare()
    scene = rung("background").scene().resized(4, 3)
    first, running = subject.render(scene, 0), subject.process.child._running
    second = subject.render(scene, 0)
    assert running is not None
    assert first.picture is not None
    assert second.picture is not None
    assert subject.process.child._running is running


@pytest.fixture
def dying(tmp_path: Path) -> Callable[[str], MitsubaSubject]:
    """A Mitsuba whose process runs these lines for each request."""

    def make(body: str) -> MitsubaSubject:
        lines = "".join(f"    {line}\n" for line in body.splitlines())
        (tmp_path / "dies.py").write_text(f"import os, sys, time\nfor request in sys.stdin:\n{lines}")
        subject = MitsubaSubject("mitsuba")
        subject.process.child = Child("dies", (), {"PYTHONPATH": str(tmp_path)})
        return subject

    return make


@pytest.mark.parametrize(
    ("body", "word", "message"),
    [
        ("print('LLVM ERROR: Cannot select', file=sys.stderr, flush=True)\nos.abort()", "crash", "SIGABRT: LLVM ERROR"),
        ("os.kill(os.getpid(), 11)", "crash", "SIGSEGV"),
        ("sys.exit(3)", "error", "status 3"),
        ("print('error RuntimeError: no such shape', flush=True)", "error", "no such shape"),
        ("print('done 1.0', flush=True)", "invalid", "no picture"),
        ("time.sleep(60)", "timeout", "no picture within"),
    ],
)
def test_a_death_inside_is_a_verdict_and_the_next_scene_is_asked_anew(
    dying: Callable[[str], MitsubaSubject], monkeypatch: pytest.MonkeyPatch, body: str, word: str, message: str
) -> None:
    monkeypatch.setattr("raycheck.subjects.mitsuba_process.TIMEOUT", 2.0 if word == "timeout" else 60.0)
    subject = dying(body)
    for _ in range(2):
        attempt = subject.render(rung("background").scene(), 0)
        assert attempt.picture is None
        assert attempt.word == word
        assert message in attempt.message


@pytest.mark.parametrize("spec", ["builtin:mitsuba/cuda_ad_rgb", "builtin:mitsuba/scalar_rgb/fast", "builtin:povray/4"])
def test_a_peer_that_is_not_there_is_misuse(spec: str) -> None:
    with pytest.raises(UsageError, match="no such"):
        attach(spec)


@needs_mitsuba
def test_the_arbitration_names_who_is_outside_and_why(raycheck: Callable[..., Told], tmp_path: Path) -> None:
    told = raycheck("peers", "--scenes", "background,inside-glass", "--size", "48x36", "--out", tmp_path)
    assert told.code == 0, told.err
    assert "inside-glass: Mitsuba 3 (scalar_rgb) is outside" in told.out
    assert "explained: secondary rays start off the surface" in told.out
    page = (tmp_path / "peers.html").read_text("utf-8")
    assert "<script" not in page
    assert "ours, numpy float32" in page
    data = (tmp_path / "peers.json").read_text("utf-8")
    assert '"scene": "inside-glass"' in data


def test_a_scene_is_printed_in_a_peers_words_or_refused(raycheck: Callable[..., Told]) -> None:
    told = raycheck("scenes", "mirror-chain", "--as", "mitsuba")
    assert told.code == 0
    assert ET.fromstring(told.out).tag == "scene"  # noqa: S314
    assert "sphere {" in raycheck("scenes", "glass-sphere", "--as", "povray").out
    refused = raycheck("scenes", "phong-10", "--as", "mitsuba")
    assert refused.code == 2
    assert "specular" in refused.err


SPECKLED = """
import random, struct, sys
scene, image, seed, spp = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
words = {line.split()[0]: line.split()[1:] for line in open(scene) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
draw = random.Random(seed)
with open(image, "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    for _ in range(width * height):
        for word in words["background"]:
            f.write(struct.pack("<f", (float(word) + BIAS) * draw.uniform(0.9, 1.1)))
"""


@pytest.mark.parametrize(("bias", "word"), [("0", "pass"), ("0.01", "fail")])
def test_a_stochastic_program_is_judged_by_its_mean(check: Check, tmp_path: Path, bias: str, word: str) -> None:
    folder = tmp_path / "speckled"
    folder.mkdir()
    (folder / "tracer.py").write_text(SPECKLED.replace("BIAS", bias))
    (folder / "raycheck.toml").write_text(
        '[tracer]\nname = "Speckled"\nstochastic = true\nspp = 8\n'
        'render = ["python3", "tracer.py", "{scene}", "{image}", "{seed}", "{spp}"]\n'
    )
    (verdict,) = check(folder, "--scenes", "background", "--size", "24x16").verdicts
    assert verdict.verdict == word
    assert verdict.sampled is not None
    assert (verdict.sampled.runs, verdict.sampled.spp) == (16, 8)
    assert 0 < verdict.sampled.smallest_bias < 0.01


def test_a_stochastic_program_must_take_a_seed(tmp_path: Path) -> None:
    (tmp_path / "raycheck.toml").write_text(
        '[tracer]\nname = "x"\nstochastic = true\nrender = ["./x", "{scene}", "{image}"]\n'
    )
    with pytest.raises(UsageError, match=r"lacks \{seed\}"):
        attach(str(tmp_path))


def test_a_failure_shows_how_wrong_it_looks_and_a_pass_does_not(check: Check) -> None:
    found = check("builtin:reference/numpy", "--scenes", "background", "--size", "8x6")
    assert found.verdicts[0].appearance is None
