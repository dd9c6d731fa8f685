"""pytest --raycheck-subject: every check is a test, chosen and told as any other."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

ROOT = Path(__file__).resolve().parents[2]
TRACER = """
import numpy as np, json
class Tracer:
    def render(self, path):
        scene = json.load(open(path))
        pixels = np.zeros((scene["image"]["height"], scene["image"]["width"], 3))
        pixels[:] = scene["background"]
        return pixels
    def reflect(self, i, n): return FACTOR * np.sum(i * n, axis=1, keepdims=True) * n - i
tracer = Tracer()
"""
SUBJECT = ("--raycheck-subject", "python:team_seven:tracer", "--raycheck-size", "8x6", "-p", "no:cacheprovider")


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch):
    """pytest with the plugin, in a process of its own, on a tracer whose reflection has this factor."""
    monkeypatch.setenv("PYTHONPATH", f"{ROOT}:{pytester.path}")

    def call(*words: str, factor: str = "2") -> pytest.RunResult:
        pytester.path.joinpath("team_seven.py").write_text(TRACER.replace("FACTOR", factor), "utf-8")
        return pytester.runpytest_subprocess("-p", "raycheck.pytest_plugin", *SUBJECT, *words)

    return call


def test_every_check_and_law_is_an_item_with_an_id(run) -> None:
    told = run("--collect-only", "-q").stdout.str()
    for name in ("image/background", "image/lecture-final", "probe/hello", "law/reflect/angle", "law/image/crop"):
        assert f"raycheck::{name}" in told


def test_checks_are_chosen_with_k_and_fail_with_the_line_that_runs_them(run) -> None:
    done = run("-k", "reflect/unit or (image and background and not adds)", factor="1.5")
    done.assert_outcomes(passed=1, failed=1)
    done.stdout.fnmatch_lines(
        [
            "*law/reflect/unit*",
            "fail: |r|: expected 1 *",
            "this case: python -c*",
            "run again: raycheck check python:team_seven:tracer --laws reflect/unit",
        ]
    )
    assert "Traceback" not in done.stdout.str()


def test_what_cannot_tell_is_skipped_with_its_reason(run) -> None:
    done = run("-k", "sphere/hit", "-rs")
    done.assert_outcomes(skipped=1)
    done.stdout.fnmatch_lines(["*unsupported: the tracer does not answer sphere*"])


def test_x_stops_at_the_first_failure(run) -> None:
    run("-x", "--raycheck-laws", "reflect", factor="1").assert_outcomes(failed=1, passed=1)


def test_junit_has_a_case_for_each_check(run, pytester: pytest.Pytester) -> None:
    run("--raycheck-laws", "reflect/unit,reflect/angle", "--junitxml=junit.xml", factor="1")
    text = pytester.path.joinpath("junit.xml").read_text("utf-8")
    assert text.count("<testcase") == 3
    assert "run again: raycheck check" in text


def test_checks_are_shared_out_by_xdist(run) -> None:
    run("-n", "2", "--raycheck-laws", "reflect").assert_outcomes(passed=9)


def test_other_tests_run_beside_the_checks(run, pytester: pytest.Pytester) -> None:
    pytester.makepyfile("def test_own(): pass")
    run("--raycheck-laws", "reflect/unit").assert_outcomes(passed=3)


def test_a_known_failure_is_expected(run, pytester: pytest.Pytester) -> None:
    entry = '[[known]]\ncheck = "law/reflect/unit"\nreason = "factor"\nurl = "https://example.org"\n'
    pytester.path.joinpath("known.toml").write_text(entry, "utf-8")
    done = run("--raycheck-laws", "reflect/unit", "--raycheck-known", "known.toml", factor="1")
    done.assert_outcomes(passed=1, xfailed=1)


@pytest.mark.parametrize(
    ("words", "told"), [(("--raycheck-laws", "no/law"), "no such law"), (("--raycheck-scenes", "no"), "no such scene")]
)
def test_a_wrong_option_is_a_wrong_call(run, words: tuple[str, ...], told: str) -> None:
    done = run(*words)
    assert done.ret == pytest.ExitCode.USAGE_ERROR
    assert told in done.stderr.str()


def test_a_plain_run_has_no_checks_and_imports_nothing() -> None:
    code = (
        "import sys, pytest; before = set(sys.modules); import raycheck.pytest_plugin; "
        "print({m.split('.')[0] for m in set(sys.modules) - before})"
    )
    words = [sys.executable, "-P", "-c", code]
    done = subprocess.run(words, capture_output=True, text=True, check=True, env={"PYTHONPATH": str(ROOT)})
    assert done.stdout.strip() == "{'raycheck'}"


def test_the_entry_point_names_the_module() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["entry-points"]["pytest11"] == {"raycheck.pytest_plugin": "raycheck.pytest_plugin"}
