"""Time of one 640x480 picture: our number types beside Mitsuba, in one run.

The scene is the catalogue's lecture-final; for Mitsuba its closest equivalent: the same camera,
shapes and lights, one stochastic path a pixel instead of both branches. Rounds are interleaved, so
that drift of the machine hits all alike; the first round (kernels, caches) is shown apart.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable

import numpy as np

from raycheck.machine import machine
from reference_tracer import llvm, plain
from reference_tracer.lanes import render as lanes
from scenes.catalogue import rung
from scenes.model import Material, PointLight, Scene, Sphere

SIZE = (640, 480)
ROUNDS = 15
SAFETY_U = 2.0**-23
MITSUBA = ("llvm_ad_rgb", "scalar_rgb")


def ours(scene: Scene) -> dict[str, Callable[[], object]]:
    """Our arithmetics, the slow plain one left out."""

    def lane(name: str, bits: int) -> Callable[[], object]:
        backend = lanes.backend(name, bits)
        return lambda: lanes.render(scene, backend)

    runs = {"NumPy float32": lane("numpy", 32), "NumPy float64": lane("numpy", 64)}
    if llvm.find():
        certify = lanes.backend("drjit", 64)
        runs |= {"DrJit float32": lane("drjit", 32), "DrJit float64": lane("drjit", 64)}
        runs["DrJit balls"] = lambda: lanes.enclose(scene, certify, SAFETY_U, 1e-3)
    return runs


def mitsuba(variant: str, scene: Scene) -> Callable[[], object]:
    """Mitsuba's path tracer at one sample a pixel."""
    import mitsuba as mi

    mi.set_variant(variant)
    loaded = mi.load_dict(_as_mitsuba(scene, mi), optimize=False)
    seeds = iter(range(10**6))

    return lambda: np.array(mi.render(loaded, spp=1, seed=next(seeds)))


def _as_mitsuba(scene: Scene, mi: object) -> dict[str, object]:
    T = mi.ScalarTransform4f  # type: ignore[attr-defined]
    camera = scene.camera
    target = [e + f for e, f in zip(camera.eye, camera.forward, strict=True)]
    film = {
        "type": "hdrfilm",
        "width": scene.image.width,
        "height": scene.image.height,
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
        "component_format": "float32",
    }
    found: dict[str, object] = {
        "type": "scene",
        # depth generations after the eye ray, and the light's segment
        "integrator": {"type": "path", "max_depth": scene.depth + 2, "rr_depth": 100},
        "sensor": {
            "type": "perspective",
            "fov": 73.0,
            "fov_axis": "x",
            "to_world": T().look_at(origin=list(camera.eye), target=target, up=list(camera.up)),
            "sampler": {"type": "independent", "sample_count": 1},
            "film": film,
        },
    }
    for k, thing in enumerate(scene.objects):
        bsdf = _bsdf(scene.materials[thing.material])
        if isinstance(thing, Sphere):
            found[f"o{k}"] = {"type": "sphere", "center": list(thing.center), "radius": thing.radius, "bsdf": bsdf}
        else:
            up = T().translate([0, thing.offset, 0]).rotate([1, 0, 0], -90).scale(50.0)
            found[f"o{k}"] = {"type": "rectangle", "to_world": up, "bsdf": bsdf}
    for k, light in enumerate(scene.lights):
        if isinstance(light, PointLight):
            found[f"l{k}"] = {"type": "point", "position": list(light.position), "intensity": 20.0}
    return found


def _bsdf(material: Material) -> dict[str, object]:
    if any(material.transmit):
        return {"type": "dielectric", "int_ior": material.index, "ext_ior": 1.0}
    if min(material.reflect) > 0.5:
        return {"type": "conductor", "material": "none"}
    return {"type": "diffuse", "reflectance": {"type": "rgb", "value": list(material.diffuse)}}


def compare_all() -> None:
    """One table a variant of Mitsuba: switching variants between rounds would slow Mitsuba down."""
    scene = rung("lecture-final").scene().resized(*SIZE)
    for variant in MITSUBA:
        if variant.startswith("llvm") and not llvm.find():
            continue
        runs = ours(scene)
        try:
            runs[f"Mitsuba {variant}"] = mitsuba(variant, scene)
        except ImportError:
            print("Mitsuba is not installed (pip install raycheck[peers])")
        interleaved(runs, f"Mitsuba {variant}")


def interleaved(runs: dict[str, Callable[[], object]], anchor: str) -> None:
    """Run all in turn, round after round; print medians, minima, maxima, and ratios to the anchor."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for _ in range(ROUNDS + 1):
        for name, run in runs.items():
            begin = time.perf_counter()
            run()
            times[name].append(1000.0 * (time.perf_counter() - begin))
    print(f"{'milliseconds':<22}{'first':>9}{'median':>9}{'min':>9}{'max':>9}   ratio to {anchor}, round by round")
    for name, (first, *warm) in times.items():
        ratios = [a / b for a, b in zip(warm, times[anchor][1:], strict=True)] if anchor in times else []
        shown = f"{first:>9.1f}{statistics.median(warm):>9.1f}{min(warm):>9.1f}{max(warm):>9.1f}"
        print(f"{name:<22}{shown}" + (f"{statistics.median(ratios):>9.2f}" if ratios else ""))
    print()


def plain_time() -> None:
    """The plain tracer, once, on a quarter of the pixels."""
    scene = rung("lecture-final").scene().resized(SIZE[0] // 2, SIZE[1] // 2)
    begin = time.perf_counter()
    plain.render(scene)
    print(f"plain Python floats: {4.0 * (time.perf_counter() - begin):.1f} s (4 times a 320x240 picture)")


def main() -> None:
    """Print the machine line and the table."""
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}, lanes: {here.lanes}")
    compare_all()
    sys.stdout.flush()
    plain_time()
    helps = [sys.executable, "-P", "-c", "from raycheck.cli import main; main(['--help'])"]
    begin = time.perf_counter()
    for _ in range(10):
        subprocess.run(helps, check=False, stdout=subprocess.DEVNULL)
    print(f"raycheck --help: {(time.perf_counter() - begin) / 10.0 * 1000.0:.0f} ms (mean of 10)")


if __name__ == "__main__":
    main()
