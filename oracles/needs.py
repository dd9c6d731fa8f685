"""What a scene needs of a tracer: the least model that draws the same picture, each part of it shown to be needed.

A part is not needed where the certified picture without it lies within the sum of both proofs' bounds of the scene's
own, in every value. It is needed where one value differs by more: the two truths then differ, whatever computes them.
Parts are taken away one after another as long as nothing changes, and those that stay are shown needed
of the model that is left; what suffices is found at the size that the scene has, no other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from oracles.measurement import Precision
from reference_tracer.certified import BALL_BITS, Certified
from reference_tracer.formulas.display import encode
from reference_tracer.methods import SPHERE
from reference_tracer.rulebook import Rulebook
from scenes.model import Plane, Scene

Reals = NDArray[np.float64]
BLACK = (0.0, 0.0, 0.0)
FEATURES = ("plane", "shadow", "reflect", "refract", "fresnel")
"""In the manifest's words; dropped in this order."""

METHODS = tuple(name for name in SPHERE if name not in ("wide", "double-word"))
"""Ways to meet a sphere, the fewest operations first. The two left out compute in more bits than they are given, and
so would show nothing about the precision."""

CODES = 255
FINE = 2**20
"""Steps into which a code is divided to measure parts of it."""
HALF_A_CODE = 0.5
"""A picture that is nowhere farther than this from truth rounds to a neighbouring code at worst, where truth itself
lies between two: nobody who looks at its 8 bits can tell it from truth."""


@dataclass(frozen=True)
class Part:
    """Something that a model may lack: a feature, its last generation, a light or an object (places in the scene)."""

    kind: str
    name: str | int

    def __str__(self) -> str:
        return self.name if isinstance(self.name, str) else f"{self.kind} {self.name}"


@dataclass(frozen=True)
class Model:
    """What a tracer knows of a scene: features, generations after the eye ray, places of lights and objects."""

    features: frozenset[str]
    depth: int
    lights: tuple[int, ...]
    objects: tuple[int, ...]

    def parts(self) -> list[Part]:
        """All that can be taken from it, one at a time."""
        found = [Part("feature", name) for name in FEATURES if name in self.features]
        found += [Part("depth", self.depth)] if self.depth else []
        found += [Part("light", k) for k in self.lights]
        return found + [Part("object", k) for k in self.objects]

    def without(self, part: Part) -> Model:
        """The model that lacks it."""
        match part.kind:
            case "feature":
                return replace(self, features=self.features - {str(part.name)})
            case "depth":
                return replace(self, depth=self.depth - 1)
            case "light":
                return replace(self, lights=tuple(k for k in self.lights if k != part.name))
            case _:
                return replace(self, objects=tuple(k for k in self.objects if k != part.name))

    def joined(self, part: Part) -> Model:
        """The model that has it as well."""
        match part.kind:
            case "feature":
                return replace(self, features=self.features | {str(part.name)})
            case "depth":
                return replace(self, depth=int(part.name))
            case "light":
                return replace(self, lights=tuple(sorted({*self.lights, int(part.name)})))
            case _:
                return replace(self, objects=tuple(sorted({*self.objects, int(part.name)})))

    def of(self, scene: Scene) -> Scene:
        """The scene as a tracer of this model draws it: planes not met, lights not blocked, weights zero."""
        gone = {"reflect": BLACK} if "reflect" not in self.features else {}
        gone |= {"transmit": BLACK} if "refract" not in self.features else {}
        things = [scene.objects[k] for k in self.objects]
        met = [thing for thing in things if "plane" in self.features or not isinstance(thing, Plane)]
        return scene.model_copy(
            update={
                "depth": self.depth,
                "shadows": "shadow" in self.features,
                "fresnel": "fresnel" in self.features,
                "materials": {name: m.model_copy(update=gone) for name, m in scene.materials.items()},
                "objects": tuple(met),
                "lights": tuple(scene.lights[k] for k in self.lights),
            }
        )


def everything(scene: Scene) -> Model:
    """The scene's own model."""
    return Model(scene.features, scene.depth, tuple(range(len(scene.lights))), tuple(range(len(scene.objects))))


