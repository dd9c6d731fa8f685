"""What a hearing's pictures and answers come to: the diagnosis, with the picture and the line that show it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from oracles.conventions import Convention
from oracles.diagnosis import Answers, diagnose, predicted
from oracles.faults import fault
from oracles.images.writing import png_bytes
from oracles.inference import Exhibit
from oracles.verdict import Diagnosis, Verdict
from raycheck.suite import Hearing
from reference_tracer.formulas.display import encode

PICTURE = "images/diagnosis.png"
LAW, OF_PICTURES = "law/", "law/image/"


def diagnosed(
    hearing: Hearing, verdicts: Sequence[Verdict], folder: Path, told: Callable[[str], Any] = lambda words: None
) -> Diagnosis | None:
    """The diagnosis of a subject that does not conform; None where nothing fails but what is known to."""
    return explained(hearing.exhibits, hearing.convention, verdicts, folder, told)


def explained(
    exhibits: Mapping[str, Exhibit],
    convention: Convention,
    verdicts: Sequence[Verdict],
    folder: Path,
    told: Callable[[str], Any] = lambda words: None,
) -> Diagnosis | None:
    """What explains the failures among these verdicts; the pictures by scene, where what the faults make is written."""
    if not any(verdict.verdict == "fail" for verdict in verdicts):
        return None
    known = {v.check for v in verdicts if v.verdict == "known"}
    wanted = [exhibit for name, exhibit in exhibits.items() if f"image/{name}" not in known]
    told("looking for what explains the wrong pictures")
    base = convention.rules()
    found = diagnose(wanted, base, answers(verdicts), told)
    if found is None:
        return None
    found = _shown(found, exhibits, verdicts)
    repeat = next((v.reproduce for v in verdicts if v.check == found.check), "")
    picture = None
    if found.faults and found.check:
        exhibit = exhibits[found.check.removeprefix("image/")]
        written = predicted(exhibit, [fault(suspect.name) for suspect in found.faults], base)
        linear = written.maximum is None
        codes = encode(written.values, exhibit.scene.display) if linear else written.values.astype(np.int64)
        (folder / PICTURE).write_bytes(png_bytes(codes))
        picture = PICTURE
    return found.model_copy(update={"reproduce": repeat, "picture": picture})


def _shown(found: Diagnosis, exhibits: Mapping[str, Exhibit], verdicts: Sequence[Verdict]) -> Diagnosis:
    """By the first picture that failed, where what was found shows in one that the report lacks, being blocked."""
    failed = [v.check for v in verdicts if v.verdict == "fail" and v.check.removeprefix("image/") in exhibits]
    if not found.check or found.check in failed or not failed:
        return found
    wrong = exhibits[failed[0].removeprefix("image/")].wrong
    j, i = (int(k) for k in np.argwhere(wrong)[0])
    return found.model_copy(update={"check": failed[0], "pixel": (i, j)})


def answers(verdicts: Sequence[Verdict]) -> Answers:
    """Which operations of the probe keep all their laws, and which laws the others break."""
    asked = [v for v in verdicts if v.check.startswith(LAW) and not v.check.startswith(OF_PICTURES)]
    broken: dict[str, tuple[str, ...]] = {}
    kept: set[str] = set()
    for verdict in asked:
        operation = verdict.check.split("/")[1]
        if verdict.verdict == "fail":
            broken[operation] = (*broken.get(operation, ()), verdict.check)
        elif verdict.verdict == "pass":
            kept.add(operation)
    return Answers(broken, frozenset(kept) - set(broken))
