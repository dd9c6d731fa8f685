"""A class: every submission graded once, whatever interrupts; the outputs written from the records."""

from __future__ import annotations

import secrets
import shutil
import sys
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from raycheck import VERSION, session
from raycheck.errors import UsageError
from raycheck.grading.adjust import Adjustments
from raycheck.grading.one import RECORDS, STUDENTS, Asked, failed, record_path
from raycheck.grading.pool import Pool
from raycheck.grading.rubric import Rubric
from raycheck.grading.submissions import Submission
from raycheck.progress import Progress
from raycheck.sandbox.room import Room
from reports import classroom, grades
from reports.grades import Graded
from scenes.catalogue import catalogue_hash
from scenes.disk import read_bounded, write_whole
from scenes.json_form import to_json

RUN, HIDDEN = "run.json", "hidden"


class _Run(BaseModel):
    """What a folder of grades was made with."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    schema_version: Literal[1] = 1
    seed: int


@dataclass(frozen=True)
class Order:
    """What the lecturer wants graded, and how. only: names; again: also what is graded and failed."""

    submissions: Sequence[Submission]
    rubric: Rubric
    adjustments: Adjustments
    out: Path
    seed: int | None
    room: Room
    pool: Pool
    only: Collection[str] | None
    again: bool


def grade_class(order: Order) -> list[Graded]:
    """Grade what is not graded yet, write all outputs, return the class in the submissions' order."""
    for folder in (order.out, order.out / RECORDS, order.out / STUDENTS, order.out / HIDDEN):
        session.make_folder(folder)
    asked = Asked(order.rubric, seed_of(order.out, order.seed), order.out, order.room)
    _keep_hidden(asked)
    chosen = _chosen(order)
    rerun = [s for s in chosen if order.again and _failed(order.out, s)]
    progress = Progress("grading", len(chosen))
    try:
        for batch, again in ((rerun, True), ([s for s in chosen if s not in rerun], False)):
            for record in order.pool.records(asked, batch, again):
                progress.step(record.name)
    finally:
        progress.close()
    return write(order, asked)


def _keep_hidden(asked: Asked) -> None:
    """The hidden scenes, for the lecturer who is asked about one."""
    for rung in asked.hidden:
        write_whole(asked.out / HIDDEN / f"{rung.name}.json", to_json(rung.scene()).encode())


def _failed(out: Path, submission: Submission) -> bool:
    record = grades.read(record_path(out, submission))
    return record is not None and failed(record)


def _chosen(order: Order) -> list[Submission]:
    if order.only is None:
        return list(order.submissions)
    names = {submission.name for submission in order.submissions}
    for name in order.only:
        if name not in names:
            raise UsageError(f"--only {name}: no such submission", f"for example {min(names)}")
    return [submission for submission in order.submissions if submission.name in order.only]


def seed_of(out: Path, wanted: int | None) -> int:
    """The seed of this folder: that of its first run, so that a run can go on; else a new one that nobody can guess."""
    path = out / RUN
    try:
        earlier = _Run.model_validate_json(read_bounded(path, 2**16)).seed
    except FileNotFoundError:
        earlier = None
    except (OSError, ValidationError) as error:
        raise UsageError(f"{path}: {error}", "remove the folder, or grade into another") from None
    seed = wanted if wanted is not None else earlier if earlier is not None else secrets.randbits(48)
    if seed != earlier:
        write_whole(path, (_Run(seed=seed).model_dump_json() + "\n").encode())
    return seed


def write(order: Order, asked: Asked) -> list[Graded]:
    """grades.csv, the class's page and each student's, from the records there are."""
    graded = []
    for submission in order.submissions:
        record = grades.read(record_path(order.out, submission))
        if record is not None:
            graded.append(Graded(record=record, adjustments=order.adjustments.get(submission.name, ())))
    _remove_strangers(order.out, {submission.slug for submission in order.submissions})
    width, height = asked.size
    told = classroom.Classroom(
        name=order.rubric.name,
        suite=VERSION,
        catalogue=catalogue_hash(),
        seed=asked.seed,
        size=f"{width}x{height}",
        expected=len(order.submissions),
        graded=tuple(graded),
    )
    classroom.write(told, order.out)
    return graded


def _remove_strangers(out: Path, slugs: Collection[str]) -> None:
    """Pages of submissions that are no longer there would still be handed out."""
    for folder in (out / STUDENTS).iterdir():
        if folder.name not in slugs:
            print(f"raycheck: {folder.name} is no longer among the submissions; its page is removed", file=sys.stderr)
            shutil.rmtree(folder, ignore_errors=True)
