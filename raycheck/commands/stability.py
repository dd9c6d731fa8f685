"""raycheck stability: where methods fail, and where a tracer's do."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from oracles.measurement import Precision
from oracles.stability import cases, depths, frontiers, maps, starts
from oracles.stability.probe import RefractProbe, SphereProbe, refract_methods, sphere_methods
from raycheck import VERSION
from raycheck.commands.options import command_line
from raycheck.errors import CONFORMS, StartError, UsageError
from raycheck.machine import machine
from raycheck.progress import Progress
from raycheck.session import make_folder
from raycheck.subjects.attach import attach
from raycheck.subjects.inprocess import PythonSubject
from reports import stability
from reports.measured import number

PRECISIONS: tuple[Precision, ...] = ("float32", "float64")
STEPS = 18


@dataclass(frozen=True)
class Asked:
    """A stranger's answers: what it can be asked."""

    sphere: tuple[SphereProbe, ...] = ()
    refract: tuple[RefractProbe, ...] = ()


@dataclass(frozen=True)
class ArrayProbe:
    """An object of this process with `sphere` or `refract` on arrays."""

    name: str
    precision: Precision
    tracer: Any

    def sphere(self, o: Any, v: Any, c: Any, r: Any) -> Any:
        return self._answer("sphere", (len(r),), o, v, c, r)

    def refract(self, v: Any, n: Any, index: Any) -> Any:
        return self._answer("refract", (len(index), 3), v, n, index)

    def _answer(self, operation: str, shape: tuple[int, ...], *inputs: Any) -> Any:
        """What the object gives, as reals of this shape; StartError for anything else."""
        try:
            # copies: it may write into what it is given
            found = np.asarray(getattr(self.tracer, operation)(*(a.copy() for a in inputs)), dtype=np.float64)
        except (Exception, SystemExit) as error:  # a stranger's code
            raise StartError(f"{self.name}.{operation}: {type(error).__name__}: {error}") from None
        if found.shape != shape:
            raise StartError(f"{self.name}.{operation} gives an array of shape {found.shape}", f"{shape} is expected")
        return found


def run(options: Namespace) -> int:
    """Measure, write, tell."""
    asked = probes_of(options.subject, options.precision or "float32")
    folder = Path(options.out)
    make_folder(folder)
    found = measure(asked, options.subject, options.seed, command_line(options))
    path = stability.write(found, folder)
    for line in stability.sentences(found):
        print(line)
    for question in found.questions:
        print(f"\n{question.title} ({question.unit})")
        for f in (f for f in found.frontiers if f.question == question.name):
            bound = "beyond " if f.open else ""
            print(f"  {f.method:<16}{f.precision}  {bound}{number(f.reach):<12} law {number(f.predicted)}")
    print(f"report: {path}")
    return CONFORMS


def probes_of(spec: str | None, precision: Precision) -> Asked:
    """What a SUBJECT can be asked; one that answers about neither spheres nor refraction is refused."""
    if spec is None:
        return Asked()
    subject = attach(spec, precision)
    if not isinstance(subject, PythonSubject):
        raise UsageError(f"{spec} answers no single rays yet", "python:module:attr with sphere(o, v, c, r) on arrays")
    subject.prepare()
    probe = ArrayProbe(subject.name, precision, subject.tracer)
    asked = Asked(
        (probe,) if hasattr(subject.tracer, "sphere") else (),
        (probe,) if hasattr(subject.tracer, "refract") else (),
    )
    if not (asked.sphere or asked.refract):
        raise UsageError(f"{spec} has neither sphere nor refract", "methods on arrays, see docs/stability.md")
    return asked


def measure(asked: Asked, name: str | None, seed: int, command: str) -> stability.Stability:
    """All maps, frontiers, offsets, depths and cases."""
    begin = time.monotonic()
    started = datetime.now(UTC).isoformat(timespec="seconds")
    progress = Progress("measuring stability", STEPS)
    rng = np.random.default_rng(seed)
    experiments, reached = [], []
    for precision in PRECISIONS:
        spheres: Sequence[SphereProbe] = [*_of(asked.sphere, precision), *sphere_methods(precision)]
        bends: Sequence[RefractProbe] = [*_of(asked.refract, precision), *refract_methods(precision)]
        for sphere_map in (maps.distance_map, maps.height_map, maps.world_map):
            experiments.append(sphere_map(spheres, precision, rng))
            progress.step(f"{experiments[-1].title}, {precision}")
        for refract_map in (maps.normal_map, maps.critical_map):
            experiments.append(refract_map(bends, precision, rng))
            progress.step(f"{experiments[-1].title}, {precision}")
        reached += frontiers.sphere_frontiers(spheres, precision, rng)
        reached += frontiers.refract_frontiers(bends, precision, rng)
        progress.step(f"frontiers, {precision}")
    offsets = tuple(starts.starts(rng))
    progress.step("start offsets")
    by_depth = tuple(depths.depths())
    progress.step("depth")
    named = tuple(cases.cases(asked.sphere, asked.refract))
    progress.close()
    return stability.Stability(
        suite=VERSION,
        subject=name,
        machine=machine(),
        started=started,
        command=command,
        seed=seed,
        seconds=time.monotonic() - begin,
        questions=frontiers.QUESTIONS,
        frontiers=tuple(reached),
        experiments=tuple(experiments),
        starts=offsets,
        gaps=starts.GAPS,
        depths=by_depth,
        depth_scene=depths.SCENE,
        cases=named,
    )


def _of(probes: Sequence[Any], precision: Precision) -> list[Any]:
    return [probe for probe in probes if probe.precision == precision]
