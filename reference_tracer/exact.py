"""The tracer on real numbers: arb balls of python-flint, doubled in precision until all is decided.

The recursion and the formulas are the plain tracer's; only the numbers differ. Scene numbers are
taken exactly, directions are normalised inside, so nothing is rounded but by arb, which bounds it.
A comparison that the balls cannot decide stops the pixel, which then starts again at twice the
precision. What no precision decides (a tie) is decided both ways, and the pixel is the hull.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, ctx

from reference_tracer.numbers import Composed, Number, less, register, select
from reference_tracer.plain import PlainTracer
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec, dot
from scenes.model import Scene

START_BITS = 128
"""Costs what 64 bits cost."""
CAP_BITS = 1024
"""Where doubling ends and both branches are taken."""
MAX_BRANCHES = 64
"""Combinations of undecided branches looked at; beyond, the pixel is unknown."""


class UndecidedError(Exception):
    """A comparison of overlapping balls at a precision that may still grow."""


class Decisions:
    """The answers to undecided comparisons: none, or a script of one combination of branches."""

    def __init__(self) -> None:
        self.script: list[bool] | None = None
        self.asked = 0

    def ask(self) -> bool:
        """One answer of the script, made longer where it ends."""
        if self.script is None:
            raise UndecidedError
        if self.asked == len(self.script):
            self.script.append(False)
        self.asked += 1
        return self.script[self.asked - 1]

    def next_script(self) -> bool:
        """The next combination in binary order; False after the last."""
        if self.script is None:
            return False
        del self.script[self.asked :]
        while self.script and self.script[-1]:
            self.script.pop()
        self.asked = 0
        if not self.script:
            return False
        self.script[-1] = True
        return True


DECISIONS = Decisions()


class ArbOperations(Composed):
    """Formulas on arb."""

    rank = 4

    def less(self, a: Any, b: Any) -> bool:
        a, b = arb(a), arb(b)
        if a < b:
            return True
        return False if a >= b else DECISIONS.ask()

    def at_least(self, a: Any, b: Any) -> bool:
        return not self.less(a, b)

    def select(self, condition: bool, a: Any, b: Any) -> Any:
        return a if condition else b

    def sqrt0(self, x: Any) -> Any:
        return arb(0) if x <= 0 else x.nonnegative_part().sqrt()

    def clamp0(self, x: Any) -> Any:
        return arb(0) if x <= 0 else x.nonnegative_part()

    def power(self, x: Any, n: int) -> Any:
        result = arb(1)
        while n > 0:
            if n & 1:
                result = result * x
            x = x * x  # not x**2, which is NaN where the midpoint is 0
            n >>= 1
        return result

    def sum3(self, a: Any, b: Any, c: Any) -> Any:
        return (a + b) + c

    def over_pi(self, x: Any) -> Any:
        return x / arb.pi()


register(ArbOperations(), arb)


@dataclass(frozen=True)
class ExactPixel:
    """One pixel: value and bound a channel, the bits that were needed, and whether all was decided."""

    value: tuple[float, float, float]
    bound: tuple[float, float, float]
    bits: int
    decided: bool


class ExactTracer:
    """Pixels of one scene, as exactly as they can be known."""

    def __init__(self, scene: Scene, rules: Rulebook = LECTURE) -> None:
        self.rules = replace(rules, sphere_hit=self._sphere_hit)
        self.lecture = rules
        self.scene = scene
        self.tracer = PlainTracer(scene, self.rules, arb)
        self.eye = self.tracer.vec(scene.camera.eye)
        self.at = (0, 0)

    def pixel(self, i: int, j: int) -> ExactPixel:
        """Linear colour of pixel (i, j), precision doubled until every decision is certain."""
        before = ctx.prec
        try:
            bits = START_BITS
            while bits <= CAP_BITS:
                ctx.prec = bits
                try:
                    return self._result([self._trace(i, j)], bits, True)
                except UndecidedError:
                    bits *= 2
            ctx.prec = CAP_BITS
            colours = self._all_branches(i, j)
            return self._result(colours, CAP_BITS, _agree(colours))
        finally:
            ctx.prec = before

    def _trace(self, i: int, j: int) -> Vec:
        self.at = (i, j)
        self.eye = self.tracer.vec(self.scene.camera.eye)
        return self.tracer.find_rgb(self.eye, self.tracer.eye_ray(i, j), None, 0)

    def _all_branches(self, i: int, j: int) -> list[Vec]:
        """The colours of every combination of the undecided branches; none if there are too many."""
        DECISIONS.script, DECISIONS.asked = [], 0
        try:
            found: list[Vec] = []
            while len(found) < MAX_BRANCHES:
                found.append(self._trace(i, j))
                if not DECISIONS.next_script():
                    return found
            return []
        finally:
            DECISIONS.script = None

    def _result(self, colours: list[Vec], bits: int, decided: bool) -> ExactPixel:
        if not colours:
            return ExactPixel((0.0,) * 3, (np.inf,) * 3, bits, False)
        parts = [_enclosed([colour[k] for colour in colours]) for k in range(3)]
        value, bound = zip(*parts, strict=True)
        return ExactPixel(value, bound, bits, decided)

    def _sphere_hit(
        self,
        distances: Callable[..., Any],
        o: Vec,
        v: Vec,
        c: Vec,
        r: Number,
        starts_here: bool,
        start: float,
    ) -> tuple[Number, bool]:
        """The rulebook's; at the cap an eye ray's miss or hit is decided by the polynomial.

        D of a normalised direction is never exactly 0 in balls, even for a ray that is exactly tangent. But D
        has the sign of (b∘w)² - (w∘w)(b∘b - r²) for the direction w before it is normalised, and this is
        a rational number.
        """
        if o is not self.eye or ctx.prec < CAP_BITS:
            return self.lecture.sphere_hit(distances, o, v, c, r, starts_here, start)
        if self._discriminant(c, r) < 0:
            return arb("inf"), False
        near, far, _ = distances(o - c, dot(o - c, v), v, r)
        distance = select(less(start, near), near, far)
        return distance, less(start, distance)

    def _discriminant(self, c: Vec, r: Number) -> Fraction:
        """(b∘w)² - (w∘w)(b∘b - r²) of the eye ray, in rational numbers."""
        camera, image = self.scene.camera, self.scene.image
        i, j = self.at
        X = -1 + 2 * (i + Fraction(image.sample[0])) / image.width
        Y = 1 - 2 * (j + Fraction(image.sample[1])) / image.height
        axes = zip(camera.forward, camera.right, camera.up, strict=True)
        w = [Fraction(f) + X * Fraction(right) + Y * Fraction(up) for f, right, up in axes]
        b = [Fraction(e) - Fraction(float(x)) for e, x in zip(camera.eye, c, strict=True)]
        bw = sum(x * y for x, y in zip(b, w, strict=True))
        return bw * bw - sum(x * x for x in w) * (sum(x * x for x in b) - Fraction(float(r)) ** 2)


def _agree(colours: list[Vec]) -> bool:
    """Whether no branch matters: all combinations give the same colour, as far as it can be told."""
    return bool(colours) and all(
        arb(part).overlaps(arb(first)) for c in colours for part, first in zip(c, colours[0], strict=True)
    )


def _enclosed(values: list[Any]) -> tuple[float, float]:
    """A double and a bound that hold every value: the middle of the hull, and the farthest end from it."""
    hull = arb(values[0])
    for value in values[1:]:
        hull = hull.union(arb(value))
    middle = float(hull.mid())
    bound = float((hull - arb(middle)).abs_upper())
    return middle, float(np.nextafter(bound, np.inf)) if bound else 0.0
