"""raycheck check: the conformance suite against a tracer."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Sequence
from pathlib import Path

from raycheck import known, session
from raycheck.commands.options import command_line, size_of, subject_of
from raycheck.errors import UsageError
from raycheck.laws import LawPlan, all_laws, check_names, chosen
from raycheck.laws.plan import AnyLaw
from raycheck.shrink import NO_SHRINKING, ShrinkPlan
from raycheck.subjects import Subject, jailed
from raycheck.workspace import workspace
from scenes.catalogue import ladder


def run(options: Namespace) -> int:
    """Check, tell, and return the exit code."""
    with workspace() as folder:
        return _checked(options, jailed(subject_of(options), folder) if options.sandbox else subject_of(options))


def _checked(options: Namespace, subject: Subject) -> int:
    scenes = _names(options.scenes, "--scenes", "names from `raycheck scenes`, separated by commas")
    laws = _names(options.laws, "--laws", "names from docs/laws.md, separated by commas")
    if laws is not None and scenes is None:
        scenes = []
    if options.explore < 0:
        raise UsageError(f"--explore {options.explore}: not a number of cases", "0 or more")
    checks = {f"image/{rung.name}" for rung in ladder()} | check_names()
    known_failures = known.load(Path(options.known), checks) if options.known else known.shipped(subject.spec, checks)
    order = session.Order(
        subject=subject,
        scenes=scenes,
        size=size_of(options.size),
        out=Path(options.out),
        seed=options.seed,
        block=not options.no_block,
        known=known_failures,
        command=command_line(options),
        repeat=repeat_line(options),
        laws=LawPlan(
            _laws(laws, options.scenes),
            named=laws is not None,
            seed=options.seed,
            explore=options.explore,
            block=not options.no_block,
            known=known_failures,
            repeat=repeat_line(options, session.ONE_LAW),
        ),
        shrink=NO_SHRINKING if options.no_shrink else ShrinkPlan(repeat_line(options, size="")),
    )
    found, code = session.check(order)
    session.tell(found, order.out)
    return code


def _names(text: str | None, option: str, hint: str) -> list[str] | None:
    """The names of a list with commas; None where the option is not given."""
    if text is None:
        return None
    if not text:
        raise UsageError(f"{option} is empty", hint)
    return text.split(",")


def _laws(names: list[str] | None, scenes: str | None) -> Sequence[AnyLaw]:
    """The laws of these names; without names all, but none where only scenes are named."""
    if names is not None:
        return chosen(names)
    return all_laws() if scenes is None else ()


def repeat_line(options: Namespace, asked: str = session.ONE_SCENE, size: str | None = None) -> str:
    """The call that asks one scene or one law again, at the same or another size; its name is filled in later."""
    size = options.size if size is None else size
    words = ["check"]
    if options.subject is not None:
        words.append(options.subject)
    for name in ("scene", "image", "precision"):
        if getattr(options, name) is not None:
            words += [f"--{name}", getattr(options, name)]
    for word in options.dialect or ():
        words += ["--dialect", word]
    if size:
        words += ["--size", size]
    if options.seed:
        words += ["--seed", str(options.seed)]
    if options.known:
        words += ["--known", options.known]
    if options.explore and asked == session.ONE_LAW:
        words += ["--explore", str(options.explore)]
    if options.sandbox:
        words.append("--sandbox")
    return session.repeat_line(words, ["--", *options.tracer] if options.tracer is not None else [], asked)
