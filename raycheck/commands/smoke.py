"""raycheck smoke: one small scene, with a transcript of everything sent and received."""

from __future__ import annotations

from argparse import Namespace

from oracles.compare import compare
from oracles.truth import truth
from raycheck.commands.options import subject_of
from raycheck.errors import CONFORMS, DIFFERS
from raycheck.subjects import Attempt, Subject
from reference_tracer.dialects import rules
from scenes.catalogue import rung
from scenes.json_form import to_json
from scenes.model import Scene
from scenes.text import to_text

SCENE = "pixel-centre"


def run(options: Namespace) -> int:
    """Show what goes out, what comes back, and what that means."""
    subject = subject_of(options)
    scene = rung(SCENE).scene()
    print(f"# tracer: {subject.name} (computes in {subject.precision})")
    subject.prepare()
    if subject.scene_form in ("text", "json"):
        print(f"# the scene file it gets ({subject.scene_form}):")
        print(to_text(scene) if subject.scene_form == "text" else to_json(scene), end="")
    attempt = subject.render(scene, 0)
    _process(attempt)
    if attempt.picture is None:
        print(f"# verdict: {attempt.word}: {attempt.message}")
        return DIFFERS
    return _picture(subject, scene, attempt)


def _process(attempt: Attempt) -> None:
    process = attempt.process
    if process is None:
        return
    print(f"# the command: {' '.join(process.command)}")
    print(f"# it ended: {process.status}, after {process.seconds:.3f} s")
    print(f"# it printed: {process.output_tail or 'nothing'}")


def _picture(subject: Subject, scene: Scene, attempt: Attempt) -> int:
    picture = attempt.picture
    assert picture is not None
    height, width, _ = picture.values.shape
    unit = "linear values" if picture.maximum is None else f"codes of 0..{picture.maximum}"
    print(f"# the image: {width}x{height}, {unit}; expected and got at three pixels:")
    expected = truth(scene, subject.precision, rules=rules(subject.dialect))
    comparison = compare(picture, expected)
    for i, j in ((0, 0), (width // 2, height // 2), (width - 1, height - 1)):
        got = " ".join(f"{value:.9g}" for value in picture.values[j, i])
        want = " ".join(f"{value:.9g}" for value in expected.pixels[j, i])
        print(f"  pixel ({i}, {j}): expected (linear) {want}, got {got}")
    print(f"# verdict: {comparison.word}: {comparison.message}")
    return CONFORMS if comparison.word == "pass" else DIFFERS
