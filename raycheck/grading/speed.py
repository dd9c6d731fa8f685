"""How fast a submission is: as a multiple of the reference tracer, timed beside it on the same machine.

A timing is alone on its machine: asking holds a lock of the machine together with others, timing holds it alone.
So nothing else that grades runs meanwhile. A multiple is not the same twice; rubrics ask for coarse steps of it.
"""

from __future__ import annotations

import contextlib
import fcntl
import math
import os
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import count
from pathlib import Path

from oracles import kept
from oracles.compare import compare
from oracles.images import Picture
from oracles.verdict import Verdict
from raycheck.errors import UsageError
from raycheck.grading.rubric import speed_check
from raycheck.lanes import best_lanes
from raycheck.subjects import Attempt, Subject
from raycheck.subjects.inprocess import ReferenceSubject
from reports.format import times as shown
from scenes.generator import generate
from scenes.model import Scene

REFERENCE = "reference/plain"
ROUNDS = 3
"""Of which the shortest time counts: whatever disturbs makes it longer."""
SCALES = (1, 2, 4, 8)
"""Sides of the timed picture, in sides of those that are judged."""
GROWTH = 4
"""Pixels of a scale, in those of the one before."""
LONG = 2.0
"""Seconds beyond its start that a picture may take, if there is a choice; a start varies by some 0.1 s."""
LEAST = 1e-3
"""Seconds: a difference of two runs below this says nothing."""
OBJECTS = 3
LOCK = "timing.lock"


@contextlib.contextmanager
def machine(alone: bool) -> Iterator[None]:
    """Hold this machine together with others, or alone; gone with the process that held it."""
    folder = Path(tempfile.gettempdir()) / f"raycheck-timing-{os.geteuid()}"
    with contextlib.suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    told = folder.lstat()
    if folder.is_symlink() or not folder.is_dir() or told.st_uid != os.geteuid():
        raise UsageError(f"{folder} is not a folder of yours", "remove it, or set TMPDIR")
    descriptor = os.open(folder / LOCK, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW, 0o600)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX if alone else fcntl.LOCK_SH)
        yield
    finally:
        os.close(descriptor)


def timed_scene(seed: int, size: tuple[int, int]) -> Scene:
    """The scene that is timed: the first of those drawn from the seed that has several objects."""
    drawn = (generate(seed + k, "timed", *size) for k in count())
    return next(scene for scene in drawn if len(scene.objects) >= OBJECTS)


@dataclass(frozen=True)
class Timing:
    """times: as fast as the reference tracer, None where it was not timed; then word and message tell why."""

    times: float | None
    word: str = ""
    message: str = ""


def timing(subject: Subject, scene: Scene) -> Timing:
    """Time a subject beside the reference tracer; its picture must be right."""
    missing = sorted(scene.features - set(subject.features)) if subject.features is not None else []
    if missing:
        return Timing(None, "unsupported", f"the timed scene needs {', '.join(missing)}, which is not offered")
    if subject.spp is not None:
        return Timing(None, "unsupported", "pictures that are drawn by chance are not timed")
    large, first = _large(subject, scene)
    if first.picture is None:  # what it printed may tell the scene, which nobody is to know
        return Timing(None, first.word or "invalid", "no picture of the timed scene came")
    if not _right(subject, large, first.picture):
        return Timing(None, "blocked", "only right pictures are timed, and that of the timed scene is wrong")
    own, theirs = _Clock(subject, large), _Clock(ReferenceSubject(REFERENCE), scene)
    for _ in range(ROUNDS):
        if not own.tick():
            return Timing(None, "error", "a picture that came once did not come again")
        theirs.tick()
    return Timing(theirs.pixel / own.pixel)


def _large(subject: Subject, scene: Scene) -> tuple[Scene, Attempt]:
    """The scene at the largest size that does not take too long, and the first picture of it."""
    for scale in SCALES:
        larger = scene.resized(scale * scene.image.width, scale * scene.image.height)
        attempt = subject.render(larger, 0)
        if attempt.picture is None or GROWTH * (attempt.seconds - _start(subject, larger)) > LONG:
            break
    return larger, attempt


def _start(subject: Subject, scene: Scene) -> float:
    """Seconds of the same picture without things in it; 0 where a tracer cannot do without."""
    nothing = subject.render(scene.model_copy(update={"objects": (), "lights": ()}), 0)
    return nothing.seconds if nothing.picture is not None else 0.0


@dataclass
class _Clock:
    """A scene's times with what is in it and without, the shortest of each."""

    subject: Subject
    scene: Scene
    full: float = math.inf
    start: float = math.inf

    def tick(self) -> bool:
        """Time both once; False where no picture came."""
        attempt = self.subject.render(self.scene, 0)
        self.full = min(self.full, attempt.seconds)
        self.start = min(self.start, _start(self.subject, self.scene))
        return attempt.picture is not None

    @property
    def pixel(self) -> float:
        """Seconds a pixel that the things in the scene cost."""
        return max(LEAST, self.full - self.start) / (self.scene.image.width * self.scene.image.height)


def _right(subject: Subject, scene: Scene, picture: Picture) -> bool:
    return compare(picture, kept.truth(scene, subject.precision, best_lanes(), subject.dialect)).word != "fail"


def speed_verdicts(found: Timing, steps: Sequence[float]) -> list[Verdict]:
    """A verdict a step."""
    teaches = "time of a picture beyond that of an empty one, against the reference tracer's"
    verdicts = []
    for times in steps:
        word, message = found.word, found.message
        if found.times is not None:
            word = "pass" if found.times >= times else "fail"
            message = f"{shown(found.times)} as fast as the reference tracer, {times:g}× asked"
        told = {"check": speed_check(times), "verdict": word, "message": message, "teaches": teaches}
        verdicts.append(Verdict.model_validate(told))
    return verdicts
