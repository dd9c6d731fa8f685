"""No tolerance of a test comes from a library's default or out of the air."""

import ast
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
NAMES = {"approx": {"abs"}, "allclose": {"rtol", "atol"}, "assert_allclose": {"rtol", "atol"}, "isclose": {"atol"}}
"""What a call has to say: left out, approx takes 1e-6 of the value and never less than 1e-12, also beside a `rel`."""
LEAST = 1e-3
"""No smaller number is written out: a tolerance is made of roundoffs, digits or steps, which say where it is from."""


def calls(tree):
    """Every call that compares with a tolerance."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "attr", getattr(node.func, "id", ""))
            if name in NAMES:
                yield node, NAMES[name]


def objections(text):
    """(line, words) of every tolerance that nobody derived."""
    for call, names in calls(ast.parse(text)):
        said = {word.arg: word.value for word in call.keywords}
        for missing in sorted(names - set(said)):
            yield call.lineno, f"names no {missing}"
        for name, value in said.items():
            small = [n.value for n in ast.walk(value) if isinstance(n, ast.Constant) and isinstance(n.value, float)]
            if any(0.0 < number < LEAST for number in small):
                yield call.lineno, f"{name} is written out as a number"


@pytest.mark.parametrize("path", sorted(TESTS.rglob("*.py")), ids=lambda path: str(path.relative_to(TESTS)))
def test_every_tolerance_is_derived(path):
    assert list(objections(path.read_text("utf-8"))) == []


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x == pytest.approx(1.0)", "names no abs"),
        ("x == approx(1.0, rel=2 * U)", "names no abs"),
        ("x == approx(1.0, abs=1e-6)", "abs is written out as a number"),
        ("np.testing.assert_allclose(a, b, atol=1e-12 * c, rtol=0.0)", "atol is written out as a number"),
        ("np.allclose(a, b, atol=0.0)", "names no rtol"),
    ],
)
def test_a_bare_tolerance_is_found(text, words):
    assert [said for _, said in objections(text)] == [words]


def test_roundoffs_and_digits_are_no_objection():
    assert list(objections("x == approx(1.0, abs=4 * 2.0**-53)\ny == approx(1.0158, abs=0.5 * 10.0**-4)")) == []
