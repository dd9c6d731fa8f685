"""The smallest change of a scene that the comparison sees, beside the smallest that two common gates see.

A float32 picture of the changed scene is judged by the truth of the unchanged one. The other gates are Blender's
render test, on 8-bit sRGB pictures, failed if more than 1 % of the pixels differ by more than 0.016 in any
channel (tests/python/modules/render_report.py of Blender), and a mean FLIP above 0.05 on sRGB pictures (Andersson
et al., FLIP: A Difference Evaluator for Alternating Images, HPG 2020).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from oracles import gates
from oracles.compare import compare
from oracles.images import Picture
from oracles.truth import Truth, truth
from raycheck.machine import machine
from reference_tracer.formulas.display import srgb_codes
from reference_tracer.lanes import render as lanes
from scenes.catalogue import rung
from scenes.model import DirectionalLight, Scene, Sphere

Change = Callable[[Scene, float], Scene]
Pixels = NDArray[np.float64]


def radius(scene: Scene, d: float) -> Scene:
    """All radii times 1 + d."""
    grown = [t.model_copy(update={"radius": t.radius * (1 + d)}) if isinstance(t, Sphere) else t for t in scene.objects]
    return scene.model_copy(update={"objects": tuple(grown)})


def material(name: str, field: str, change: Callable[[float, float], float]) -> Change:
    """One number (or all three channels) of one material, changed."""

    def changed(scene: Scene, d: float) -> Scene:
        old = getattr(scene.materials[name], field)
        new = tuple(change(x, d) for x in old) if isinstance(old, tuple) else change(old, d)
        one = scene.materials[name].model_copy(update={field: new})
        return scene.model_copy(update={"materials": {**scene.materials, name: one}})

    return changed


def turned(scene: Scene, d: float) -> Scene:
    """Directional lights turned by d radians about the z axis."""

    def turn(light: DirectionalLight) -> DirectionalLight:
        x, y, z = light.toward
        c, s = math.cos(d), math.sin(d)
        return light.model_copy(update={"toward": (c * x - s * y, s * x + c * y, z)})

    lights = [turn(light) if isinstance(light, DirectionalLight) else light for light in scene.lights]
    return scene.model_copy(update={"lights": tuple(lights)})


CASES: dict[str, tuple[str, Change]] = {
    "index of glass 1.5 + d": ("glass-sphere", material("glass", "index", lambda x, d: x + d)),
    "index of glass 1.5 + d, final": ("lecture-final", material("glass", "index", lambda x, d: x + d)),
    "index of water 1.33 + d": ("refract-plane", material("water", "index", lambda x, d: x + d)),
    "radius (1 + d)": ("headlight-sphere", radius),
    "reflect weight (1 + d)": ("mirror-imperfect", material("mirror", "reflect", lambda x, d: x * (1 + d))),
    "light turned by d rad": ("directional-light", turned),
    "diffuse weight (1 + d)": ("point-light", material("ball", "diffuse", lambda x, d: x * (1 + d))),
}


def picture(scene: Scene) -> Pixels:
    """What a float32 tracer writes."""
    return lanes.render(scene, lanes.backend("numpy", 32)).pixels.astype(np.float64)


def seen_by_us(pixels: Pixels, expected: Truth) -> bool:
    """Judged as raycheck does."""
    return compare(Picture(pixels, roundoff=2.0**-24), expected).word == "fail"


def seen_by_blender(pixels: Pixels, expected: Truth) -> bool:
    """Judged by the 1 % rule."""
    return gates.blender(srgb_codes(expected.pixels), srgb_codes(pixels))


def seen_by_flip(pixels: Pixels, expected: Truth) -> bool:
    """Judged by mean FLIP."""
    return gates.mean_flip(srgb_codes(expected.pixels), srgb_codes(pixels))


GATES = (seen_by_us, seen_by_blender, seen_by_flip)


def smallest(gate: Callable[[Pixels, Truth], bool], scene: Scene, change: Change, expected: Truth) -> float:
    """The smallest d of a grid of 8 a decade from 1e-8 to 1 that is seen, inf if none is."""
    for step in range(0, 8 * 8 + 1):
        d = 10.0 ** (-8 + step / 8)
        if gate(picture(change(scene, d)), expected):
            return d
    return math.inf


def main() -> None:
    """One line a change."""
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}")
    print(f"{'change':<32}{'scene':<20}{'raycheck':>10}{'Blender':>10}{'FLIP':>10}")
    for words, (name, change) in CASES.items():
        scene = rung(name).scene()
        expected = truth(scene, "float32")
        found = [smallest(gate, scene, change, expected) for gate in GATES]
        print(f"{words:<32}{name:<20}" + "".join(f"{d:>10.1g}" for d in found), flush=True)
    for n in (101, 110, 150):
        scene = rung("phong-100").scene()
        changed = picture(material("shiny", "shininess", lambda x, d: int(d))(scene, n))
        expected = truth(scene, "float32")
        words = [("seen" if gate(changed, expected) else "not seen") for gate in GATES]
        print(f"{f'exponent 100 -> {n}':<32}{'phong-100':<20}" + "".join(f"{word:>10}" for word in words))


if __name__ == "__main__":
    main()
