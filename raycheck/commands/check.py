"""raycheck check: the conformance suite against a tracer."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

from raycheck import known, session
from raycheck.commands.options import command_line, size_of, subject_of
from raycheck.errors import UsageError
from raycheck.subjects import Subject, jailed
from raycheck.workspace import workspace
from scenes.catalogue import ladder


def run(options: Namespace) -> int:
    """Check, tell, and return the exit code."""
    with workspace() as folder:
        return _checked(options, jailed(subject_of(options), folder) if options.sandbox else subject_of(options))


def _checked(options: Namespace, subject: Subject) -> int:
    scenes = options.scenes.split(",") if options.scenes is not None else None
    if scenes == [""]:
        raise UsageError("--scenes is empty", "names from `raycheck scenes`, separated by commas")
    checks = {f"image/{rung.name}" for rung in ladder()}
    order = session.Order(
        subject=subject,
        scenes=scenes,
        size=size_of(options.size),
        out=Path(options.out),
        seed=options.seed,
        block=not options.no_block,
        known=known.load(Path(options.known) if options.known else None, checks),
        command=command_line(options),
        repeat=repeat_line(options),
    )
    found, code = session.check(order)
    session.tell(found, order.out)
    return code


def repeat_line(options: Namespace) -> str:
    """The call that asks one scene again; {scene} is filled in later."""
    words = ["check"]
    if options.subject is not None:
        words.append(options.subject)
    for name in ("scene", "image", "precision"):
        if getattr(options, name) is not None:
            words += [f"--{name}", getattr(options, name)]
    if options.size:
        words += ["--size", options.size]
    if options.seed:
        words += ["--seed", str(options.seed)]
    if options.known:
        words += ["--known", options.known]
    if options.sandbox:
        words.append("--sandbox")
    return session.repeat_line(words, ["--", *options.tracer] if options.tracer is not None else [])
