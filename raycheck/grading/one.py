"""One submission: taken in, built, asked, scored, written down."""

from __future__ import annotations

import hashlib
import random
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from oracles.verdict import Diagnosis, Pictures, Verdict
from raycheck import VERSION, manifest, session
from raycheck.errors import StartError, UsageError
from raycheck.grading import evidence, mistakes, speed
from raycheck.grading.patience import Patience
from raycheck.grading.rubric import Rubric
from raycheck.grading.score import nothing, score
from raycheck.grading.submissions import Submission, take_in
from raycheck.known import Known
from raycheck.machine import machine
from raycheck.manifest import Manifest
from raycheck.sandbox.intake import IntakeError, digest
from raycheck.sandbox.room import Room
from raycheck.subjects.command import CommandSubject
from raycheck.suite import Hearing, Plan
from raycheck.workspace import workspace
from reports import grades, results
from reports.grades import Outcome, Record
from scenes.catalogue import Rung, catalogue_hash, ladder
from scenes.generator import drawn

RECORDS, STUDENTS = "records", "students"
BROKEN = frozenset({"invalid", "crash", "timeout", "error", "unsupported"})
"""Words of a rung of which no usable picture came back."""


@dataclass(frozen=True)
class Asked:
    """What every submission of a run is asked, all of it following from the rubric and the seed."""

    rubric: Rubric
    seed: int
    out: Path
    room: Room

    @property
    def size(self) -> tuple[int, int]:
        """Of the pictures: drawn from the seed, so that a picture rendered beforehand has another."""
        draw = random.Random(f"size {self.seed}")  # noqa: S311, no secret
        return 88 + int(32 * draw.random()), 66 + int(24 * draw.random())

    @property
    def rungs(self) -> list[Rung]:
        """The rungs that count and those that they build on, in the ladder's order."""
        wanted = set(self.rubric.rungs)
        for rung in reversed(ladder()):
            if rung.name in wanted:
                wanted.update(rung.requires)
        return [rung for rung in ladder() if rung.name in wanted]

    @property
    def hidden(self) -> list[Rung]:
        """The scenes that nobody has seen."""
        count = self.rubric.hidden.scenes if self.rubric.hidden else 0
        return [drawn(evidence.number(f"hidden {self.seed} {k}"), f"hidden-{k + 1}") for k in range(count)]

    def key(self, content: str) -> str:
        """One word for everything that the scores of this content follow from."""
        parts = (content, VERSION, catalogue_hash(), self.rubric.digest(), str(self.seed), repr(self.room))
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()


class _EndedError(Exception):
    """The submission's way ends here, before it could be asked."""

    def __init__(self, outcome: Outcome, message: str) -> None:
        super().__init__(message)
        self.outcome, self.message = outcome, message


def record_path(out: Path, submission: Submission) -> Path:
    """Where the record of a submission is."""
    return out / RECORDS / f"{submission.slug}.json"


@dataclass(frozen=True)
class Arrived:
    """A submission as it was taken in: where it is, or why it was refused; and the key of what follows from it."""

    root: Path | None
    key: str
    refused: str = ""


def arrive(asked: Asked, submission: Submission, folder: Path) -> Arrived:
    """Take a submission into a folder."""
    try:
        root = take_in(submission, folder)
    except IntakeError as error:
        return Arrived(None, asked.key(f"refused: {error}"), str(error))
    return Arrived(root, asked.key(digest(root)))


def standing(asked: Asked, submission: Submission, key: str) -> Record | None:
    """The record of an earlier run, if it still stands: content, suite, rubric and seed are what they were."""
    earlier = grades.read(record_path(asked.out, submission))
    return earlier if earlier and (earlier.key, earlier.name) == (key, submission.name) else None


def grade(asked: Asked, submission: Submission, again: bool = False) -> Record:
    """The record of a submission: that of an earlier run where it still stands, unless asked for again."""
    with workspace() as folder:
        arrived = arrive(asked, submission, folder)
        earlier = standing(asked, submission, arrived.key)
        if earlier and not again:
            return earlier
        student = asked.out / STUDENTS / submission.slug
        shutil.rmtree(student, ignore_errors=True)
        student.mkdir(parents=True)
        try:
            record = _asked(asked, submission, arrived, student)
        except _EndedError as end:
            record = Record(
                name=submission.name,
                slug=submission.slug,
                key=arrived.key,
                outcome=end.outcome,
                message=end.message,
                groups=nothing(asked.rubric),
            )
        grades.write(record, asked.out / RECORDS)
        return record


