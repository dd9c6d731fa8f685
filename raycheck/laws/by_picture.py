"""The laws of pictures, put to a subject that renders."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from oracles import kept
from oracles.conventions import Convention
from oracles.laws import NoAnswerError
from oracles.laws.dice import repeated, seeded
from oracles.laws.pictures import PictureLaw, Sight, sight
from oracles.verdict import USABLE, Case, Verdict
from raycheck.lanes import best_lanes
from raycheck.laws.plan import GROUND, LawPlan, verdict_on
from raycheck.manifest import FEATURES
from raycheck.subjects import Subject
from raycheck.subjects.images import ImagesSubject
from reference_tracer.dialects import Dialect
from scenes.model import Scene


def picture_verdicts(
    subject: Subject, plan: LawPlan, laws: list[PictureLaw], convention: Convention, before: Sequence[Verdict]
) -> Iterator[Verdict]:
    """The laws of pictures; blocked where not even the first rung was drawn, or every picture slips."""
    grounds = (GROUND, *((SLIPPED,) if convention.slip.words() else ()))
    built_on = {v.check: v.verdict for v in before if v.check in grounds and v.verdict not in USABLE}
    studio = _Studio(subject, plan.seed, convention.dialect)
    for law in laws:
        begin = time.monotonic()
        if isinstance(subject, ImagesSubject):
            verdict = verdict_on(law, plan, "unsupported", "a folder of pictures holds no picture of this law's scenes")
        elif plan.block and built_on:
            check, word = next(iter(built_on.items()))
            verdict = verdict_on(law, plan, "blocked", f"builds on {check}, which is {word}", blocked_by=check)
        else:
            verdict = _looked_at(law, studio, plan)
        yield verdict.model_copy(update={"seconds": time.monotonic() - begin})


SLIPPED = "convention/picture"
"""The check under which pictures are found upside down or otherwise not as asked for."""


class _Studio:
    """A subject that renders; no scene twice."""

    def __init__(self, subject: Subject, seed: int, dialect: Dialect) -> None:
        self.subject, self.seed, self.dialect = subject, seed, dialect
        offered = subject.features if subject.features is not None else FEATURES
        self.features = frozenset(offered)
        self.lanes = best_lanes()
        self.shown: dict[str, Sight] = {}

    def show(self, scene: Scene) -> Sight:
        """Render, and compute what is true of the picture."""
        key = scene.content_hash()
        if key not in self.shown:
            attempt = self.subject.render(scene, self.seed)
            if attempt.picture is None:
                raise NoAnswerError(attempt.word or "invalid", attempt.message)
            expected = kept.truth(scene, self.subject.precision, self.lanes, self.dialect)
            self.shown[key] = sight(attempt.picture, expected)
        return self.shown[key]


def _looked_at(law: PictureLaw, studio: _Studio, plan: LawPlan) -> Verdict:
    """One case plainly, more as explored."""
    missing = sorted(set(law.needs) - studio.features)
    if missing:
        return verdict_on(law, plan, "unsupported", f"needs {', '.join(missing)}, which the tracer does not offer")
    worst = 0.0
    precision = studio.subject.precision
    try:
        for k in range(1 + plan.explore):
            dice = repeated(np.zeros((1, 0)), precision) if k == 0 else seeded(1, precision, plan.seed + k)
            found = law.test(dice, studio)
            excess = found.excess()
            worst = max(worst, float(excess.max()))
            if worst > 1.0:
                return _picture_failure(law, plan, found, excess)
            if k:
                studio.shown.clear()  # the explored scenes are not asked again
    except NoAnswerError as error:
        return verdict_on(law, plan, error.word, error.message)
    return verdict_on(law, plan, "pass", f"every pixel obeys; the worst used {worst:.2g} of its tolerance")


def _picture_failure(law: PictureLaw, plan: LawPlan, found: Sight, excess: NDArray[np.float64]) -> Verdict:
    wrong = int(np.count_nonzero(np.any(excess > 1.0, axis=-1)))
    gap = found.gap()
    j, i, channel = (int(k) for k in np.unravel_index(int(np.argmax(np.abs(gap) * (excess > 1.0))), gap.shape))
    name = ("red", "green", "blue")[channel]
    off, bound, times = float(gap[j, i, channel]), float(found.bound()[j, i, channel]), float(excess[j, i, channel])
    message = (
        f"{wrong} of {excess.shape[0] * excess.shape[1]} pixels break it; pixel ({i}, {j}) {name} is off by {off:.3g}, "
        f"± {bound:.3g} allowed"
    )
    case = Case(
        quantity=f"pixel ({i}, {j}) {name}: difference of the pictures",
        expected=0.0,
        bound=bound,
        got=off,
        excess=times,
    )
    return verdict_on(law, plan, "fail", message, case=case.model_dump())
