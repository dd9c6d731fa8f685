"""The lecture's tracer in other languages conforms, and its skeleton begins at the first rung."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from raycheck.cli import main
from raycheck.skeleton import LANGUAGES, blanked
from reports import results
from reports.results import Results
from scenes.catalogue import ladder
from scenes.generator import generate

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TOOLS = {"cpp": "make", "python": "python3", "rust": "rustc", "go": "go", "java": "javac", "javascript": "node"}

needs_its_tool = pytest.mark.parametrize(
    "language",
    [
        pytest.param(
            language, marks=pytest.mark.skipif(not shutil.which(tool), reason=f"{tool} is needed to build this example")
        )
        for language, tool in TOOLS.items()
    ],
)


def checked(folder: Path, out: Path, *words: str) -> Results:
    main(["check", str(folder), "--size", "40x30", "--out", str(out), *words])
    return results.read(out)


@pytest.fixture
def example(tmp_path: Path) -> Callable[[str], Path]:
    def copy(language: str) -> Path:
        ignore = shutil.ignore_patterns("tracer", "*.class", "__pycache__")
        return Path(shutil.copytree(EXAMPLES / f"{language}_lecture", tmp_path / language, ignore=ignore))

    return copy


@needs_its_tool
def test_an_example_passes_every_rung_of_the_ladder(
    example: Callable[[str], Path], tmp_path: Path, language: str
) -> None:
    found = checked(example(language), tmp_path / "out")
    assert {v.check: v.message for v in found.verdicts if v.verdict != "pass"} == {}
    assert sum(v.check.startswith("image/") for v in found.verdicts) == len(ladder())


@needs_its_tool
def test_a_skeleton_builds_runs_and_fails_from_the_second_rung_on(tmp_path: Path, language: str) -> None:
    assert main(["init", language, str(tmp_path / "mine")]) == 0
    found = checked(tmp_path / "mine", tmp_path / "out")
    words = {v.check: v.verdict for v in found.verdicts if v.check.startswith("image/")}
    assert words["image/background"] == "pass"
    assert words["image/headlight-plane"] == words["image/headlight-sphere"] == "fail"
    assert set(list(words.values())[3:]) == {"blocked"}
    assert found.subject.name == "My tracer"


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_skeleton_leaves_no_formula_and_no_mark(tmp_path: Path, language: str) -> None:
    main(["init", language, str(tmp_path / "mine")])
    (source,) = (p for p in (tmp_path / "mine").iterdir() if p.stem.lower() == "tracer")
    text = source.read_text("utf-8")
    example = (EXAMPLES / f"{language}_lecture" / source.name).read_text("utf-8")
    assert example.count("[open]") == example.count("[close]") == text.count("YOURS: ") >= 10
    assert "[open]" not in text
    assert "[close]" not in text
    for formula in ("sin2", "root =", "n1 * c1", "n1*c1"):
        assert formula not in text


def test_what_stands_in_a_marked_place_takes_its_indentation() -> None:
    text = "a\n    # [open] the sum: return 0\n    x = 1\n    return x\n    # [close]\nb\n"
    assert blanked(text) == "a\n    # YOURS: the sum\n    return 0\nb\n"


def test_init_overwrites_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "tracer.py").write_text("mine", "utf-8")
    assert main(["init", "python", str(tmp_path)]) == 2
    assert "not an empty folder" in capsys.readouterr().err
    assert (tmp_path / "tracer.py").read_text("utf-8") == "mine"


@pytest.mark.skipif(not (shutil.which("g++") and shutil.which("make")), reason="g++ and make are needed")
def test_a_float32_tracer_passes_drawn_scenes(example: Callable[[str], Path], tmp_path: Path) -> None:
    """benchmarks/grading.py asks 200 of them."""
    from oracles.compare import compare
    from oracles.images import read
    from oracles.truth import truth
    from scenes.text import to_text

    folder = example("cpp")
    subprocess.run(["make", "-s"], cwd=folder, check=True)
    for seed in range(1000, 1020):
        scene = generate(seed)
        (tmp_path / "scene.txt").write_text(to_text(scene), "utf-8")
        subprocess.run([folder / "tracer", tmp_path / "scene.txt", tmp_path / "image.pfm"], check=True)
        found = compare(read(tmp_path / "image.pfm", scene.image.width, scene.image.height), truth(scene, "float32"))
        assert found.word == "pass", f"seed {seed}: {found.message}"
