"""Named cases beyond one formula: what a tracer does around it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from oracles.measurement import Answer, Case
from oracles.stability import starts
from reference_tracer import exact, plain
from reference_tracer.formulas import optics, shading, sphere
from reference_tracer.methods.offsets import OFFSETS
from reference_tracer.vector import Vec, unit
from scenes.json_form import from_data
from scenes.model import Scene

SEED = 14
FMIN = 1e10
DEGREES_LOST = math.degrees(16 * 2.0**-53)
"""What float64 may lose of a mirror direction's angle: 9u of the direction itself, and the angles on the way there."""


def tracer_cases() -> Iterator[Case]:
    """Cases 13, 14, 15, 18, 19 and 21."""
    yield from _reflections()
    yield _starts()
    yield _least_distance()
    yield _infinity()
    yield from _highlights()
    yield _coincident()


def _reflections() -> Iterator[Case]:
    """2n - i is the mirror direction only for i = n."""
    formulas: dict[str, Callable[[Vec, Vec], Vec]] = {
        "2(i∘n)n - i": optics.reflect,
        "unit(2n - i)": lambda i, n: unit(n * 2.0 - i),
    }
    for degrees in (30, 60, 89):
        angle = math.radians(degrees)
        i, n = Vec(math.sin(angle), 0.0, math.cos(angle)), Vec(0.0, 0.0, 1.0)
        answers = []
        for name, formula in formulas.items():
            r = formula(i, n)
            off = abs(math.degrees(math.atan2(-r.x, r.z)) - degrees)
            answers.append(Answer(who=name, got=f"{degrees - off:.3g}°", right=off < DEGREES_LOST))
        yield Case(
            number=13,
            title=f"Reflection at {degrees}°",
            inputs=f"float64  i at {degrees}° to n",
            truth=f"{degrees}°",
            slide="Math of Reflection Vector",
            answers=tuple(answers),
        )


def _starts() -> Case:
    """A rounded hit point lies inside its sphere half of the time."""
    rng = np.random.default_rng(SEED)
    answers = []
    for method in ("lecture", "haines"):
        bounces = starts.Bounces(rng, method, "float32", 10.0, 0.0)
        for name in ("none", "t-min 1e-3", "project"):
            found = bounces.measured(name, OFFSETS[name])
            answers.append(Answer(who=f"{method}, {name}", got=f"{found.acne:.1%} meet it", right=found.acne == 0.0))
    return Case(
        number=14,
        title="A ray that leaves a sphere meets it again",
        inputs="float32  p = fl(o + λv), D = 10, directions outward with cosines 0.01 to 1",
        truth="0.0% meet it",
        slide="Modified FindRGB",
        answers=tuple(answers),
    )


def _least_distance() -> Case:
    """A least distance hides a near wall, and the far one answers."""
    o, c, r = Vec(0.0, 0.0, -500.0007), Vec(0.0, 0.0, 0.0), 500.0
    answers = []
    for name, least in (("everything beyond 0 counts", 0.0), ("t-min 1e-3", 1e-3)):
        distance, _ = sphere.sphere_hit(sphere.sphere_distances, o, Vec(0.0, 0.0, 1.0), c, r, False, least)
        answers.append(Answer(who=name, got=f"{distance:.7g}", right=distance < 1.0))
    return Case(
        number=15,
        title="A gap smaller than the least distance",
        inputs="float64  o = (0, 0, -500.0007)  v = (0, 0, 1)  c = 0  r = 500",
        truth="0.0007",
        slide="Modified FindRGB",
        answers=tuple(answers),
    )