@dataclass(frozen=True)
class Change:
    """A picture that differs: how many pixels are proved to, and the one that a tolerance tells best.

    by: its largest difference of a linear value; tolerances: that difference over what `raycheck check` grants a
    float32 tracer there.
    """

    pixels: int
    i: int
    j: int
    by: float
    tolerances: float


def changed(true: Certified, other: Certified, tolerance: Reals) -> Change | None:
    """Where two certified pictures differ beyond the sum of their bounds; None if nowhere."""
    difference = np.abs(other.value - true.value)
    proved = difference > true.bound + other.bound
    if not proved.any():
        return None
    with np.errstate(divide="ignore", invalid="ignore"):  # a value that no rounding touches has the tolerance 0
        told = np.where(proved, difference / tolerance, -1.0)
    j, i, channel = np.unravel_index(int(np.argmax(told)), told.shape)
    by, tolerances = float(difference[j, i, channel]), float(told[j, i, channel])
    return Change(int(proved.any(axis=-1).sum()), int(i), int(j), by, tolerances)


@dataclass(frozen=True)
class Needs:
    """The least model, each part that is necessary with what its lack changes, and the parts that are not.

    bound: the largest sum of bounds within which the least model equals the scene; undecided: pixels of the scene
    whose bound is the hull of several branches, where little is shown.
    """

    model: Model
    necessary: tuple[tuple[Part, Change], ...]
    spare: tuple[Part, ...]
    bound: float
    undecided: int


Certify = Callable[[Scene], Certified]


def needs(scene: Scene, certify: Certify, tolerance: Reals) -> Needs:
    """Take parts away while nothing changes; tolerance (height, width, 3): of a float32 tracer on this scene."""
    true = certify(scene)
    pictures: dict[Model, Certified] = {}

    def lack(model: Model) -> Change | None:
        if model not in pictures:
            pictures[model] = certify(model.of(scene))
        return changed(true, pictures[model], tolerance)

    model, spare = everything(scene), []
    while True:
        necessary: list[tuple[Part, Change]] = []
        before = model
        for part in before.parts():
            change = lack(model.without(part))
            if change is None:
                model = model.without(part)
                spare.append(part)
            else:
                necessary.append((part, change))
        if model == before:
            break
    rest = pictures[model] if model in pictures else certify(model.of(scene))
    return Needs(
        model, tuple(necessary), tuple(spare), float((true.bound + rest.bound).max()), int((~true.decided).sum())
    )


@dataclass(frozen=True)
class Trial:
    """A precision and a way to meet spheres, and how far their picture is from truth.

    codes: the largest error in codes of 0..255; i, j: its pixel; error: the largest error of a linear value; wrong:
    pixels more than half a code off. Pixels on an edge so closely that balls of 53 bits do not decide their path are
    left out: rays that touch a sphere exactly are a matter of luck in float64 too.
    """

    precision: Precision
    method: str
    codes: float
    i: int
    j: int
    error: float
    wrong: int

    @property
    def suffices(self) -> bool:
        """Nobody can tell its 8 bits from truth's."""
        return self.wrong == 0


Draw = Callable[[Scene, Precision, Rulebook], NDArray[np.floating]]


def trials(scene: Scene, true: Certified, draw: Draw) -> list[Trial]:
    """Ever more precise and more costly pictures of a scene, up to the first that suffices."""
    found: list[Trial] = []
    precisions: Sequence[Precision] = ("float32", "float64")
    for precision in precisions:
        for method in METHODS:
            found.append(_judged(scene, true, precision, method, draw(scene, precision, SPHERE[method])))
            if found[-1].suffices:
                return found
    return found


def _judged(scene: Scene, true: Certified, precision: Precision, method: str, got: NDArray[np.floating]) -> Trial:
    picture = got.astype(np.float64)
    shown = [encode(values, scene.display, CODES * FINE) / FINE for values in (picture, true.value)]
    judged = (true.decided & (true.bits <= BALL_BITS))[..., None]
    off = np.where(judged, np.abs(shown[0] - shown[1]), 0.0)
    error = np.where(judged, np.abs(picture - true.value), 0.0)
    j, i, _ = np.unravel_index(int(np.argmax(off)), off.shape)
    wrong = int((off > HALF_A_CODE).any(axis=-1).sum())
    return Trial(precision, method, float(off.max()), int(i), int(j), float(error.max()), wrong)
