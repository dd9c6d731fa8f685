"""The laws on correct tracers and on wrong ones, as tables.

    python benchmarks/laws_table.py [--seeds N] [--cases N]

First the worst excess of each law over N seeds in every number type of the reference tracer and on
examples/cpp_lecture (built where a compiler is): nothing may exceed 1. Then which laws catch which wrong formula of
the reference tracer, and what they catch in examples/cpp_slides.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from oracles.laws import Ask, Law, NoAnswerError, formula_laws
from oracles.laws.cases import reading
from oracles.laws.dice import seeded
from oracles.laws.pictures import Sight, picture_laws, sight
from oracles.truth import truth
from raycheck.lanes import best_lanes
from raycheck.manifest import FEATURES
from raycheck.probes import prober_of
from raycheck.subjects import Subject, attach
from reference_tracer.numbers import at_least, sqrt0
from reference_tracer.operations import formulas
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec, dot, unit
from scenes.model import Scene

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def far_root(b: Vec, bv: Any, v: Vec, r: Any) -> tuple[Any, Any, Any]:
    """The far root of a sphere instead of the near one."""
    _, far, D = LECTURE.sphere_distances(b, bv, v, r)
    return far, far, D


def leaving_as_entering(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
    """The slide's leaving ray: the ratio is not inverted."""
    return LECTURE.refract(v, n, at_least(-1.0, index), index)


