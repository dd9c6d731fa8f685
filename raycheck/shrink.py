"""The first failing scenes of a check, each reduced to the smallest that still fails, with lines to run it."""

from __future__ import annotations

import os
import shlex
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from oracles import kept
from oracles.compare import Comparison, bounds, compare
from oracles.conventions import Convention, transfer_of
from oracles.shrinking import Limits, Pixel, Step, shrink, words
from oracles.truth import Truth, truth
from oracles.verdict import USABLE, Shrunk, Verdict
from raycheck.errors import StartError, UsageError
from raycheck.subjects import Subject
from raycheck.subjects.command import CommandSubject
from raycheck.subjects.images import ImagesSubject
from raycheck.suite import Hearing
from scenes.catalogue import Rung
from scenes.disk import write_whole
from scenes.json_form import to_json
from scenes.model import Scene
from scenes.text import to_text

FOLDER = "scenes"
PLACE = "a folder for scenes, under --out DIR"
LARGEST = 160 * 120
"""Pixels of a scene that is tried; truth of the hardest takes a second or two."""
TEXT = 4000
"""Letters of a scene that stands in the results itself."""


@dataclass(frozen=True)
class ShrinkPlan:
    """How many failing scenes are shrunk, in how many seconds all together, with how many tries each.

    repeat: the command line that judges one scene file; {scene} stands for it.
    """

    repeat: str
    scenes: int = 3
    seconds: float = 10.0
    tries: int = 400


NO_SHRINKING = ShrinkPlan("", scenes=0)


def shrunk(
    hearing: Hearing, plan: ShrinkPlan, verdicts: Sequence[Verdict], out: Path, told: Callable[[str], object]
) -> Iterator[tuple[int, Verdict]]:
    """(place, verdict) of those verdicts whose scene was made smaller, which is written to out/scenes.

    Only of a tracer that can be asked, and whose answer is a picture, not a draw. The first failing rungs are taken:
    what they build on passed, so what is left of them can hardly show another mistake than theirs.
    """
    rungs = {f"image/{rung.name}": rung for rung in hearing.plan.rungs}
    if hearing.subject.spp is not None or isinstance(hearing.subject, ImagesSubject):
        return
    end = time.monotonic() + plan.seconds
    failing = list(_first(verdicts, rungs))[: plan.scenes]
    for k, place in enumerate(failing):
        told(f"shrinking {verdicts[place].check}")
        share = (end - time.monotonic()) / (len(failing) - k)
        try:
            found = _smallest(hearing, rungs[verdicts[place].check], plan, share, out)
        except StartError:  # it was there a moment ago; what it was found to be stands
            return
        if found is not None:
            yield place, verdicts[place].model_copy(update={"shrunk": found})


def _first(verdicts: Sequence[Verdict], rungs: Mapping[str, Rung]) -> Iterator[int]:
    """Places of failed rungs that build on nothing that failed."""
    shaken: set[str] = set()
    for place, verdict in enumerate(verdicts):
        if verdict.check not in rungs or verdict.verdict in USABLE:
            continue
        rung = rungs[verdict.check]
        if verdict.verdict == "fail" and shaken.isdisjoint(rung.requires):
            yield place
        shaken.add(rung.name)


def make_room(out: Path, rungs: Iterable[Rung]) -> None:
    """Remove what an earlier check left, but what is asked now; raise UsageError if scenes cannot go there."""
    folder = out / FOLDER
    asked = {Path(rung.asked).resolve() for rung in rungs}
    if folder.exists() and not folder.is_dir():
        raise UsageError(f"{folder}: not a folder", PLACE)
    for path in folder.glob("*.shrunk.*"):
        if path.suffix in (".json", ".txt") and path.resolve() not in asked:
            path.unlink(missing_ok=True)


def _smallest(hearing: Hearing, rung: Rung, plan: ShrinkPlan, seconds: float, out: Path) -> Shrunk | None:
    """The rung's scene made smaller, if it can be in this time, and fails whenever it is asked."""
    failing = Failing(hearing.subject, hearing.plan.seed, hearing.convention, time.monotonic() + seconds)
    if 3.0 * hearing.attempts[rung.name].seconds > seconds:  # nothing would come of it
        return None
    scene = hearing.plan.scene(rung)
    last: Step | None = None
    for step in shrink(scene, failing, Limits(plan.tries, seconds)):
        last = step
    if last is None or last.scene == scene:
        return None
    failing.patience = 1.0 + 2.0 * failing.slowest
    named = last.scene.model_copy(update={"name": f"{rung.name[:57]}-shrunk"})
    if failing(named) is None:  # it fails by chance
        return None
    return _told(hearing, plan, replace(last, scene=named), failing, rung, out)


