"""What each eye ray meets, ours against a peer's: position, normal, and which shape.

The peer's shapes have numbers of its own, so shapes are compared as a partition of the pixels. The budgets are for
a peer that computes in float32 and makes its own eye rays (u = 2⁻²⁴):

- its direction: a matrix for the film and one for the world, 4 products and 3 sums each (4u of the sum of absolute
  values, at most √3 times the result's), a division and a normalisation (4u): DIRECTION = 2·4·√3 + 4 <= 18 units;
- so where the ray meets the surface at cosine c it has moved by 18u t/c, and t is known to 4u(t + |o|)/c (error law of
  the stable sphere formula, and of the plane's quotient), p = o + t v adds 2u(t + |o|);
- a sphere's normal (p - centre)/radius: that error over the radius, and 4u; a plane's 8u: a matrix times a vector.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracles.truth import ROUNDOFF, lawful_offset
from reference_tracer.lanes import render as lanes
from reference_tracer.plain import PlainTracer
from scenes.model import Scene, Sphere

DIRECTION = 18.0
"""Error of a float32 renderer's own eye ray, in units of u."""
Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Met:
    """What eye rays meet: position and normal (height, width, 3), the place of the object, -1 for none; and budgets."""

    position: Reals
    normal: Reals
    order: NDArray[np.int64]
    position_budget: Reals
    normal_budget: Reals
    doubtful: NDArray[np.bool_]


@dataclass(frozen=True)
class Agreement:
    """Largest shares of the budgets, and how many decided pixels lie outside or in another part."""

    pixels: int
    doubtful: int
    position: float
    normal: float
    outside: int
    misplaced: int


def clay(scene: Scene) -> Scene:
    """The scene's shapes and camera alone: everything shines white on black."""
    materials = {
        name: m.model_copy(
            update={"ambient": (1.0,) * 3} | dict.fromkeys(("diffuse", "specular", "reflect", "transmit"), (0.0,) * 3)
        )
        for name, m in scene.materials.items()
    }
    plain = {"materials": materials, "lights": (), "background": (0.0,) * 3, "depth": 0, "fresnel": False}
    return scene.model_copy(update=plain)


def met(scene: Scene, backend: str) -> Met:
    """The reference tracer's first hits, with the budgets of a float32 peer."""
    u, height, width = ROUNDOFF["float32"], scene.image.height, scene.image.width
    tracer = PlainTracer(scene)
    eye = tracer.vec(scene.camera.eye)
    position, normal = np.zeros((2, height, width, 3))
    order = np.full((height, width), -1)
    budgets = np.zeros((2, height, width))
    for j, i in np.ndindex(height, width):
        v = tracer.eye_ray(i, j)
        hit = tracer.nearest(eye, v, None)
        if hit is None:
            continue
        n, _ = tracer.rules.face(v, hit.n)
        position[j, i], normal[j, i], order[j, i] = hit.p, n, scene.tie_order[hit.order]
        t, c = math.dist(hit.p, eye), -sum(a * b for a, b in zip(v, n, strict=True))
        reach = t + math.hypot(*eye)
        moved = ((DIRECTION * t + 4.0 * reach) / c + 2.0 * reach) * u
        on_sphere = moved / hit.thing.radius + 4.0 * u if isinstance(hit.thing, Sphere) else 8.0 * u
        budgets[:, j, i] = moved, on_sphere
    doubts = lanes.enclose(clay(scene), lanes.backend(backend, 64), DIRECTION * u, lawful_offset(scene)).doubts
    return Met(position, normal, order, budgets[0], budgets[1], doubts != 0)


def agree(ours: Met, values: NDArray[np.float32]) -> Agreement:
    """Compare with a peer's (height, width, 7): position, normal, number of the shape."""
    theirs = values.astype(np.float64)
    sure = ~ours.doubtful
    hit = sure & (ours.order >= 0)
    away = np.abs(theirs[..., :3] - ours.position).max(axis=-1)
    # A peer may keep the outward normal: which side is seen is no part of this question
    turned = np.minimum(*(np.abs(sign * theirs[..., 3:6] - ours.normal).max(axis=-1) for sign in (1.0, -1.0)))
    position, normal = away[hit] / ours.position_budget[hit], turned[hit] / ours.normal_budget[hit]
    return Agreement(
        pixels=int(sure.size),
        doubtful=int(np.count_nonzero(~sure)),
        position=float(position.max(initial=0.0)),
        normal=float(normal.max(initial=0.0)),
        outside=int(np.count_nonzero((position > 1.0) | (normal > 1.0))),
        misplaced=misplaced(ours.order[sure], np.where(theirs[..., 3:6].any(axis=-1), theirs[..., 6], -1.0)[sure]),
    )


def misplaced(ours: NDArray[np.int64], theirs: Reals) -> int:
    """Pixels in the way of a one-to-one map between both numberings, with nothing (-1) mapped to nothing."""
    taken: set[float] = set()
    wrong = 0
    for part in np.unique(ours):
        numbers, counts = np.unique(theirs[ours == part], return_counts=True)
        best = float(numbers[int(np.argmax(counts))])
        lawful = best not in taken and (best == -1.0) == (part == -1)
        taken.add(best)
        wrong += int(counts.sum() - counts.max()) if lawful else int(counts.sum())
    return wrong
