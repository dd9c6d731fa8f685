"""From verdicts to points, case by case."""

from __future__ import annotations

from typing import Any

import pytest

from oracles.verdict import Verdict
from raycheck.grading.rubric import Rubric
from raycheck.grading.score import Evidence, score
from reports.grades import GroupScore

GROUP = {"name": "g", "points": 10, "rungs": ["background", "headlight-plane", "headlight-sphere"]}


def verdicts(**words: str) -> dict[str, Verdict]:
    """Of the group's rungs: pass unless said otherwise; underscores for hyphens."""
    said = {name.replace("_", "-"): word for name, word in words.items()}
    found = {}
    for name in GROUP["rungs"]:
        requires = () if name == "background" else ("background",)
        told = {"check": f"image/{name}", "verdict": said.get(str(name), "pass"), "message": "m", "requires": requires}
        found[f"image/{name}"] = Verdict.model_validate(told)
    return found


def scored(evidence: Evidence, **more: Any) -> GroupScore:
    (group,) = score(Rubric.model_validate({"name": "r", "group": [GROUP | more]}), evidence, ())
    return group


def counts(group: GroupScore) -> list[str]:
    return [line.counts for line in group.lines]


def test_a_failed_check_costs_its_share() -> None:
    group = scored(Evidence(verdicts(headlight_plane="fail")))
    assert (group.earned, counts(group)) == (6.67, ["earned", "lost", "earned"])


def test_what_builds_on_a_failed_check_is_not_charged_again() -> None:
    group = scored(Evidence(verdicts(background="fail", headlight_plane="fail")))
    assert (group.earned, counts(group)) == (5.0, ["lost", "excused", "earned"])


def test_a_blocked_check_is_excused() -> None:
    group = scored(Evidence(verdicts(headlight_sphere="blocked")))
    assert (group.earned, counts(group)) == (10.0, ["earned", "earned", "excused"])


def test_a_fault_that_is_charged_elsewhere_costs_nothing_here() -> None:
    told = verdicts(headlight_plane="fail", headlight_sphere="fail")
    group = scored(Evidence(told, explained={"image/headlight-sphere": "the same fault"}))
    assert (group.earned, counts(group)) == (6.67, ["earned", "lost", "explained"])
    assert group.lines[2].why == "the same fault"


def test_a_check_that_passed_is_earned_whatever_explains_it() -> None:
    group = scored(Evidence(verdicts(), explained={"image/background": "x"}, foreign={"image/background": "x"}))
    assert counts(group) == ["earned"] * 3


@pytest.mark.parametrize(("word", "worth", "points"), [("lost", 6.67, 10.0), ("left out", 10.0, 10.0)])
def test_what_a_tracer_does_not_offer_costs_what_the_group_says(word: str, worth: float, points: float) -> None:
    group = scored(Evidence(verdicts(headlight_sphere="unsupported")), unsupported=word)
    assert (group.earned, counts(group)[2], group.points) == (worth, word, points)


def test_a_group_of_which_nothing_concerns_the_tracer_is_left_out() -> None:
    told = verdicts(**{str(name).replace("-", "_"): "fail" for name in GROUP["rungs"]})
    assert scored(Evidence(told, foreign=dict.fromkeys(told, "other conventions"))).left_out
    assert not scored(Evidence(told)).left_out


def test_a_group_of_which_nothing_could_be_shown_earns_nothing_and_counts() -> None:
    told = verdicts(**{str(name).replace("-", "_"): "blocked" for name in GROUP["rungs"]})
    group = scored(Evidence(told))
    assert (group.earned, group.left_out) == (0.0, False)


def with_mistakes(points: float, **words: str) -> tuple[GroupScore, ...]:
    rubric = Rubric.model_validate({"name": "r", "group": [GROUP], "mistakes": {"points": points}})
    found = verdicts(**words)
    covered = {check: "a" for check, verdict in found.items() if verdict.verdict == "fail"}
    return score(rubric, Evidence(found, covered, {"a-fault": "what it is"} if covered else {}), ())


def test_a_known_fault_costs_its_points_once_however_much_it_breaks() -> None:
    group, known = with_mistakes(2, background="fail", headlight_plane="fail", headlight_sphere="fail")
    assert (group.earned, counts(group)) == (10.0, ["explained"] * 3)
    assert (known.earned, counts(known), known.points) == (-2.0, ["charged"], 0.0)


def test_a_known_fault_costs_no_more_than_what_it_breaks() -> None:
    group, known = with_mistakes(8, headlight_sphere="fail")
    assert (group.earned, known.earned) == (10.0, -3.33)  # 10/3 points were to be lost


def test_what_no_fault_explains_is_charged_as_ever() -> None:
    group, known = with_mistakes(8, headlight_sphere="crash")
    assert (group.earned, counts(group)[2]) == (6.67, "lost")
    assert (known.earned, known.lines) == (0.0, ())


def test_a_right_tracer_has_no_mistakes() -> None:
    group, known = with_mistakes(8)
    assert (group.earned, known.earned, known.sum_in_words) == (10.0, 0.0, "none charged: 0")