def _asked(asked: Asked, submission: Submission, arrived: Arrived, student: Path) -> Record:
    if arrived.root is None:
        raise _EndedError("refused", arrived.refused)
    subject = _subject(asked, arrived.root)
    patience = Patience(subject)
    rubric, hidden = asked.rubric, asked.hidden
    with workspace() as private, evidence.beside_others(rubric):
        _prepare(subject)
        try:
            open_hearing = _hearing(patience, asked.rungs, asked.size, student)
            shown = list(open_hearing.verdicts())
            secret_hearing = _hearing(patience, hidden, None, student if _reveals(rubric) else private)
            secret = list(secret_hearing.verdicts())
            told = secret if _reveals(rubric) else [veiled(verdict) for verdict in secret]
            pictures = (*shown, *told)
            first = next((v.message for v in pictures if v.verdict in BROKEN), "")
            broken = bool(pictures) and all(verdict.verdict in BROKEN for verdict in pictures)
            further = () if broken else evidence.formulas(rubric, asked.seed, subject, patience, shown, student)
            found = mistakes.sought(rubric, open_hearing, secret_hearing, (*shown, *secret, *further), student)
        except StartError as error:
            raise _EndedError("start", str(error)) from None
    timing = speed.Timing(None) if broken else evidence.timing(rubric, asked.seed, asked.size, patience)
    verdicts = (*pictures, *further, *speed.speed_verdicts(timing, () if broken else rubric.speeds))
    told_of = [verdict for verdict in verdicts if evidence.of_conformance(verdict)]
    _write_results(asked, subject, told_of, found.diagnosis, student)
    return Record(
        name=submission.name,
        slug=submission.slug,
        key=arrived.key,
        tracer=subject.name,
        outcome="protocol" if broken else "graded",
        message=first if broken else "",
        groups=score(rubric, evidence.gathered(rubric, subject, verdicts, found), hidden),
        faults=tuple(found.named),
        outside=evidence.outside((*shown, *secret)),
        speed=timing.times,
    )


def _subject(asked: Asked, root: Path) -> CommandSubject:
    """The tracer in the room; its manifest is read once, before any of its code runs."""
    try:
        if asked.rubric.tracer is not None and not (root / manifest.FILE).exists():
            told = asked.rubric.tracer
        else:
            told = manifest.load(root)
        limits = asked.rubric.limits
        told = Manifest.model_validate(told.model_dump() | {"timeout": min(told.timeout, limits.render)})
        return CommandSubject(root, told, "", asked.room, limits.build, limits.probe)
    except UsageError as error:
        raise _EndedError("manifest", str(error).replace(f"{root}/", "")) from None


def _prepare(subject: CommandSubject) -> None:
    try:
        subject.prepare()
    except StartError as error:
        raise _EndedError("build", str(error)) from None


def _hearing(subject: Patience, rungs: Sequence[Rung], size: tuple[int, int] | None, folder: Path) -> Hearing:
    """Every rung is asked, also where one it builds on failed: what passes is earned."""
    shape = f" --size {size[0]}x{size[1]}" if size else ""
    plan = Plan(rungs, size, 0, False, Known({}), f"raycheck check .{shape} --scenes {{scene}}")
    return Hearing(subject, plan, folder)


def _reveals(rubric: Rubric) -> bool:
    return rubric.hidden is not None and rubric.hidden.reveal


def veiled(verdict: Verdict) -> Verdict:
    """A hidden scene's verdict as its author may see it: the word, no values, nothing that the program printed."""
    process = verdict.process.model_copy(update={"output_tail": ""}) if verdict.process else None
    message = {
        "crash": verdict.message,
        "timeout": verdict.message,
        "error": process.status if process else "",
    }.get(verdict.verdict, "the scene and its values are not shown")
    veil = {"message": message, "judged": None, "process": process, "pictures": Pictures(), "reproduce": ""}
    return verdict.model_copy(update=veil)


def _write_results(
    asked: Asked, subject: CommandSubject, verdicts: Sequence[Verdict], diagnosis: Diagnosis | None, student: Path
) -> None:
    width, height = asked.size
    found = results.Results(
        suite=results.Suite(version=VERSION, catalogue=catalogue_hash()),
        subject=session.described(subject),
        machine=machine(),
        started="",
        command="",
        seed=0,
        size=f"{width}x{height}",
        seconds=sum(verdict.seconds for verdict in verdicts),
        planned=len(verdicts),
        verdicts=tuple(verdicts),
        diagnosis=diagnosis,
        complete=True,
    )
    results.write(found, student)


def failed(record: Record) -> bool:
    """Did something go wrong that another try might not meet: a build, a start, a timeout."""
    late = any(line.verdict in ("timeout", "crash") for group in record.groups for line in group.lines)
    return record.outcome != "graded" or late
