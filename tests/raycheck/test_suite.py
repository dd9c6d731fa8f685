"""The ladder asked of a tracer: what blocks, what is unsupported, what is known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from oracles.verdict import Verdict
from raycheck.known import Known
from raycheck.subjects import attach
from raycheck.suite import Hearing, Plan
from reports.results import Results
from scenes.catalogue import ladder, rung

Attached = Callable[..., Path]
Check = Callable[..., Results]
SMALL = ("--size", "16x12")
EVERYTHING = 'features = ["plane", "shadow", "reflect", "refract", "fresnel"]'
BACKGROUND_ONLY = """
with open(image, "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *background) * (width * height))
"""


def rungs_of(found: Results) -> list[Verdict]:
    """The verdicts on the ladder; laws have tests of their own."""
    return [v for v in found.verdicts if v.check.startswith("image/")]


def words_of(found: Results) -> dict[str, str]:
    return {v.check.removeprefix("image/"): v.verdict for v in rungs_of(found)}


def test_a_rung_that_fails_blocks_what_builds_on_it_and_is_named_as_the_blocker(
    attached: Attached, check: Check
) -> None:
    found = check(attached(BACKGROUND_ONLY, EVERYTHING), *SMALL)
    words = words_of(found)
    assert words["background"] == "pass"
    assert words["headlight-plane"] == "fail"
    rungs = {entry.name: entry for entry in ladder()}
    for verdict in rungs_of(found):
        unusable = [name for name in rungs[verdict.check.removeprefix("image/")].requires if words[name] != "pass"]
        assert (verdict.verdict == "blocked") == bool(unusable)
        assert verdict.blocked_by == (f"image/{unusable[0]}" if unusable else None)
        assert (verdict.process is None) == bool(unusable)
    assert list(words.values()).count("blocked") > len(rungs) // 2


def test_no_block_asks_every_rung(attached: Attached, check: Check) -> None:
    found = check(attached(BACKGROUND_ONLY, EVERYTHING), *SMALL, "--no-block")
    words = words_of(found)
    assert set(words.values()) <= {"pass", "fail", "undecided"}
    assert all(v.process is not None for v in rungs_of(found))
    assert len(words) == len(ladder())


def test_a_rung_asked_alone_is_not_blocked_by_what_was_not_asked(attached: Attached, check: Check) -> None:
    assert words_of(check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", "glass-sphere")) == {"glass-sphere": "fail"}


def test_scenes_are_asked_once_and_in_the_ladders_order(attached: Attached, check: Check) -> None:
    found = check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", "depth-order,background,depth-order", "--no-block")
    assert list(words_of(found)) == ["background", "depth-order"]
    assert found.planned == 2


def test_who_does_not_speak_of_fresnel_is_not_asked_for_it(attached: Attached, check: Check) -> None:
    words = words_of(check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", "background,glass-fresnel", "--no-block"))
    assert words == {"background": "pass", "glass-fresnel": "unsupported"}


def test_features_a_tracer_lacks_are_unsupported_and_named(attached: Attached, check: Check) -> None:
    found = check(attached(BACKGROUND_ONLY, 'features = ["plane", "shadow"]'), *SMALL, "--no-block")
    for verdict in rungs_of(found):
        scene = next(r for r in ladder() if r.name == verdict.check.removeprefix("image/")).scene()
        missing = scene.features - {"plane", "shadow"}
        assert (verdict.verdict == "unsupported") == bool(missing)
        for feature in missing:
            assert feature in verdict.message


def test_what_builds_on_an_unsupported_rung_is_unsupported_and_not_blocked(attached: Attached, tmp_path: Path) -> None:
    floor, ball = rung("headlight-plane"), replace(rung("headlight-sphere"), requires=("headlight-plane",))
    plan = Plan([floor, ball], (16, 12), 0, True, Known({}), "{scene}")
    subject = attach(str(attached(BACKGROUND_ONLY, "features = []")))
    first, second = Hearing(subject, plan, tmp_path / "report").verdicts()
    assert (first.verdict, second.verdict) == ("unsupported", "unsupported")
    assert "needs plane" in first.message
    assert "builds on image/headlight-plane" in second.message
    assert second.blocked_by is None


def test_a_tracer_without_planes_is_still_asked_about_spheres(attached: Attached, check: Check) -> None:
    words = words_of(check(attached(BACKGROUND_ONLY, "features = []"), *SMALL, "--no-block"))
    assert words["headlight-plane"] == "unsupported"
    assert words["headlight-sphere"] == "fail"


def test_a_tracer_that_supports_nothing_of_what_was_asked_does_not_conform(attached: Attached, check: Check) -> None:
    found = check(attached(BACKGROUND_ONLY, "features = []"), *SMALL, "--scenes", "headlight-plane")
    assert not found.conforms


def known(path: Path, *entries: str) -> Path:
    lines = [f'[[known]]\ncheck = "{entry}"\nreason = "a reason"\nurl = "https://example.org/1"\n' for entry in entries]
    path.write_text("".join(lines), "utf-8")
    return path


def test_a_listed_failure_is_known_and_what_builds_on_it_is_asked(
    attached: Attached, check: Check, tmp_path: Path
) -> None:
    path = known(tmp_path / "known.toml", "image/headlight-plane")
    scenes = "background,headlight-plane,headlight-sphere"
    found = check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", scenes, "--known", path)
    assert words_of(found) == {"background": "pass", "headlight-plane": "known", "headlight-sphere": "fail"}
    message = found.verdicts[1].message
    assert "a reason" in message
    assert "https://example.org/1" in message
    assert "outside their bound" in message


def test_a_tracer_whose_only_failures_are_known_conforms(attached: Attached, check: Check, tmp_path: Path) -> None:
    path = known(tmp_path / "known.toml", "image/headlight-plane")
    found = check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", "background,headlight-plane", "--known", path)
    assert found.conforms


def test_a_listed_check_that_passes_is_fixed_and_does_not_conform(
    attached: Attached, check: Check, tmp_path: Path
) -> None:
    path = known(tmp_path / "known.toml", "image/background")
    found = check(attached(BACKGROUND_ONLY), *SMALL, "--scenes", "background", "--known", path)
    assert words_of(found) == {"background": "fixed"}
    assert not found.conforms
    assert "remove its line" in found.verdicts[0].message


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[known]]\ncheck = "image/nobody"\nreason = "r"\nurl = "u"\n', "'image/nobody'"),
        ('[[known]]\ncheck = "background"\nreason = "r"\nurl = "u"\n', "image/SCENE"),
        ('[[known]]\ncheck = "image/background"\nurl = "u"\n', "known.0.reason"),
        ('[[known]]\ncheck = "image/background"\nreason = ""\nurl = "u"\n', "known.0.reason"),
        ('[[known]]\ncheck = "image/background"\nreason = "r"\n', "known.0.url"),
        ('[[known]]\ncheck = "image/background"\nreason = "r"\nurl = ""\n', "known.0.url"),
        ('[[known]]\ncheck = "image/background"\nreason = "r"\nurl = "u"\nuntil = 3\n', "known.0.until"),
        ("[[unknown]]\n", "unknown"),
        ("[[known", "not TOML"),
        ("known = " + "[" * 30_000, "not TOML"),
        ("known = " + "1" * 6_000, "not TOML"),
        ("#" * (2**20 + 1), "over 1048576 bytes"),
    ],
)
def test_a_wrong_known_file_is_exit_2_and_names_file_and_place(
    raycheck: Callable[..., Any], tmp_path: Path, text: str, message: str
) -> None:
    path = tmp_path / "known.toml"
    path.write_text(text, "utf-8")
    told = raycheck("check", "builtin:reference", "--known", path, "--out", tmp_path / "o")
    assert told.code == 2
    assert str(path) in told.err
    assert message in told.err


def test_an_empty_known_file_changes_nothing(check: Check, tmp_path: Path) -> None:
    (tmp_path / "known.toml").write_text("")
    found = check("builtin:reference", "--scenes", "background", "--known", tmp_path / "known.toml")
    assert words_of(found) == {"background": "pass"}
