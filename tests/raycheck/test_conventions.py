"""A C++ tracer of another dialect under `raycheck check`: told so in one line, and judged under it."""

from __future__ import annotations

import importlib.util
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from oracles.verdict import Verdict
from raycheck.cli import main
from raycheck.errors import CONFORMS, DIFFERS, MISUSE
from reports import results

SPEC = importlib.util.spec_from_file_location(
    "cpp_variants", Path(__file__).parents[2] / "examples" / "cpp_variants.py"
)
assert SPEC
assert SPEC.loader
variants: Any = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(variants)

SCENES = (
    "headlight-plane,headlight-sphere,point-light,two-lights,phong-10,phong-100,phong-terminator,glass-sphere,"
    "refract-plane,under-water,lecture-final"
)
Checked = Callable[..., tuple[int, tuple[Verdict, ...]]]

pytestmark = pytest.mark.skipif(shutil.which("g++") is None, reason="needs g++")


@pytest.fixture
def checked(tmp_path: Path) -> Checked:
    def run(edits: Any, dialect: tuple[str, ...] = ()) -> tuple[int, tuple[Verdict, ...]]:
        folder = variants.write(tmp_path / "tracer", edits, dialect)
        out = tmp_path / "report"
        words = ["check", str(folder), "--scenes", SCENES, "--size", "64x48", "--out", str(out), "--no-block"]
        code = main(words)
        return code, results.read(out).verdicts

    return run


def failing(verdicts: tuple[Verdict, ...]) -> list[str]:
    return [v.check for v in verdicts if v.verdict != "pass"]


def test_every_variant_fits_the_example() -> None:
    for table in (variants.DIALECTS, variants.SLIPS, variants.FAULTS):
        for edits in table.values():
            assert variants.source(edits) != variants.source(())


def test_a_dialect_is_named_with_its_line_and_the_rest_passes(checked: Checked) -> None:
    code, verdicts = checked(variants.DIALECTS['specular = "blinn"'])
    assert code == DIFFERS
    assert failing(verdicts) == ["convention/dialect"]
    assert 'say so under [tracer.dialect]: specular = "blinn"' in verdicts[0].message


def test_with_that_line_the_tracer_conforms(checked: Checked) -> None:
    code, verdicts = checked(variants.DIALECTS['specular = "blinn"'], ('specular = "blinn"',))
    assert (code, failing(verdicts)) == (CONFORMS, [])


def test_a_dialect_that_is_declared_and_not_followed_is_taken_back(checked: Checked) -> None:
    code, verdicts = checked((), ('specular = "blinn"',))
    assert (code, failing(verdicts)) == (DIFFERS, ["convention/dialect"])
    assert "no line specular" in verdicts[0].message


def test_an_upside_down_picture_is_one_failure(checked: Checked) -> None:
    code, verdicts = checked(variants.SLIPS["upside down"])
    assert (code, failing(verdicts)) == (DIFFERS, ["convention/picture"])
    assert "upside down" in verdicts[0].message


def test_a_fault_on_top_of_a_dialect_is_still_found(checked: Checked) -> None:
    fault = variants.FAULTS["ratio not inverted on leaving"]
    _, alone = checked(fault)
    _, both = checked((*variants.DIALECTS['specular = "blinn"'], *fault))
    assert failing(alone)
    assert failing(both) == ["convention/dialect", *failing(alone)]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ('specular = "toon"', "dialect.specular = 'toon'"),
        ("colour = 1", "unknown key tracer.dialect.colour; known are sample, specular"),
        ("specular_in_shadow = 1", "dialect.specular_in_shadow = 1"),
    ],
)
def test_a_dialect_that_does_not_exist_is_refused(
    line: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = variants.write(tmp_path / "tracer", (), (line,))
    assert main(["check", str(folder), "--out", str(tmp_path / "report")]) == MISUSE
    assert said in capsys.readouterr().err