class Failing:
    """Whether a scene fails as the first one did: a wrong picture, and wrong where there is no doubt.

    Pixels in doubt count only if the first scene had no other. `patience`: seconds that a program may take even
    after the end; `slowest`: what one took; `worst`: the evidence of the last failure.
    """

    def __init__(self, subject: Subject, seed: int, convention: Convention, end: float) -> None:
        self.subject, self.seed, self.convention, self.end = subject, seed, convention, end
        self.clear: bool | None = None
        self.patience = self.slowest = 0.0
        self.worst: dict[str, object] = {}

    def __call__(self, scene: Scene) -> Pixel | None:
        """(i, j) of the most wrong pixel."""
        width, height = scene.image.width, scene.image.height
        if self.convention.slip.pixel and min(width, height) < 2:
            return None  # w-1 is nothing to divide by
        if self.clear is not None and width * height > LARGEST:
            return None
        begin = time.monotonic()
        attempt = self._hurried().render(scene, self.seed)
        self.slowest = max(self.slowest, time.monotonic() - begin)
        if attempt.picture is None:
            return None
        expected = self._truth(scene)
        picture = self.convention.slip.undone(attempt.picture)
        comparison = compare(picture, expected)
        wrong = self._wrong(expected, comparison)
        if not wrong.any():
            return None
        lawful = bounds(picture, expected)
        off = np.where(wrong, np.abs(picture.values - lawful.middle).max(axis=-1), -1.0)
        j, i = (int(k) for k in np.unravel_index(int(np.argmax(off)), off.shape))
        reach = np.maximum(lawful.high - lawful.middle, lawful.middle - lawful.low)
        self.worst = {
            "pixel": (i, j),
            "expected": tuple(lawful.middle[j, i].tolist()),
            "tolerance": tuple(reach[j, i].tolist()),
            "got": tuple(picture.values[j, i].tolist()),
            "unit": lawful.unit,
        }
        return i, j

    def _truth(self, scene: Scene) -> Truth:
        """Of the first scene it is known already; those of the others are not kept."""
        convention, precision = self.convention, self.subject.precision
        if self.clear is None and not convention.slip.pixel:
            expected = kept.truth(scene, precision, "numpy", convention.dialect)
        else:
            expected = truth(scene, precision, "numpy", convention.rules())
        return replace(expected, transfer=transfer_of(convention.slip))

    def _wrong(self, expected: Truth, comparison: Comparison) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        clear: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] = comparison.outside & (expected.doubts == 0)
        if self.clear is None:
            self.clear = bool(clear.any())
        return clear if self.clear else comparison.outside

    def _hurried(self) -> Subject:
        """The subject; a program with no more time than there is left."""
        if not isinstance(self.subject, CommandSubject):
            return self.subject
        left = max(self.end - time.monotonic(), self.patience, 0.01)
        timeout = min(self.subject.manifest.timeout, left)
        return replace(self.subject, manifest=self.subject.manifest.model_copy(update={"timeout": timeout}))


def _told(hearing: Hearing, plan: ShrinkPlan, step: Step, failing: Failing, rung: Rung, out: Path) -> Shrunk:
    """Write the scene, in the tracer's notation, and say everything about it."""
    written = hearing.subject.scene_form == "text"
    text = to_text(step.scene) if written else to_json(step.scene)
    name = f"{FOLDER}/{rung.name}.shrunk.{'txt' if written else 'json'}"
    try:
        (out / FOLDER).mkdir(exist_ok=True)
        write_whole(out / name, text.encode())
    except OSError as error:
        raise UsageError(f"{out / name}: {error.strerror}", PLACE) from None
    convention = hearing.convention
    lines = [*convention.slip.words(), *convention.dialect.lines()]
    return Shrunk.model_validate(
        {
            "file": name,
            "left": words(step.scene),
            "text": text if len(text) <= TEXT else "",
            "under": "; ".join(lines) if convention != Convention(hearing.subject.dialect) else "",
            "tries": step.tries,
            "least": step.least,
            "run": _own_line(hearing.subject, step.scene, out / name, hearing.plan.seed),
            "judge": plan.repeat.format(scene=shlex.quote(str(out / name))),
        }
        | failing.worst
    )


def _own_line(subject: Subject, scene: Scene, file: Path, seed: int) -> str:
    """The tracer's command on that file, from where raycheck was called; the picture comes to lie beside the scene."""
    if not isinstance(subject, CommandSubject):
        return ""
    folder = Path(subject.spec) if subject.spec else Path()
    there = Path(os.path.relpath(file, folder))
    line = shlex.join(subject.arguments(scene, there, there.with_suffix(f".{subject.image_form}"), seed))
    return f"(cd {shlex.quote(str(folder))} && {line})" if subject.spec else line
