"""Who grades: this process, or several beside it. Each submission's record is written by who graded it."""

from __future__ import annotations

import contextlib
import ctypes
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import Protocol

from raycheck.errors import RaycheckError
from raycheck.grading.one import Asked, grade
from raycheck.grading.submissions import Submission
from reports.grades import Record

ATTEMPTS = 3
"""Times that a submission is given to a worker that dies."""
PR_SET_PDEATHSIG = 1  # linux/prctl.h


class Pool(Protocol):
    """Grades submissions; yields each record as it is done, in any order."""

    def records(self, asked: Asked, submissions: Sequence[Submission], again: bool) -> Iterator[Record]: ...


class Here:
    """One after the other, in this process."""

    def records(self, asked: Asked, submissions: Sequence[Submission], again: bool) -> Iterator[Record]:
        for submission in submissions:
            yield grade(asked, submission, again)


class Processes:
    """Several processes; what a lost one had is given to others."""

    def __init__(self, jobs: int, task: Callable[[Asked, Submission, bool], Record] = grade) -> None:
        self.jobs, self.task = jobs, task

    def records(self, asked: Asked, submissions: Sequence[Submission], again: bool) -> Iterator[Record]:
        left = {submission.slug: submission for submission in submissions}
        for _ in range(ATTEMPTS):
            with contextlib.suppress(BrokenProcessPool):
                for record in self._round(asked, list(left.values()), again):
                    del left[record.slug]
                    yield record
            if not left:
                return
        names = ", ".join(submission.name for submission in left.values())
        raise RaycheckError(f"workers died {ATTEMPTS} times; not graded: {names:.500}", "more memory, or fewer --jobs")

    def _round(self, asked: Asked, submissions: Sequence[Submission], again: bool) -> Iterator[Record]:
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(self.jobs, context, _end_with, (os.getpid(),)) as pool:
            try:
                futures = [pool.submit(self.task, asked, submission, again) for submission in submissions]
                for future in as_completed(futures):
                    yield future.result()
            except BaseException:
                pool.shutdown(wait=True, cancel_futures=True)
                raise


def _end_with(parent: int) -> None:
    """A worker ends with the process that started it, also where that is killed; Ctrl-C is the parent's to handle."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    if sys.platform == "linux":
        with contextlib.suppress(OSError, AttributeError):
            ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        if os.getppid() != parent:  # it was killed before we asked to be told
            os._exit(1)
