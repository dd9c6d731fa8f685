"""`pytest --raycheck-subject SUBJECT`: every check and every law is a test of its own.

Loaded in every pytest run where raycheck is installed, so nothing but pytest is imported until the option is given.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from oracles.verdict import Verdict
    from raycheck.subjects import Subject

NODE = "raycheck"
"""Ids are raycheck::image/NAME and raycheck::law/NAME."""


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options, as those of `raycheck check`."""
    group = parser.getgroup("raycheck", "conformance of a ray tracer")
    group.addoption("--raycheck-subject", metavar="SUBJECT", help="the tracer, as `raycheck check SUBJECT` takes it")
    group.addoption("--raycheck-precision", choices=("float32", "float64"), default="float32", help="of Python objects")
    group.addoption("--raycheck-scenes", metavar="A,B", help="only these scenes, and no laws")
    group.addoption("--raycheck-laws", metavar="A,B", help="only these laws or groups of laws")
    group.addoption("--raycheck-size", metavar="WxH", help="picture size instead of each scene's own")
    group.addoption("--raycheck-seed", type=int, default=0, metavar="N", help="as --seed (%(default)s)")
    group.addoption("--raycheck-explore", type=int, default=0, metavar="N", help="N more cases of each law")
    group.addoption("--raycheck-known", metavar="FILE", help="known failures, which are expected to fail")
    group.addoption(
        "--raycheck-out", default="raycheck-report", metavar="DIR", help="pictures and scenes (%(default)s)"
    )


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(session: pytest.Session, config: pytest.Config, items: list[pytest.Item]) -> None:
    """Add the checks before -k and others choose among the tests."""
    if config.getoption("raycheck_subject") is None:
        return
    from raycheck.errors import RaycheckError
    from scenes.errors import SceneError

    try:
        items.extend(Tracer.from_parent(session, name=NODE, nodeid=NODE).collect())
    except (RaycheckError, SceneError) as error:
        raise pytest.UsageError(f"raycheck: {error}") from None


class Tracer(pytest.Collector):
    """The subject; its children are the checks."""

    def collect(self) -> Iterator[Check]:
        """One item a check, in the order of `raycheck check`."""
        from raycheck.attached import Attached

        attached = Attached.of(self.config)
        for name, ask in attached.checks():
            yield Check.from_parent(self, name=name, attached=attached, ask=ask)


class Check(pytest.Item):
    """One check: fails as its verdict does, with the lines that run it again."""

    def __init__(self, *, attached: Any, ask: Callable[[], Verdict], **settings: Any) -> None:
        super().__init__(**settings)
        self.attached, self.ask = attached, ask

    def runtest(self) -> None:
        """Ask; skip what cannot tell, expect what is known to fail."""
        from oracles.verdict import CONFORMING
        from raycheck.errors import StartError

        try:
            subject: Subject = self.attached.prepared()
        except StartError as error:
            pytest.exit(f"raycheck: {error}", returncode=error.code)
        self.user_properties.append(("subject", subject.name))
        verdict = self.ask()
        if verdict.verdict in ("unsupported", "undecided", "blocked"):
            pytest.skip(f"{verdict.verdict}: {verdict.message}")
        if verdict.verdict == "known":
            pytest.xfail(verdict.message)
        if verdict.verdict not in CONFORMING:
            raise FailedCheckError(verdict)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The verdict in plain lines instead of a traceback through raycheck."""
        if isinstance(excinfo.value, FailedCheckError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, None, str]:
        """Where a failure is told to be."""
        return self.config.rootpath / NODE, None, self.name


class FailedCheckError(Exception):
    """A check that does not conform."""

    def __init__(self, verdict: Verdict) -> None:
        super().__init__(verdict)
        self.verdict = verdict

    def __str__(self) -> str:
        from reports import plain

        v = self.verdict
        lines = [
            f"{v.verdict}: {plain.paragraph(v.message)}",
            f"teaches: {v.teaches}",
            f"slide: {v.slide}: {v.formula}",
        ]
        if v.case and v.case.run:
            lines.append(f"this case: {plain.command(v.case.run)}")
        lines.append(f"run again: {plain.command(v.reproduce)}")
        return "\n".join(line for line in lines if not line.endswith(": "))
