"""Grading on a Dask cluster: each submission is one task, sent by content, so that workers need no shared disk.

A lost worker's tasks are run again by the scheduler. What a worker made comes back as bytes and is
written here, record last; so a run on a cluster is resumed as any other.
"""

from __future__ import annotations

import io
import tarfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any

from raycheck.errors import StartError
from raycheck.grading import archive
from raycheck.grading.one import RECORDS, STUDENTS, Asked, arrive, grade, standing
from raycheck.grading.submissions import Submission
from raycheck.sandbox import intake
from raycheck.workspace import workspace
from reports import grades
from reports.grades import Record

CONNECT = 20
"""Seconds to wait for a scheduler."""
_one = Lock()
"""A worker may have several threads; they would share this process's lanes, and each other's time."""


class Cluster:
    """The workers of an existing cluster, by the address of its scheduler."""

    def __init__(self, address: str) -> None:
        self.address = address

    def records(self, asked: Asked, submissions: Sequence[Submission], again: bool) -> Iterator[Record]:
        distributed = _library()
        try:
            client = distributed.Client(self.address, timeout=CONNECT)
        except (OSError, ValueError) as error:
            raise StartError(f"no cluster at {self.address}: {error}", "the address of a Dask scheduler") from None
        with client:
            tasks = []
            for submission in submissions:
                here = _here(asked, submission, again)
                if isinstance(here, Record):
                    yield here
                else:
                    tasks.append(client.submit(remote, asked, submission, here, pure=False))
            for _, (record, files) in distributed.as_completed(tasks, with_results=True):
                yield _kept(asked, record, files)


def _library() -> Any:
    try:
        import distributed
    except ImportError:
        raise StartError("dask.distributed is not installed", "pip install 'raycheck[cluster]'") from None
    return distributed


def _here(asked: Asked, submission: Submission, again: bool) -> Record | bytes:
    """What needs no worker: a record that stands, or a refusal; else the submission as the bytes of a tar."""
    with workspace() as folder:
        arrived = arrive(asked, submission, folder)
        if arrived.root is None:
            return grade(asked, submission, again)
        earlier = standing(asked, submission, arrived.key)
        return _tar(arrived.root) if again or earlier is None else earlier


def remote(asked: Asked, submission: Submission, sent: bytes) -> tuple[Record, bytes]:
    """On a worker: the record, and the student's folder as the bytes of a tar."""
    with _one, workspace() as folder:
        here = replace(asked, out=folder / "out")
        for name in (RECORDS, STUDENTS):
            (here.out / name).mkdir(parents=True)
        (folder / "sent.tar").write_bytes(sent)
        record = grade(here, replace(submission, path=folder / "sent.tar"))
        return record, _tar(here.out / STUDENTS / submission.slug)


def _kept(asked: Asked, record: Record, files: bytes) -> Record:
    """Put what a worker made in its place; the record last."""
    with workspace() as folder:
        (folder / "made.tar").write_bytes(files)
        archive.unpack(folder / "made.tar", folder / "made")
        student = asked.out / STUDENTS / record.slug
        intake.remove(student)
        intake.copy(folder / "made", student)
    grades.write(record, asked.out / RECORDS)
    return record


def _tar(folder: Path) -> bytes:
    made = io.BytesIO()
    with tarfile.open(fileobj=made, mode="w") as target:
        for path in sorted(folder.rglob("*")):
            target.add(path, path.relative_to(folder).as_posix(), recursive=False)
    return made.getvalue()
