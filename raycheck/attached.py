"""A subject with every check as a question of its own, for test runners that ask them one at a time."""

from __future__ import annotations

import fcntl
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from oracles.conventions import Convention
from oracles.laws import Law
from oracles.verdict import Verdict
from raycheck import known, session
from raycheck.commands.options import size_of
from raycheck.laws import LawPlan, all_laws, check_names, chosen, judge_laws
from raycheck.laws.plan import HELLO, AnyLaw
from raycheck.subjects import Subject, attach
from raycheck.suite import Hearing, Plan
from scenes.catalogue import Rung, ladder


@dataclass(frozen=True)
class Attached:
    """A subject and what is asked of it: rungs, laws, and where pictures and scenes go."""

    subject: Subject
    plan: Plan
    laws: LawPlan
    out: Path

    @classmethod
    def of(cls, config: Any) -> Attached:
        """From the options of pytest."""

        def option(name: str) -> Any:
            return config.getoption(f"raycheck_{name}")

        scenes, laws = (option(name).split(",") if option(name) else None for name in ("scenes", "laws"))
        subject = attach(option("subject"), option("precision"))
        if subject.in_process:
            subject.prepare()  # what it can be asked is known only then
        checks = {f"image/{rung.name}" for rung in ladder()} | check_names()
        failures = known.load(Path(option("known")) if option("known") else None, checks)
        rungs = session.chosen([] if laws is not None and scenes is None else scenes)
        words = ["check", option("subject")] + (["--seed", str(option("seed"))] if option("seed") else [])
        book = all_laws() if laws is None and scenes is None else chosen(laws or [])
        one_scene, one_law = (session.repeat_line(words, [], asked) for asked in (session.ONE_SCENE, session.ONE_LAW))
        plan = Plan(rungs, size_of(option("size")), option("seed"), False, failures, one_scene)
        more = LawPlan(book, laws is not None, option("seed"), option("explore"), False, failures, one_law)
        return cls(subject, plan, more, Path(option("out")))

    def checks(self) -> Iterator[tuple[str, Callable[[], Verdict]]]:
        """Each check's name and the question."""
        for rung in self.plan.rungs:
            yield f"image/{rung.name}", partial(self.image, rung)
        asked = self.laws.asked(self.subject)
        formulas = [law for law in asked if isinstance(law, Law)]
        if len(asked) < self.laws.planned(self.subject):
            yield HELLO, partial(self.law, formulas[0], HELLO)
        for law in asked:
            yield f"law/{law.name}", partial(self.law, law, f"law/{law.name}")

    def image(self, rung: Rung) -> Verdict:
        """The verdict on one rung."""
        (verdict,) = Hearing(self.subject, replace(self.plan, rungs=[rung]), self.out).verdicts()
        return verdict

    def law(self, law: AnyLaw, name: str) -> Verdict:
        """The verdict of that name that asking one law gives."""
        plan = replace(self.laws, laws=[law], named=True)
        return next(
            v for v in judge_laws(self.subject, plan, Convention(self.subject.dialect), (), self.out) if v.check == name
        )

    def prepared(self) -> Subject:
        """The subject, built once; raise StartError where that fails."""
        return self._built

    @cached_property
    def _built(self) -> Subject:
        """Built under a lock: several test processes may share one folder."""
        session.make_folder(self.out)
        with (self.out / ".raycheck-build").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not self.subject.in_process:
                self.subject.prepare()
        return self.subject
