"""Correct tracers under the suite's comparison: how many pictures are failed. There must be none.

Lanes in float32 and float64 by every lawful sphere and refraction method, each as linear values and as 8-bit codes,
and the C++ example in float32, in float64 and with another lawful epsilon; on the catalogue at the given sizes and
on seeded random scenes. The slide's refraction is left out: it has no answer at normal incidence.

    python benchmarks/false_alarms.py [--sizes 160x120,640x480] [--seeds 200]
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from oracles import kept
from oracles.compare import compare
from oracles.images import Picture, read
from oracles.truth import Truth
from raycheck.lanes import best_lanes
from raycheck.machine import machine
from reference_tracer.formulas.display import encode
from reference_tracer.lanes import render as lanes
from reference_tracer.methods import REFRACT, SPHERE
from reference_tracer.rulebook import Rulebook
from scenes.catalogue import ladder
from scenes.model import Scene
from scenes.random_scenes import random_scene
from scenes.text import to_text

EXAMPLE = Path(__file__).parents[1] / "examples" / "cpp_lecture" / "tracer.cpp"
CPP = {
    "C++ float32": ("float32", ()),
    "C++ float32, epsilon 1.5e-3": ("float32", ("-DEPSILON=1.5e-3",)),
    "C++ float64": ("float64", ("-DREAL=double", "-DEPSILON=1e-6")),
}
NO_ANSWER = "slide"


def methods() -> dict[str, Rulebook]:
    """Every method that is right wherever it is asked."""
    found = {f"sphere {name}": rules for name, rules in SPHERE.items()}
    return found | {f"refract {name}": rules for name, rules in REFRACT.items() if name != NO_ANSWER}


def scenes(sizes: Sequence[tuple[int, int]], seeds: int) -> Iterator[tuple[str, Scene]]:
    """All scenes, by what they are counted under."""
    for size in sizes:
        for rung in ladder():
            yield f"catalogue {size[0]}x{size[1]}", rung.scene().resized(*size)
    for seed in range(seeds):
        yield "random", random_scene(seed)


def failed(picture: Picture, expected: Truth) -> int:
    """1 for a false alarm; the picture's 8-bit codes are judged too, of values that its storage has rounded before."""
    codes = encode(picture.values, expected.scene.display).astype(np.float64)
    stored = replace(expected, tolerance=expected.tolerance + picture.roundoff * np.abs(expected.pixels))
    return int(compare(picture, expected).word == "fail") + int(compare(Picture(codes, 255), stored).word == "fail")


def compiled(folder: Path) -> dict[str, tuple[str, Path]]:
    """The C++ example's variants."""
    found = {}
    for name, (precision, flags) in CPP.items():
        program = folder / f"tracer{len(found)}"
        subprocess.run(["g++", "-O2", "-std=c++17", *flags, "-o", str(program), str(EXAMPLE)], check=True)
        found[name] = (precision, program)
    return found


def drawn(program: Path, scene: Scene, folder: Path) -> Picture:
    """The program's picture."""
    (folder / "scene.txt").write_text(to_text(scene), "utf-8")
    subprocess.run([str(program), str(folder / "scene.txt"), str(folder / "image.pfm")], check=True)
    return read(folder / "image.pfm", scene.image.width, scene.image.height)


def main() -> None:
    """One line a tracer and a kind of scene."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--sizes", default="160x120,640x480")
    options.add_argument("--seeds", type=int, default=200)
    said = options.parse_args()
    sizes = [(int(w), int(h)) for w, h in (size.split("x") for size in said.sizes.split(","))]
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}")
    begin = time.monotonic()
    alarms: dict[tuple[str, str], list[int]] = {}
    book, backend = methods(), best_lanes()
    with tempfile.TemporaryDirectory() as place:
        programs = compiled(Path(place))
        for kind, scene in scenes(sizes, said.seeds):
            truths = {word: kept.truth(scene, word, backend) for word in ("float32", "float64")}
            for bits in (32, 64):
                back, roundoff = lanes.backend(backend, bits), 2.0**-24 if bits == 32 else 0.0
                for name, rules in book.items():
                    picture = Picture(lanes.render(scene, back, rules).pixels.astype(np.float64), roundoff=roundoff)
                    row = alarms.setdefault((f"lanes float{bits}, {name}", kind), [0, 0])
                    row[0] += 2
                    row[1] += failed(picture, truths[f"float{bits}"])
            for name, (precision, program) in programs.items():
                row = alarms.setdefault((name, kind), [0, 0])
                row[0] += 2
                row[1] += failed(drawn(program, scene, Path(place)), truths[precision])
    for (name, kind), (count, wrong) in sorted(alarms.items()):
        print(f"{name:<40} {kind:<20} {wrong} of {count} pictures failed")
    total, wrong = (sum(row[k] for row in alarms.values()) for k in (0, 1))
    print(f"in all {wrong} false alarms in {total} pictures, {time.monotonic() - begin:.0f} s")


if __name__ == "__main__":
    main()
