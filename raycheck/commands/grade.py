"""raycheck grade: a class of submissions, scored by a rubric."""

from __future__ import annotations

import sys
from argparse import Namespace
from pathlib import Path

from raycheck.errors import CONFORMS, UsageError
from raycheck.grading import adjust, bundle, rubric
from raycheck.grading.cluster import Cluster
from raycheck.grading.one import record_path
from raycheck.grading.pool import Here, Pool, Processes
from raycheck.grading.run import Order, grade_class
from raycheck.grading.submissions import found
from raycheck.sandbox import OPEN, Jail, Room
from raycheck.sandbox.limits import Limits
from reports import grades
from reports.classroom import CSV


def run(options: Namespace) -> int:
    """Grade, and tell where the results are; or explain one score."""
    asked = rubric.load(Path(options.rubric) if options.rubric else None)
    if options.gradescope_bundle is not None:
        return _bundle(options)
    if options.submissions is None:
        raise UsageError("no SUBMISSIONS are given", "a folder with one folder or archive a submission")
    submissions = found(Path(options.submissions))
    names = {submission.name for submission in submissions}
    if options.jobs < 1:
        raise UsageError(f"--jobs {options.jobs}: not a number of processes", "1 or more")
    order = Order(
        submissions=submissions,
        rubric=asked,
        adjustments=adjust.load(Path(options.adjust) if options.adjust else None, names),
        out=Path(options.out),
        seed=options.seed,
        room=_room(options, asked.limits),
        pool=_pool(options),
        only=options.only.split(",") if options.only is not None else None,
        again=options.rerun_failed,
    )
    if options.explain is not None:
        return _explain(order, options.explain)
    graded = grade_class(order)
    for entry in graded:
        print(
            f"{entry.score:6g} of {entry.record.points:g}  {grades.WORDS[entry.record.outcome]:>8}  {entry.record.name}"
        )
    print(f"grades: {order.out / CSV}\nclass: {order.out / 'index.html'}")
    return CONFORMS


def _bundle(options: Namespace) -> int:
    """A Gradescope autograder in place of grades."""
    path = Path(options.gradescope_bundle)
    text = Path(options.rubric).read_text("utf-8") if options.rubric else rubric.default()
    try:
        bundle.write(path, text, options.i_trust_this_code)
    except OSError as error:
        raise UsageError(f"{path}: {error.strerror}", "a file that can be written") from None
    print(path)
    return CONFORMS


def _room(options: Namespace, limits: Limits) -> Room:
    """A jail, or none where the caller vouches for the code."""
    if options.i_trust_this_code:
        print("raycheck: no sandbox: the submissions run with your rights", file=sys.stderr)
        return OPEN
    return Jail(limits)


def _pool(options: Namespace) -> Pool:
    if options.cluster is not None:
        return Cluster(options.cluster)
    return Processes(options.jobs) if options.jobs > 1 else Here()


def _explain(order: Order, name: str) -> int:
    """One score, line by line, from the record of an earlier run."""
    for submission in order.submissions:
        if submission.name == name:
            record = grades.read(record_path(order.out, submission))
            if record is None:
                raise UsageError(f"--explain {name}: not graded yet", f"raycheck grade ... --only {name}")
            graded = grades.Graded(record=record, adjustments=order.adjustments.get(name, ()))
            print("\n".join(grades.explanation(graded)))
            return CONFORMS
    raise UsageError(f"--explain {name}: no such submission", f"for example {order.submissions[0].name}")
