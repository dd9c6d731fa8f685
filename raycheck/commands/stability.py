"""raycheck stability: where methods fail, and where a tracer's do."""

from __future__ import annotations

import time
from argparse import Namespace
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from oracles.laws import NoAnswerError
from oracles.measurement import Precision
from oracles.stability import cases, depths, frontiers, maps, starts
from oracles.stability.probe import RefractProbe, SphereProbe, refract_methods, sphere_methods
from raycheck import VERSION
from raycheck.commands.options import command_line
from raycheck.errors import CONFORMS, StartError, UsageError
from raycheck.machine import machine
from raycheck.probes import prober_of
from raycheck.probes.arrays import ArrayProbe
from raycheck.progress import Progress
from raycheck.session import make_folder
from raycheck.subjects.attach import attach
from reports import stability
from reports.measured import number

PRECISIONS: tuple[Precision, ...] = ("float32", "float64")
STEPS = 18
WAYS = "a probe in raycheck.toml, or methods on arrays, see docs/stability.md"


@dataclass(frozen=True)
class Asked:
    """A stranger's answers: what it can be asked."""

    sphere: tuple[SphereProbe, ...] = ()
    refract: tuple[RefractProbe, ...] = ()


def run(options: Namespace) -> int:
    """Measure, write, tell."""
    with ExitStack() as held:
        asked = probes_of(options.subject, options.precision, held)
        folder = Path(options.out)
        make_folder(folder)
        found = measure(asked, options.subject, options.seed, command_line(options))
    path = stability.write(found, folder)
    for line in stability.sentences(found):
        print(line)
    wide = max(16, *(len(f.method) + 2 for f in found.frontiers))
    for question in found.questions:
        print(f"\n{question.title} ({question.unit})")
        for f in (f for f in found.frontiers if f.question == question.name):
            bound = "beyond " if f.open else ""
            print(f"  {f.method:<{wide}}{f.precision}  {bound}{number(f.reach):<12} law {number(f.predicted)}")
    print(f"report: {path}")
    return CONFORMS


def probes_of(spec: str | None, precision: Precision | None, held: ExitStack) -> Asked:
    """What a SUBJECT can be asked until `held` closes; one that answers nothing of it is refused."""
    if spec is None:
        return Asked()
    if precision is not None and not spec.startswith("python:"):
        raise UsageError(f"--precision {precision} does not go with {spec}", "SUBJECT or its raycheck.toml says it")
    subject = attach(spec, precision or "float32")
    subject.prepare()
    prober = prober_of(subject)
    if prober is None:
        raise UsageError(f"{spec} answers neither sphere nor refract", WAYS)
    held.callback(prober.close)
    try:
        operations = prober.open()
    except NoAnswerError as error:
        raise StartError(f"{spec}: {error}") from None
    probe = ArrayProbe(spec, "float64" if subject.precision == "float64" else "float32", prober)
    asked = Asked((probe,) if "sphere" in operations else (), (probe,) if "refract" in operations else ())
    if not (asked.sphere or asked.refract):
        raise UsageError(f"{spec} answers neither sphere nor refract", WAYS)
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
