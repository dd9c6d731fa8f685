"""The house rules that a reader of docs/architecture.md relies on."""

from __future__ import annotations

import ast
import re
import statistics
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("scenes", "reference_tracer", "oracles", "reports", "raycheck")
"""From the cellar to the roof: a room imports from those before it."""
SOURCES = sorted(path for room in ROOMS for path in (ROOT / room).rglob("*.py"))
TRACER = ROOT / "reference_tracer"
FORMULAS = [
    *sorted((TRACER / "formulas").glob("*.py")),
    TRACER / "methods" / "spheres.py",
    TRACER / "methods" / "refractions.py",
]


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


def imports(path: Path) -> Iterator[str]:
    """Full names of the modules that a file imports, anywhere in it; of `from a import b` also a.b."""
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name_of(path)}:{node.lineno}: relative import"
            assert node.module is not None
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def test_the_rooms_are_there() -> None:
    for room in ROOMS:
        assert any(path.is_relative_to(ROOT / room) for path in SOURCES)
    assert len(FORMULAS) > 4


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_imports_point_down_only(path: Path) -> None:
    level = ROOMS.index(path.relative_to(ROOT).parts[0])
    above = {module for module in imports(path) if module.split(".")[0] in ROOMS[level + 1 :]}
    assert above == set()


@pytest.mark.parametrize("path", [p for p in SOURCES if p.is_relative_to(ROOT / "reports")], ids=name_of)
def test_reports_judge_nothing_they_know_only_verdicts(path: Path) -> None:
    lower = [m for m in imports(path) if m.split(".")[0] in ("oracles", "reference_tracer", "scenes")]
    # scenes.disk reads and writes files; it knows nothing of scenes
    # nor of measurements anything but their form
    assert [m for m in lower if not m.startswith(("oracles.verdict", "oracles.measurement", "scenes.disk"))] == []


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_the_package_imports_no_tests_tools_or_examples(path: Path) -> None:
    assert {m.split(".")[0] for m in imports(path)} & {"tests", "tools", "examples", "benchmarks"} == set()


@pytest.mark.parametrize("path", SOURCES, ids=name_of)
def test_a_dynamic_import_stays_in_its_own_room(path: Path) -> None:
    """`import_module` with a name that the user gives is the in-process subject's alone."""
    room = path.relative_to(ROOT).parts[0]
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            given = ast.unparse(node.args[0])
            assert given.startswith((f"'{room}.", f"f'{room}.")) or path.name == "inprocess.py"


BANNED_CALLS = ("min", "max", "abs", "sum", "pow")


def breaches(tree: ast.AST) -> Iterator[str]:
    """What a formula on a generic number must not do: branch, `**`, divide by a literal, call a float's builtin."""
    for node in ast.walk(tree):
        line = getattr(node, "lineno", 0)
        if isinstance(node, (ast.If, ast.IfExp, ast.While, ast.Match, ast.BoolOp)):
            yield f"{line}: branch"
        elif isinstance(node, (ast.BinOp, ast.AugAssign)) and isinstance(node.op, ast.Pow):
            yield f"{line}: **"
        elif isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Div, ast.FloorDiv)):
            if isinstance(node.right, ast.Constant):
                yield f"{line}: division by a literal"
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in BANNED_CALLS:
            yield f"{line}: {node.func.id}()"
        elif isinstance(node, ast.Compare) and any(isinstance(op, (ast.Is, ast.In)) for op in node.ops):
            yield f"{line}: branch on identity"


@pytest.mark.parametrize("path", [p for p in FORMULAS if p.name != "display.py"], ids=name_of)
def test_formulas_run_on_every_number_type(path: Path) -> None:
    assert list(breaches(ast.parse(path.read_text("utf-8")))) == []


@pytest.mark.parametrize(
    "text", ["if a: pass", "a if b else c", "a ** 2", "a / 2.0", "max(a, b)", "a and b", "a **= 2"]
)
def test_the_rule_for_formulas_sees_a_breach(text: str) -> None:
    assert list(breaches(ast.parse(text)))


@pytest.mark.parametrize("path", [p for p in FORMULAS if p.name != "__init__.py"], ids=name_of)
def test_every_formula_says_where_it_is_from(path: Path) -> None:
    for node in ast.parse(path.read_text("utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            assert ast.get_docstring(node), f"{node.name} has no docstring"


def test_no_file_is_long_and_most_are_short() -> None:
    lines = {name_of(path): len(path.read_text("utf-8").splitlines()) for path in SOURCES}
    assert {name: n for name, n in lines.items() if n > 500} == {}
    assert statistics.median(lines.values()) < 250


@pytest.mark.parametrize("room", ROOMS)
def test_every_package_says_that_it_is_typed(room: str) -> None:
    assert (ROOT / room / "py.typed").is_file()


PIN = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]*==[A-Za-z0-9.!+_-]+( ; [a-z_]+ (==|!=|<|<=|>|>=) '[^']*'( (and|or) .*)?)?")


def test_constraints_are_names_and_versions_only() -> None:
    lines = (ROOT / "constraints.txt").read_text("utf-8").splitlines()
    assert lines
    assert [line for line in lines if not PIN.fullmatch(line)] == []


@pytest.mark.parametrize("line", ["a @ https://x", "--index-url x", "a>=1", "-e .", "a==1 --hash=sha256:0", "# via b"])
def test_the_rule_for_constraints_sees_a_breach(line: str) -> None:
    assert not PIN.fullmatch(line)


def tracked() -> list[Path]:
    """Files under version control; those of the tree where there is no git."""
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        return [path for path in ROOT.iterdir() if path.is_file()]
    return [ROOT / name for name in done.stdout.split("\0") if name and (ROOT / name).is_file()]


BUILD = re.compile(
    r"(^|/)(pyproject\.toml|constraints\.txt|Makefile|.*requirements.*\.txt|system-packages|\.ci/.+|.*\.cfg|.*\.lock)$"
)
FOREIGN = re.compile(r"https?://|git\+|file:|(?<![\w.*/$)}-])/(home|work|root|tmp|Users|opt|mnt)/")


def test_build_files_name_no_address_and_no_path_of_a_machine() -> None:
    files = [path for path in tracked() if BUILD.search(path.relative_to(ROOT).as_posix())]
    names = {path.name for path in files}
    assert {"pyproject.toml", "constraints.txt", "Makefile"} <= names
    found = [
        f"{name_of(path)}: {line}"
        for path in files
        for line in path.read_text("utf-8").splitlines()
        if FOREIGN.search(line)
    ]
    assert found == []


@pytest.mark.parametrize("line", ["x = https://a.b/", "PATH=/home/me/bin", "pip install git+ssh", "a @ file:///x"])
def test_the_rule_for_build_files_sees_a_breach(line: str) -> None:
    assert FOREIGN.search(line)
