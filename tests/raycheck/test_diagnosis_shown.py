"""What a check shows beside its diagnosis."""

from __future__ import annotations

from pathlib import Path

from raycheck.diagnosis import diagnosed
from raycheck.known import Known
from raycheck.subjects.fault import FaultSubject
from raycheck.suite import Hearing, Plan
from scenes.catalogue import rung


def test_the_picture_shown_is_one_that_the_report_has(tmp_path: Path) -> None:
    subject = FaultSubject("fault/exponent-plus-1")
    plan = Plan([rung("phong-10"), rung("phong-100")], (24, 18), 0, False, Known({}), "{scene}")
    hearing = Hearing(subject, plan, tmp_path)
    first, second = hearing.verdicts()
    assert [v.verdict for v in (first, second)] == ["fail", "fail"]
    for verdicts, shown in (
        ((first, second), first),
        ((first.model_copy(update={"verdict": "blocked"}), second), second),
    ):
        found = diagnosed(hearing, verdicts, tmp_path)
        assert found
        assert (found.check, found.reproduce) == (shown.check, shown.reproduce)
        i, j = found.pixel or (-1, -1)
        assert hearing.exhibits[shown.check.removeprefix("image/")].wrong[j, i]


def test_the_picture_of_a_fault_is_what_it_writes(tmp_path: Path) -> None:
    plan = Plan([rung("bright-light")], (24, 18), 0, False, Known({}), "{scene}")
    hearing = Hearing(FaultSubject("fault/byte-wraps"), plan, tmp_path)
    verdicts = list(hearing.verdicts())
    assert diagnosed(hearing, verdicts, tmp_path)
    got = (tmp_path / "images" / "bright-light.got.png").read_bytes()
    assert (tmp_path / "images" / "diagnosis.png").read_bytes() == got
    assert got != (tmp_path / "images" / "bright-light.expected.png").read_bytes()
