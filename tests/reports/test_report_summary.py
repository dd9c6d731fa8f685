"""The summary and the sentence in which a run concludes; numbers as people read them."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from oracles.verdict import Pixel, Verdict, Word
from reports import conclusion, format, summary
from reports.results import Results

Make = Callable[..., Verdict]
Run = Callable[..., Results]


def test_a_run_is_summed_up_in_a_line_for_each_verdict_its_counts_and_its_conclusion(run: Run, make: Make) -> None:
    verdicts = (
        make("pass", check="background"),
        make("undecided", check="strays", message="all doubtful\nat float32"),
        make("blocked", check="phong-100", message="", blocked_by="phong-10"),
        make("fail", check="phong-10", message="31 pixels outside"),
    )
    assert summary.lines(run(*verdicts)) == [
        "fail       phong-10   31 pixels outside",
        "blocked    phong-100  blocked by phong-10",
        "undecided  strays     all doubtful at float32",
        "1 fail, 1 blocked, 1 undecided, 1 pass",
        "Team 7 does not conform: 1 of 4 checks fails, 1 is blocked by them",
    ]


def test_a_clean_run_is_summed_up_in_two_lines(run: Run, make: Make) -> None:
    assert summary.lines(run(make("pass"), make("pass"))) == ["2 pass", "Team 7 conforms: all 2 checks pass"]


def test_a_run_without_verdicts_concludes_nothing_good(run: Run) -> None:
    assert summary.lines(run()) == ["0 checks", "Team 7 does not conform: nothing was checked"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["pass"], "conforms: 1 of 1 check passes"),
        (["pass", "pass", "known"], "conforms: 2 of 3 checks pass, 1 fails as known"),
        (["pass", "unsupported", "undecided"], "conforms: 1 of 3 checks passes, 1 is undecided, 1 is unsupported"),
        (["known"], "does not conform: 0 of 1 check pass, 1 fails as known"),
        (["unsupported", "unsupported"], "does not conform: 0 of 2 checks pass, 2 are unsupported"),
        (["pass", "crash", "timeout", "error", "invalid"], "does not conform: 4 of 5 checks fail"),
        (["pass", "fixed"], "does not conform: 1 of 2 checks passes although listed as known"),
        (["pass", "fixed", "fixed"], "does not conform: 2 of 3 checks pass although listed as known"),
        (["fixed", "fixed"], "does not conform: 2 of 2 checks pass although listed as known"),
        (["pass", "blocked"], "does not conform: 1 of 2 checks is blocked"),
        (["fail", "blocked"], "does not conform: 1 of 2 checks fails, 1 is blocked"),
    ],
)
def test_the_conclusion_is_one_sentence(run: Run, make: Make, words: list[Word], sentence: str) -> None:
    assert conclusion.sentence(run(*map(make, words))) == sentence


def test_checks_blocked_in_a_chain_are_blocked_by_the_failure(run: Run, make: Make) -> None:
    chain = run(
        make("fail", check="a"),
        make("blocked", check="b", blocked_by="a"),
        make("blocked", check="c", blocked_by="b"),
    )
    assert conclusion.sentence(chain) == "does not conform: 1 of 3 checks fails, 2 are blocked by them"


def test_verdicts_keep_the_order_of_the_ladder_within_their_rank(run: Run, make: Make) -> None:
    words: list[Word] = ["pass", "crash", "known", "blocked", "fail", "undecided", "pass"]
    found = [verdict.verdict for verdict in conclusion.ordered(map(make, words))]
    assert found == ["crash", "fail", "blocked", "known", "undecided", "pass", "pass"]


def pixel(**fields: float | str) -> Pixel:
    told: dict[str, float | str] = {"i": 0, "j": 0, "channel": "red", "expected": 1.0, "tolerance": 0.5, "got": 2.0}
    return Pixel.model_validate(told | {"excess": 2.0} | fields)


@pytest.mark.parametrize(
    ("shown", "expected"),
    [
        (format.value(0.1), "0.1"),
        (format.value(1 / 3), "0.333333333"),
        (format.value(math.nan), "nan"),
        (format.measure(2.44e-7), "2.44e-07"),
        (format.count(19200), "19,200"),
        (format.share(1, 3), "33.3 %"),
        (format.share(0, 0), "–"),
        (format.seconds(0.0213), "21.3 ms"),
        (format.seconds(1.0), "1 s"),
        (format.seconds(99.9), "99.9 s"),
        (format.seconds(119.7), "2 min 0 s"),
        (format.seconds(math.inf), "inf"),
        (format.excess(pixel()), "2 tolerances"),
        (format.excess(pixel(excess=1.0)), "1 tolerance"),
        (format.excess(pixel(excess=math.inf, tolerance=0.0)), "no tolerance: must be exact"),
        (format.off(pixel(got=0.5)), "-0.5"),
        (format.unit(pixel(unit="code")), "display code"),
        (format.kinds({}), "none"),
        (format.kinds({"b": 1, "a": 1, "c": 2}), "c 2, a 1, b 1"),
        (format.shell(("a b", "$x")), "'a b' '$x'"),
        (format.slide("Phong Effect"), "L11: Phong Effect"),
        (format.slide("L11: Phong Effect"), "L11: Phong Effect"),
    ],
)
def test_numbers_and_names_read_well(shown: str, expected: str) -> None:
    assert shown == expected
