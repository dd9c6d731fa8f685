"""raycheck check asks laws: which, when, and what a broken one leaves for the reader."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import jsonschema
import numpy as np
import pytest

import reports
from raycheck.errors import UsageError
from raycheck.laws import all_laws, chosen
from raycheck.laws.plan import HELLO
from reports import junit, page
from reports.results import Results

Attached = Callable[..., Path]
Check = Callable[..., Results]
SCHEMA = Path(reports.__file__).parent / "schema" / "results-1.json"

PROBE = """
import sys
def say(*numbers): print(*numbers, flush=True)
for line in sys.stdin:
    word, *rest = line.split()
    n = [float(x) for x in rest] if word != "scene" else []
    if word == "hello": say("raycheck 1 team float32 reflect normal")
    elif word == "reflect":
        i, m = n[:3], n[3:]
        d = sum(a * b for a, b in zip(i, m))
        say(*(FACTOR * d * b - a for a, b in zip(i, m)))
    elif word == "normal":
        p = [a - b for a, b in zip(n[:3], n[3:6])]
        size = sum(a * a for a in p) ** 0.5
        say(*(a / size for a in p))
    else: say("unsupported")
"""
BLACK = "write(image, width, height)"


def with_probe(attached: Attached, factor: str = "2", *lines: str) -> Path:
    """A tracer of black pictures whose reflection has this factor."""
    folder = attached(BLACK, f'probe = ["{sys.executable}", "-S", "probe.py"]', *lines)
    (folder / "probe.py").write_text(PROBE.replace("FACTOR", factor), "utf-8")
    return folder


def words(found: Results) -> dict[str, str]:
    return {v.check: v.verdict for v in found.verdicts}


def test_a_tracer_with_a_probe_is_asked_the_laws_of_its_operations(attached: Attached, check: Check) -> None:
    found = words(check(with_probe(attached), "--laws", "reflect,normal,refract"))
    assert found[HELLO] == "pass"
    for law in chosen(["reflect", "normal"]):
        assert found[f"law/{law.name}"] == "pass"
    for law in chosen(["refract"]):
        assert found[f"law/{law.name}"] == "unsupported"


def test_a_broken_law_shows_case_slide_and_a_line_that_runs(attached: Attached, check: Check, tmp_path: Path) -> None:
    found = check(with_probe(attached, "1.5"), "--laws", "reflect/normal-incidence")
    verdict = found.verdicts[-1]
    assert (verdict.verdict, verdict.slide) == ("fail", "Math of Reflection Vector")
    assert verdict.case is not None
    assert (verdict.case.expected, verdict.case.got) == (1.0, 0.5)
    done = subprocess.run(["sh", "-c", verdict.case.run], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1] == "0.0 0.0 0.5"
    assert verdict.reproduce.endswith("--laws reflect/normal-incidence")
    html = (tmp_path / "report" / page.FILE).read_text("utf-8")
    assert "Run this case" in html
    assert "reflect 0 0 1 0 0 1" in html
    assert "this case: printf" in (tmp_path / "report" / junit.FILE).read_text("utf-8")
    data = json.loads((tmp_path / "report" / "results.json").read_text("utf-8"))
    jsonschema.validate(data, json.loads(SCHEMA.read_text("utf-8")))
    assert data["planned"] == len(data["verdicts"]) == 2


def test_the_plainest_cases_are_the_same_in_every_run(attached: Attached, check: Check) -> None:
    folder = with_probe(attached, "1.9")
    first, second = (check(folder, "--laws", "reflect") for _ in range(2))
    assert [v.case for v in first.verdicts] == [v.case for v in second.verdicts]


def test_scenes_alone_ask_no_laws_and_laws_alone_no_scenes(attached: Attached, check: Check) -> None:
    folder = with_probe(attached)
    assert set(words(check(folder, "--scenes", "background"))) == {"image/background"}
    assert set(words(check(folder, "--laws", "normal/unit"))) == {HELLO, "law/normal/unit"}
    both = check(folder, "--scenes", "background", "--laws", "law/normal/unit")
    assert list(words(both)) == ["image/background", HELLO, "law/normal/unit"]


def test_without_a_probe_only_pictures_are_asked(attached: Attached, check: Check) -> None:
    found = words(check(attached(BLACK), "--size", "16x12"))
    assert HELLO not in found
    assert "law/image/object-order" in found
    assert not [name for name in found if name.startswith("law/sphere")]


def test_laws_asked_by_name_of_a_tracer_without_a_probe_are_unsupported(attached: Attached, check: Check) -> None:
    found = check(attached(BLACK), "--laws", "sphere/hit")
    assert words(found) == {"law/sphere/hit": "unsupported"}
    assert not found.conforms


def test_laws_of_pictures_are_blocked_where_no_picture_can_be_read(attached: Attached, check: Check) -> None:
    found = check(attached("sys.exit(1)"), "--size", "16x12")
    verdicts = [v for v in found.verdicts if v.check.startswith("law/image/")]
    assert {v.verdict for v in verdicts} == {"blocked"}
    assert {v.blocked_by for v in verdicts} == {"image/background"}


def test_a_probe_that_does_not_greet_blocks_the_laws_of_formulas(attached: Attached, check: Check) -> None:
    folder = with_probe(attached)
    (folder / "probe.py").write_text("import sys\nsys.exit('broken')\n", "utf-8")
    found = check(folder, "--laws", "reflect/angle,normal/unit")
    assert words(found) == {HELLO: "error", "law/reflect/angle": "blocked", "law/normal/unit": "blocked"}
    assert "broken" in found.verdicts[0].message


def test_a_crash_is_the_verdict_of_one_law_and_shows_its_question(attached: Attached, check: Check) -> None:
    folder = with_probe(attached)
    text = PROBE.replace("FACTOR", "2").replace(
        'elif word == "reflect":', 'elif word == "reflect":\n        import os; os.kill(os.getpid(), 6)'
    )
    (folder / "probe.py").write_text(text, "utf-8")
    found = check(folder, "--laws", "reflect/angle,normal/unit")
    assert words(found) == {HELLO: "pass", "law/normal/unit": "pass", "law/reflect/angle": "crash"}
    case = found.verdicts[-1].case or found.verdicts[1].case
    assert case is not None
    assert "reflect " in case.run


def test_a_law_can_be_a_known_failure(attached: Attached, check: Check, tmp_path: Path) -> None:
    known = tmp_path / "known.toml"
    known.write_text('[[known]]\ncheck = "law/reflect/unit"\nreason = "r"\nurl = "https://example.org"\n', "utf-8")
    found = check(with_probe(attached, "1.5"), "--laws", "reflect/unit,normal/unit", "--known", known)
    assert words(found)["law/reflect/unit"] == "known"
    assert found.conforms


def test_exploring_asks_more_cases(attached: Attached, check: Check) -> None:
    found = check(with_probe(attached), "--laws", "normal/unit,image/black", "--explore", "7")
    told = {v.check: v.message for v in found.verdicts}
    assert told["law/normal/unit"].startswith("20")
    assert int(told["law/normal/unit"].split()[0]) >= 2007


@pytest.mark.parametrize(
    ("words_", "told"),
    [
        (("--laws", "sphere/nearest-rot"), "for example sphere/nearest-root"),
        (("--laws", ""), "--laws is empty"),
        (("--explore", "-1"), "not a number of cases"),
    ],
)
def test_a_wrong_choice_of_laws_is_a_wrong_call(
    raycheck: Callable[..., object], attached: Attached, words_: tuple[str, ...], told: str
) -> None:
    done = raycheck("check", attached(BLACK), *words_)
    assert done.code == 2  # type: ignore[attr-defined]
    assert told in done.err  # type: ignore[attr-defined]


def test_laws_are_chosen_by_name_or_group_once_and_in_the_books_order() -> None:
    names = [law.name for law in chosen(["plane/meets", "plane", "law/plane/meets"])]
    assert names[0] == "plane/meets"
    assert len(names) == len(set(names)) == sum(law.name.startswith("plane/") for law in all_laws())
    with pytest.raises(UsageError):
        chosen(["nothing"])


def test_our_own_tracer_is_asked_all_laws_and_conforms(check: Check) -> None:
    found = check("builtin:reference/numpy/32", "--laws", ",".join(sorted({law.name for law in all_laws()})))
    assert set(words(found).values()) == {"pass"}
    assert len(found.verdicts) == len(all_laws()) + 1


OBJECT = """
import numpy as np
class Tracer:
    def render(self, path): return np.zeros((1, 1, 3))
    def reflect(self, i, n):
        assert i.dtype == np.float32
        return 2 * np.sum(i * n, axis=1, keepdims=True) * n - i
    def phong(self, i, n, v, s):
        raise ValueError("no")
    def normal(self, p, c, r): return np.zeros(3)