def inverted_ratio(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
    """The inverted ratio n1/n2 for n2/n1."""
    return LECTURE.refract(v, n, leaving, 1.0 / index)


def tangent_kept(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
    """The index scales the normal part instead of the tangent."""
    p = n * -dot(v, n) + v
    t = p - n * (sqrt0(1.0 - dot(p, p)) * index)
    return unit(t), at_least(dot(p, p), 2.0)


def even_power(i: Vec, n: Vec, v: Vec, s: Any, mirrored: Vec) -> Any:
    """r∘(-v) not clamped below, as under an even power: bright also opposite the mirror direction."""
    x = dot(mirrored, v)
    return LECTURE.phong(i, n, v, s, mirrored) + LECTURE.phong(i, n, -v, s, mirrored) * at_least(x, 0.0)


WRONG: dict[str, Rulebook] = {
    "far root": replace(LECTURE, sphere_distances=far_root),
    "radius of the square": replace(
        LECTURE, sphere_distances=lambda b, bv, v, r: LECTURE.sphere_distances(b, bv, v, r * r)
    ),
    "no factor 2 in the normal's part": replace(LECTURE, reflect=lambda i, n: n * dot(i, n) - i),
    "2n - i": replace(LECTURE, reflect=lambda i, n: unit(n * 2.0 - i)),
    "index not inverted on leaving": replace(LECTURE, refract=leaving_as_entering),
    "index inverted": replace(LECTURE, refract=inverted_ratio),
    "tangent kept": replace(LECTURE, refract=tangent_kept),
    "normal inward": replace(LECTURE, sphere_normal=lambda p, c: unit(c - p)),
    "normal not unit": replace(LECTURE, sphere_normal=lambda p, c: p - c),
    "cosine not clamped": replace(LECTURE, lambert=dot),
    "even power not clamped": replace(LECTURE, phong=even_power),
    "camera rays not unit": replace(LECTURE, camera_ray=lambda f, r, u, X, Y: (f + r * X) + u * Y),
    "y up in the picture": replace(LECTURE, camera_ray=lambda f, r, u, X, Y: LECTURE.camera_ray(f, r, u, X, -Y)),
}
"""Faults of one formula each."""


def worst(law: Law, ask: Ask, precision: str, seeds: range, cases: int) -> float:
    """The largest excess of a law over these seeds; infinite where the tracer gives no answer."""
    found = 0.0
    for seed in seeds:
        try:
            found = max(found, float(reading(law, seeded(cases, precision, seed), ask).excess().max()))
        except NoAnswerError:
            return float("inf")
    return found


@contextmanager
def example(name: str) -> Iterator[Subject | None]:
    """A built copy of an example; None where no compiler is."""
    if not (shutil.which("make") and shutil.which("g++")):
        yield None
        return
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / name
        shutil.copytree(EXAMPLES / name, copy, ignore=shutil.ignore_patterns("tracer"))
        subject = attach(str(copy))
        subject.prepare()
        yield subject


class Studio:
    """A subject as the laws of pictures see it."""

    def __init__(self, subject: Subject) -> None:
        self.subject = subject
        self.features = frozenset(subject.features if subject.features is not None else FEATURES)

    def show(self, scene: Scene) -> Sight:
        """Render a scene."""
        attempt = self.subject.render(scene, 0)
        if attempt.picture is None:
            raise NoAnswerError(attempt.word or "invalid", attempt.message)
        return sight(attempt.picture, truth(scene, self.subject.precision, best_lanes()))


def correct(seeds: range, cases: int) -> int:
    """Print the table of correct tracers; return the number of false alarms."""
    kinds = [("plain", "64"), ("numpy", "32"), ("numpy", "64")]
    if best_lanes() == "drjit":
        kinds += [("drjit", "32"), ("drjit", "64")]
    columns: dict[str, tuple[Callable[..., Any], str, Subject]] = {}
    with example("cpp_lecture") as cpp:
        for kind, bits in kinds:
            subject = attach(f"builtin:reference/{kind}" + (f"/{bits}" if kind != "plain" else ""))
            columns[f"{kind}{bits}"] = (formulas(kind, int(bits)), f"float{bits}", subject)
        if cpp is not None:
            prober = prober_of(cpp)
            assert prober is not None
            columns["C++"] = (prober, cpp.precision, cpp)
        print(f"worst excess over {len(seeds)} seeds of {cases} cases (plain: a tenth); over 1 is a false alarm")
        print(f"{'law':30}" + "".join(f"{name:>10}" for name in columns))
        alarms = 0
        for law in formula_laws():
            row = [
                worst(law, ask, precision, seeds, cases // 10 if name == "plain64" else cases)
                for name, (ask, precision, _) in columns.items()
            ]
            alarms += sum(value > 1.0 for value in row)
            print(f"{law.name:30}" + "".join(f"{value:10.2g}" for value in row), flush=True)
        for picture in picture_laws():
            row = []
            for name, (_, precision, subject) in columns.items():
                some = seeds[:1] if name == "plain64" else seeds
                excess = [picture.test(seeded(1, precision, seed), Studio(subject)).excess().max() for seed in some]
                row.append(float(max(excess)))
            alarms += sum(value > 1.0 for value in row)
            print(f"{picture.name:30}" + "".join(f"{value:10.2g}" for value in row), flush=True)
        if cpp is not None:
            prober.close()
    print(f"false alarms: {alarms}")
    return alarms


def wrong(cases: int) -> None:
    """Print which laws catch which fault."""
    print()
    caught: dict[str, list[str]] = {}
    for name, rules in WRONG.items():
        ask = formulas("numpy", 64, rules)
        caught[name] = [law.name for law in formula_laws() if worst(law, ask, "float64", range(1), cases) > 1.0]
    with example("cpp_slides") as cpp:
        if cpp is not None:
            prober = prober_of(cpp)
            assert prober is not None
            caught["examples/cpp_slides"] = [
                law.name for law in formula_laws() if worst(law, prober, cpp.precision, range(1), cases) > 1.0
            ]
            prober.close()
            for picture in picture_laws():
                if picture.test(seeded(1, "float32", 0), Studio(cpp)).excess().max() > 1.0:
                    caught["examples/cpp_slides"].append(picture.name)
    for name, laws in caught.items():
        print(f"{name}: {', '.join(laws) or 'caught by no law'}")


def main() -> None:
    """Both tables; exit 1 on a false alarm."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--cases", type=int, default=2000)
    options = parser.parse_args()
    if best_lanes() == "drjit":
        from reference_tracer import llvm

        llvm.use()
    with np.errstate(all="ignore"):
        alarms = correct(range(options.seeds), options.cases)
        wrong(options.cases)
    raise SystemExit(1 if alarms else 0)


if __name__ == "__main__":
    main()
