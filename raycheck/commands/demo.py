"""raycheck demo: the main job on what is bundled."""

from __future__ import annotations

import shlex
import shutil
from argparse import Namespace
from pathlib import Path

from raycheck import session
from raycheck.errors import BROKEN, CONFORMS, DIFFERS
from raycheck.examples import examples
from raycheck.known import Known
from raycheck.laws import LawPlan, all_laws
from raycheck.shrink import ShrinkPlan
from raycheck.subjects import attach

EXAMPLES = (("cpp_lecture", CONFORMS), ("cpp_slides", DIFFERS))
"""The good tracer and the wrong one, with the exit code each deserves."""


def run(options: Namespace) -> int:
    """Check both examples; 0 if each is judged as it deserves."""
    out = Path(options.out)
    deserved = True
    for name, expected in EXAMPLES:
        folder = _copied(name, out)
        order = session.Order(
            subject=attach(str(folder)),
            scenes=None,
            size=None,
            out=out / name,
            seed=0,
            block=False,  # so that every slip of the wrong one shows
            known=Known({}),
            command=f"raycheck check {shlex.quote(str(folder))} --no-block",
            repeat=session.repeat_line(["check", str(folder)], []),
            laws=LawPlan(
                all_laws(), block=False, repeat=session.repeat_line(["check", str(folder)], [], session.ONE_LAW)
            ),
            shrink=ShrinkPlan(session.repeat_line(["check", str(folder)], [])),
        )
        found, code = session.check(order)
        session.tell(found, order.out)
        print()
        if code not in (CONFORMS, DIFFERS):
            return code
        deserved &= code == expected
    return CONFORMS if deserved else BROKEN


def _copied(name: str, out: Path) -> Path:
    """A copy of an example tracer beside the reports: built there, and at hand for reading and mending."""
    session.make_folder(out)
    folder = out / "tracers" / name
    shutil.copytree(examples() / name, folder, dirs_exist_ok=True, ignore=shutil.ignore_patterns("tracer"))
    return folder