def _infinity() -> Case:
    """1e10 is not infinity."""
    distance, meets = sphere.sphere_hit(
        sphere.sphere_distances,
        Vec(0.0, 0.0, 0.0),
        Vec(0.0, 0.0, 1.0),
        Vec(0.0, 0.0, 1.02e10),
        1e8,
        False,
        0.0,
    )
    answers = []
    for name, nothing in (("nearest starts at infinity", math.inf), ("fmin = 1e10", FMIN)):
        seen = meets and distance < nothing
        answers.append(Answer(who=name, got=f"{distance:.7g}" if seen else "miss", right=seen))
    return Case(
        number=18,
        title="Farther than the slide's infinity",
        inputs="float64  o = 0  v = (0, 0, 1)  c = (0, 0, 1.02e10)  r = 1e8",
        truth="1.01e+10",
        slide="Modified FindRGB",
        answers=tuple(answers),
    )


def _highlights() -> Iterator[Case]:
    """An even power of a negative cosine lights the side that looks away; a broken one has no value."""
    i, n = Vec(math.sin(1.2), 0.0, math.cos(1.2)), Vec(0.0, 0.0, 1.0)
    mirrored = optics.reflect(i, n)
    v = Vec(-i.x, -i.y, -i.z)  # from the light's side: r∘(-v) < 0
    cosine = -(mirrored.x * v.x + mirrored.y * v.y + mirrored.z * v.z)
    for s in (10.0, 32.5):
        unclamped = float(np.power(cosine, s)) if s == int(s) else math.nan
        shown = f"{unclamped:.3g}" if math.isfinite(unclamped) else "no real number"
        ours = shading.phong(i, n, v, int(s), mirrored)
        yield Case(
            number=19,
            title=f"A highlight seen from the wrong side, s = {s:g}",
            inputs=f"float64  r∘(-v) = {cosine:.3g}  s = {s:g}",
            truth="0",
            slide="Phong Effect",
            answers=(
                Answer(who="clamped before the power", got=f"{ours:g}", right=ours == 0.0),
                Answer(who="(r∘(-v))^s as on the slide", got=shown, right=unclamped == 0.0),
            ),
        )


def _coincident() -> Case:
    """Two equal spheres in one place: which is nearer has no answer."""
    scene = coincident()
    i, j = scene.image.width // 2, scene.image.height // 2
    pixel = exact.ExactTracer(scene).pixel(i, j)
    got = plain.PlainTracer(scene).pixel(i, j)
    hull = f"{pixel.value[0] - pixel.bound[0]:.3g} … {pixel.value[0] + pixel.bound[0]:.3g}"
    inside = all(abs(a - b) <= c for a, b, c in zip(got, pixel.value, pixel.bound, strict=True))
    return Case(
        number=21,
        title="Two coincident spheres, one dark and one bright",
        inputs="float64  same centre and radius, ambient 0.2 and 0.8",
        truth=f"a tie: {hull}",
        slide="Ray Tracing Depth Sorting",
        answers=(
            Answer(who="plain tracer", got=f"{got.x:.3g}, the first of the two", right=inside),
            Answer(who="exact tracer", got=f"{hull}, undecided", right=not pixel.decided),
        ),
    )


def coincident() -> Scene:
    """The scene of case 21."""
    black = [0.0, 0.0, 0.0]

    def material(ambient: float) -> dict[str, object]:
        nothing = dict.fromkeys(("diffuse", "specular", "reflect", "transmit"), black)
        return {"ambient": [ambient] * 3, "shininess": 1, "index": 1.0, **nothing}

    ball = {"shape": "sphere", "center": [0.0, 0.0, 1.0], "radius": 1.0}
    return from_data(
        {
            "raycheck": 1,
            "name": "coincident",
            "source": "",
            "image": {"width": 4, "height": 3, "sample": [0.5, 0.5]},
            "camera": {"eye": [0, 0, -2], "forward": [0, 0, 1], "right": [0.5, 0, 0], "up": [0, 0.375, 0]},
            "background": black,
            "depth": 0,
            "shadows": False,
            "display": "lecture",
            "materials": {"dark": material(0.2), "bright": material(0.8)},
            "objects": [{**ball, "material": "dark"}, {**ball, "material": "bright"}],
            "lights": [],
        }
    )