tracer = Tracer()
"""


def test_a_python_object_answers_batches_of_arrays(
    check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "team_of_arrays.py").write_text(OBJECT, "utf-8")
    monkeypatch.chdir(tmp_path)
    found = check("python:team_of_arrays:tracer", "--laws", "reflect,phong/peak,normal/unit,sphere/hit")
    told = words(found)
    assert all(told[f"law/{law.name}"] == "pass" for law in chosen(["reflect"]))
    assert told["law/phong/peak"] == "error"
    assert told["law/normal/unit"] == "invalid"
    assert told["law/sphere/hit"] == "unsupported"
    assert np.zeros(1).dtype == np.float64


def test_the_line_of_a_python_object_runs(check: Check, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "team_wrong.py").write_text(OBJECT.replace("2 * np", "1.5 * np"), "utf-8")
    monkeypatch.chdir(tmp_path)
    (verdict,) = [v for v in check("python:team_wrong:tracer", "--laws", "reflect/unit").verdicts if v.case]
    assert verdict.case is not None
    line = verdict.case.run.replace("python -c", f"{sys.executable} -c")
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=True)
    assert "[" in done.stdout


def test_the_line_of_our_own_tracer_runs(tmp_path: Path) -> None:
    from oracles.laws.cases import Question
    from raycheck.probes.inprocess import ReferenceProber

    line = ReferenceProber("numpy", 32).line((Question("reflect", (0.0, 0.0, 1.0, 0.0, 0.0, 1.0)),), tmp_path)
    done = subprocess.run(
        ["sh", "-c", line.replace("python -c", f"{sys.executable} -c")], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[[0. 0. 1.]]"
