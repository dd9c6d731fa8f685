"""Points for laws and for how far formulas hold: earned by what a probe in the jail answers."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from oracles.stability import laws
from oracles.stability.frontiers import GOOD
from raycheck.examples import examples
from raycheck.grading.formulas import foreign_laws
from raycheck.grading.one import Asked, grade
from raycheck.grading.rubric import Rubric
from raycheck.grading.submissions import found
from raycheck.laws import chosen
from raycheck.manifest import load
from raycheck.sandbox import Jail
from raycheck.sandbox.jail import missing
from raycheck.subjects.command import CommandSubject
from reports import results
from reports.grades import Record

needs_a_sandbox = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")

TRACER = """
import struct, sys
if "--probe" in sys.argv:
    for line in sys.stdin:
        words = line.split()
        numbers = [float(w) for w in words[1:]] if words[0] != "hello" else []
        if words[0] == "hello": print("raycheck 1 python float64 reflect", flush=True)
        elif words[0] == "reflect":
            i, n = numbers[:3], numbers[3:]
            d = sum(a * b for a, b in zip(i, n))
            print(*["%.17g" % x for x in REFLECTED], flush=True)
        else: print("unsupported", flush=True)
    sys.exit()
words = {line.split()[0]: line.split()[1:] for line in open(sys.argv[1]) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
with open(sys.argv[2], "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *[float(w) for w in words["background"]]) * (width * height))
"""
RIGHT = "[2 * d * b - a for a, b in zip(i, n)]"
SLIDE = "[2 * b - a for a, b in zip(i, n)]"
LAWS = {"name": "laws", "points": 8, "laws": ["reflect"]}


@pytest.fixture
def scored(tmp_path: Path) -> Callable[..., Record]:
    """Grade a tracer whose probe reflects so; probe: does its manifest tell of it."""

    def run(group: dict[str, Any], reflected: str = RIGHT, probe: bool = True, more: str = "") -> Record:
        folder = tmp_path / "class" / "alice"
        folder.mkdir(parents=True)
        (folder / "tracer.py").write_text(TRACER.replace("REFLECTED", reflected), "utf-8")
        probing = 'probe = ["python3", "-S", "tracer.py", "--probe"]\n' if probe else ""
        (folder / "raycheck.toml").write_text(
            '[tracer]\nname = "x"\nprecision = "float64"\n'
            f'render = ["python3", "-S", "tracer.py", "{{scene}}", "{{image}}"]\n{probing}{more}',
            "utf-8",
        )
        return graded(tmp_path, group)

    return run


def graded(place: Path, group: dict[str, Any]) -> Record:
    first = {"name": "first", "points": 2, "rungs": ["background"]}
    rubric = Rubric.model_validate({"name": "r", "group": [first, group]})
    for name in ("records", "students"):
        (place / "out" / name).mkdir(parents=True)
    return grade(Asked(rubric, 3, place / "out", Jail(rubric.limits)), found(place / "class")[0])


@needs_a_sandbox
def test_a_right_formula_earns_its_laws(scored: Callable[..., Record], tmp_path: Path) -> None:
    record = scored(LAWS)
    assert [group.earned for group in record.groups] == [2.0, 8.0], record.groups[1]
    checks = [verdict.check for verdict in results.read(tmp_path / "out" / "students" / "alice").verdicts]
    assert checks[:2] == ["image/background", "probe/hello"]


@needs_a_sandbox
def test_the_slides_other_formula_loses_those_that_it_breaks(scored: Callable[..., Record], tmp_path: Path) -> None:
    # 2n - i: another angle, length, and answer for -n; but 2n - (2n - i) = i, (2n - i + i) × n = 0, and i = n is right
    record = scored(LAWS, SLIDE)
    lines = {line.check.removeprefix("law/reflect/"): line for line in record.groups[1].lines}
    lost = {name for name, line in lines.items() if line.counts == "lost"}
    assert lost == {"angle", "unit", "either-normal"}
    assert set(lines) - lost == {"coplanar", "tangential", "involution", "normal-incidence", "rotate"}
    assert record.groups[1].earned == 5.0
    told = (tmp_path / "out" / "students" / "alice" / "results.json").read_text("utf-8")
    assert str(tmp_path) not in told


@needs_a_sandbox
def test_without_a_probe_laws_are_lost(scored: Callable[..., Record]) -> None:
    record = scored(LAWS, probe=False)
    assert (record.earned, record.points) == (2.0, 10.0)
    assert {(line.verdict, line.counts) for line in record.groups[1].lines} == {("unsupported", "lost")}


@needs_a_sandbox
def test_without_a_probe_laws_are_left_out_where_the_rubric_says_so(scored: Callable[..., Record]) -> None:
    record = scored(LAWS | {"unsupported": "left out"}, probe=False)
    assert (record.earned, record.points) == (2.0, 2.0)
    assert record.groups[1].sum_in_words == "left out: not asked of this tracer"


@needs_a_sandbox
def test_a_probe_that_does_not_greet_earns_nothing(scored: Callable[..., Record]) -> None:
    record = scored(LAWS | {"unsupported": "left out"}, more='probe = ["false"]\n', probe=False)
    assert (record.groups[1].earned, record.points) == (0.0, 10.0)
    assert {line.counts for line in record.groups[1].lines} == {"excused"}
    assert "builds on probe/hello" in record.groups[1].lines[0].why


def test_a_law_of_another_convention_is_not_charged() -> None:
    folder = examples() / "cpp_lecture"
    plain = load(folder)
    blinn = plain.model_copy(update={"dialect": plain.dialect.model_copy(update={"specular": "blinn"})})
    asked = chosen(["phong", "reflect"])
    assert foreign_laws(CommandSubject(folder, plain, ""), asked) == {}
    foreign = foreign_laws(CommandSubject(folder, blinn, ""), asked)
    assert set(foreign) == {f"law/{law.name}" for law in asked if law.name.startswith("phong/")}


def stability(question: str, float32: float) -> dict[str, Any]:
    asked = {"question": question, "float32": float32, "float64": float32}
    return {"name": "far", "points": 4, "stability": [asked]}


@needs_a_sandbox
@pytest.mark.skipif(not shutil.which("make"), reason="make is needed to build the example")
@pytest.mark.parametrize(("question", "method"), [("distance", "lecture"), ("bending", "division-free")])
def test_a_formula_holds_as_far_as_its_error_law_says(tmp_path: Path, question: str, method: str) -> None:
    # The law bounds the error, so nothing fails before; it is met within a factor of 7 (docs/stability.md)
    shutil.copytree(examples() / "cpp_lecture", tmp_path / "class" / "alice", ignore=shutil.ignore_patterns("tracer"))
    predicted = laws.predicted(question, method, "float32", GOOD)
    assert predicted is not None
    harder = 1.0 if question == "distance" else -1.0
    near, far = stability(question, predicted * 0.9**harder), stability(question, predicted * 8.0**harder)
    both = near | {"stability": near["stability"] + far["stability"]}
    record = graded(tmp_path, both)
    assert [line.verdict for line in record.groups[1].lines] == ["pass", "fail"], record.groups[1]
    assert record.groups[1].earned == 2.0


@needs_a_sandbox
def test_what_a_probe_does_not_answer_is_not_held(scored: Callable[..., Record]) -> None:
    record = scored(stability("distance", 10.0))
    (line,) = record.groups[1].lines
    assert (line.verdict, line.counts, "does not answer sphere" in line.why) == ("unsupported", "lost", True)


def test_a_reach_that_no_scan_asks_about_is_refused() -> None:
    for far in (1.0, 1e9):
        with pytest.raises(ValueError, match=r"is not measured: 1\.5 to 8\.39e"):
            Rubric.model_validate({"name": "r", "group": [stability("distance", far)]})
