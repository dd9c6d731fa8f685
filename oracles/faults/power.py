"""Which scenes notice which fault, and by how many tolerances."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from oracles import kept
from oracles.compare import compare
from oracles.faults.fault import Fault, Twin
from oracles.faults.files import linear
from oracles.images import ImageError, Picture
from oracles.images.picture import check
from oracles.truth import Truth
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from scenes.model import Scene

PRECISION = "float32"


@dataclass(frozen=True)
class Kill:
    """A scene that fails a fault: the pixels outside, and the worst in tolerances (inf: none was tolerated)."""

    scene: str
    pixels: int
    excess: float


def picture(scene: Scene, entry: Fault | Twin, bits: int = 32) -> Picture:
    """What a tracer with this entry writes of the scene, computed on NumPy lanes."""
    pixels = render(scene, NumPyBackend(bits), entry.rules).pixels
    return entry.picture(pixels, scene) if entry.picture else linear(pixels, 2.0**-24 if bits == 32 else 0.0)


class Bench:
    """One scene with its truth and the reference's own float32 picture."""

    def __init__(self, scene: Scene, lanes: str = "numpy") -> None:
        self.scene = scene
        self.truth: Truth = kept.truth(scene, PRECISION, lanes)
        self.right = render(scene, NumPyBackend(32)).pixels

    def kill(self, fault: Fault) -> Kill | None:
        """How the scene fails this fault; None where its picture conforms."""
        if not touches(self.scene, fault.entries):
            return None
        pixels = self.right if not fault.entries else render(self.scene, NumPyBackend(32), fault.rules).pixels
        if fault.picture:
            return self._judged(fault.picture(pixels, self.scene))
        return None if np.array_equal(pixels, self.right) else self._judged(linear(pixels))

    def wrongly_killed(self, twin: Twin) -> Kill | None:
        """How the scene fails this correct tracer; None, as it should be."""
        return self._judged(picture(twin.scene(self.scene), twin, twin.precision))

    def _judged(self, found: Picture) -> Kill | None:
        try:
            judged = compare(check(found), self.truth).judged
        except ImageError:  # NaN or Inf: no picture at all
            return Kill(self.scene.name, found.values.shape[0] * found.values.shape[1], float("inf"))
        worst = judged.worst
        return Kill(self.scene.name, judged.outside, worst.excess) if judged.outside and worst else None


_BALLS = frozenset({"sphere_distances", "sphere_hit", "sphere_normal"})
_PLANES = frozenset({"plane_hit", "plane_normal"})
_LIT = frozenset({"light_vector", "attenuation", "lambert", "phong", "direct_light", "reflect", "shading_normal"})


def touches(scene: Scene, entries: frozenset[str]) -> bool:
    """Whether a picture of the scene can depend on these entries of a rulebook; True where that is not sure.

    No entries: the fault is in the file, which every scene has.
    """
    return not entries or any(_asked(scene, entry) for entry in entries)


def _asked(scene: Scene, entry: str) -> bool:
    features = scene.features
    if entry in _BALLS:
        return any(thing.shape == "sphere" for thing in scene.objects)
    if entry in _PLANES:
        return "plane" in features
    if entry in _LIT or entry == "add_light":
        return bool(scene.lights)
    if entry in ("blocks", "shaded_light"):
        return "shadow" in features
    if entry == "view_vector":
        return bool(scene.lights) and bool(features & {"reflect", "refract"})
    if entry in ("refract", "mirror", "mix"):
        return bool(features & {"reflect", "refract"})
    return "fresnel" in features if entry == "fresnel" else True


def kills(benches: Sequence[Bench], fault: Fault) -> Iterator[Kill]:
    """Every scene that fails the fault, in the ladder's order."""
    for bench in benches:
        found = bench.kill(fault)
        if found is not None:
            yield found
