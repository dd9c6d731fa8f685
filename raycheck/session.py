"""One check from the command line to the report: nothing is lost on the way."""

from __future__ import annotations

import contextlib
import shlex
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from oracles.verdict import Diagnosis, Verdict
from raycheck import VERSION
from raycheck.diagnosis import diagnosed
from raycheck.errors import CONFORMS, DIFFERS, INTERRUPTED, UsageError
from raycheck.filed import filed, is_file
from raycheck.known import Known
from raycheck.laws import LawPlan, judge_laws
from raycheck.machine import machine
from raycheck.progress import Progress
from raycheck.shrink import NO_SHRINKING, ShrinkPlan, make_room, shrunk
from raycheck.subjects import Subject
from raycheck.suite import Hearing, Plan
from reports import junit, page, results, summary
from scenes.catalogue import Rung, catalogue_hash, ladder, rung

ONE_SCENE, ONE_LAW = "--scenes {scene}", "--laws {law}"
"""Options that ask one check again."""
NO_LAWS = LawPlan()
WRITABLE = "a folder that can be written, with --out DIR"


@dataclass(frozen=True)
class Order:
    """What the user wants checked."""

    subject: Subject
    scenes: Sequence[str] | None
    size: tuple[int, int] | None
    out: Path
    seed: int
    block: bool
    known: Known
    command: str
    repeat: str
    laws: LawPlan = NO_LAWS
    shrink: ShrinkPlan = NO_SHRINKING


def check(order: Order) -> tuple[results.Results, int]:
    """Run the suite, write the report, return the results and the exit code."""
    begin = time.monotonic()
    started = datetime.now(UTC).isoformat(timespec="seconds")
    plan = Plan(chosen(order.scenes), order.size, order.seed, order.block, order.known, order.repeat)
    _make_room(order.out)
    make_room(order.out, plan.rungs)
    order.subject.prepare()
    verdicts: list[Verdict] = []
    diagnosis: Diagnosis | None = None
    complete = False
    progress = Progress(f"checking {order.subject.name}", _planned(order, plan))
    try:
        hearing = Hearing(order.subject, plan, order.out)
        for verdict in hearing.verdicts():
            verdicts.append(verdict)
            progress.step(verdict.check)
        verdicts = hearing.reconsidered(verdicts, progress.say)
        for verdict in judge_laws(order.subject, order.laws, hearing.convention, tuple(verdicts), order.out):
            verdicts.append(verdict)
            progress.step(verdict.check)
        complete = True  # what follows explains; an interrupt loses no verdict
        diagnosis = diagnosed(hearing, verdicts, order.out, progress.say)
        for place, verdict in shrunk(hearing, order.shrink, tuple(verdicts), order.out, progress.say):
            verdicts[place] = verdict
    except KeyboardInterrupt:
        print("\ninterrupted: writing what there is", file=sys.stderr)
    except Exception:
        if verdicts:
            write(_results(order, plan, verdicts, None, False, started, begin), order.out)
        raise
    finally:
        progress.close()
    found = _results(order, plan, verdicts, diagnosis, complete, started, begin)
    write(found, order.out)
    if not complete:
        return found, INTERRUPTED
    return found, CONFORMS if found.conforms else DIFFERS


def _planned(order: Order, plan: Plan) -> int:
    return len(plan.rungs) + order.laws.planned(order.subject)


def _results(
    order: Order,
    plan: Plan,
    verdicts: Sequence[Verdict],
    diagnosis: Diagnosis | None,
    complete: bool,
    started: str,
    begin: float,
) -> results.Results:
    return results.Results(
        suite=results.Suite(version=VERSION, catalogue=catalogue_hash()),
        subject=described(order.subject),
        machine=machine(),
        started=started,
        command=order.command,
        seed=order.seed,
        size=f"{order.size[0]}x{order.size[1]}" if order.size else None,
        seconds=time.monotonic() - begin,
        planned=_planned(order, plan),
        verdicts=tuple(verdicts),
        diagnosis=diagnosis,
        complete=complete,
    )


def write(found: results.Results, folder: Path) -> Path:
    """results.json first, then what is made from it; return the page's path; raise UsageError if that cannot be."""
    try:
        results.write(found, folder)
        junit.write(found, folder)
        return page.write(found, folder)
    except OSError as error:
        raise UsageError(f"the report cannot be written: {error}", WRITABLE) from None


def deliver(write: Callable[[], object], lines: Iterable[str], path: Path) -> None:
    """Write a page, print these lines and where it is; raise UsageError if it cannot be written."""
    try:
        write()
    except OSError as error:
        raise UsageError(f"the report cannot be written: {error}", WRITABLE) from None
    for line in lines:
        print(line)
    print(f"report: {path}")


def tell(found: results.Results, folder: Path) -> None:
    """The summary on stdout; a reader who has gone does not change the verdict."""
    with contextlib.suppress(BrokenPipeError):
        for line in summary.lines(found):
            print(line)
        print(f"report: {folder / 'index.html'}")


def repeat_line(words: Sequence[str], tail: Sequence[str], asked: str = ONE_SCENE) -> str:
    """The call `raycheck words --scenes {scene} tail`; the name is filled in by format, braces are doubled."""
    before, after = (shlex.join(part).replace("{", "{{").replace("}", "}}") for part in (words, tail))
    return f"raycheck {before} {asked} {after}".rstrip()


def chosen(names: Sequence[str] | None) -> list[Rung]:
    """The rungs of these names in the ladder's order, then those of these scene files; all rungs without names."""
    if names is None:
        return list(ladder())
    wanted = {rung(name).name for name in names if not is_file(name)}
    found = [entry for entry in ladder() if entry.name in wanted]
    for name in dict.fromkeys(filter(is_file, names)):
        found.append(filed(name))
        if any(entry.name == found[-1].name for entry in found[:-1]):
            raise UsageError(f"{name}: another scene is called {found[-1].name}, too", "one scene of a name")
    return found


def make_folder(folder: Path) -> None:
    """Create the report's folder; raise UsageError if that cannot be."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):  # a name of its own: other processes may try the same folder
            pass
    except OSError as error:
        raise UsageError(f"{folder}: {error.strerror}", WRITABLE) from None


def _make_room(folder: Path) -> None:
    """The folders of a report, an older report gone; raise UsageError if something stands where it goes."""
    for part in (folder, folder / "images"):
        make_folder(part)
    for name in (results.FILE, junit.FILE, page.FILE):
        if (folder / name).is_dir():
            raise UsageError(f"{folder / name}: a folder is in the way of the report", WRITABLE)
        (folder / name).unlink(missing_ok=True)


def described(subject: Subject) -> results.Subject:
    return results.Subject(
        name=subject.name,
        spec=subject.spec,
        precision=subject.precision,
        scene=subject.scene_form,
        image=subject.image_form,
        features=subject.features,
    )
