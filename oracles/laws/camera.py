"""Laws of the eye ray, and of the colour that a single ray brings. They are asked about scenes of a few numbers."""

from __future__ import annotations

import numpy as np

from oracles.laws.arrays import Reals, dot, length, scaled, unit
from oracles.laws.dice import Dice
from oracles.laws.law import Ask, Reading, law
from scenes.json_form import from_data
from scenes.model import Scene

SLIDE = "Ray Vector Calculation"
FORMULA = "X = -1 + 2x/w, Y = 1 - 2y/h, v = unit(forward + X·right + Y·up)"
WIDTH, HEIGHT = 16, 12
FORWARD, RIGHT, UP = (0.25, -0.5, 1.5), (2.0, 0.0, -0.25), (0.0, 1.5, 0.5)
"""Not orthogonal and not of one length, so that nothing is right by symmetry; all exact in float32."""

ROUNDINGS = 16.0
"""Units of u in a direction: X and Y are exact here, a sum of three vectors up to 6 times longer than it, its
length, a quotient."""

GREY = {"ambient": [0.25, 0.5, 0.75], "diffuse": [0.0] * 3, "specular": [0.0] * 3, "shininess": 1}
CLEAR = {"reflect": [0.0] * 3, "transmit": [0.0] * 3, "index": 1.0}


def scene(name: str, **changes: object) -> Scene:
    """A grey ball before a grey-blue background, seen by an oblique camera."""
    data = {
        "raycheck": 1,
        "name": name,
        "source": "L11: Ray Vector Calculation",
        "image": {"width": WIDTH, "height": HEIGHT, "sample": [0.0, 0.0]},
        "camera": {"eye": [1.0, -2.0, 0.5], "forward": FORWARD, "right": RIGHT, "up": UP},
        "background": [0.125, 0.25, 0.5],
        "depth": 0,
        "shadows": False,
        "display": "lecture",
        "materials": {"grey": GREY | CLEAR},
        "objects": [{"shape": "sphere", "center": [0.0, 0.0, 4.0], "radius": 2.0, "material": "grey"}],
        "lights": [],
    }
    return from_data(data | changes, name)


def rays(ask: Ask, i: Reals, j: Reals) -> Reals:
    """Directions of the eye rays of these pixels."""
    return ask("camera", np.stack([i, j], axis=1), scene("law-camera"))


def pixels(dice: Dice) -> tuple[Reals, Reals]:
    """Pixels (i, j) that have a mirror image about the middle: 1 <= i < width, 1 <= j < height."""
    return (1 + dice.choice(WIDTH - 1)).astype(np.float64), (1 + dice.choice(HEIGHT - 1)).astype(np.float64)


def bounds(dice: Dice) -> Reals:
    """On each component of a direction."""
    return np.full(dice.count, ROUNDINGS * dice.u)


@law("camera/unit", "an eye ray has length 1", SLIDE, "|v| = 1")
def is_unit(dice: Dice, ask: Ask) -> Reading:
    """Distances along it are lengths: the sphere's formula assumes it."""
    return Reading("|v|", length(rays(ask, *pixels(dice))), np.ones(dice.count), bounds(dice))


@law(
    "camera/corner",
    "the first pixel's ray goes through the corner of the picture",
    SLIDE,
    "v(0, 0) = unit(forward - right + up)",
)
def corner(dice: Dice, ask: Ask) -> Reading:
    """The sample [0, 0] is the corner of the pixel, X = -1 and Y = 1: y is down in the picture and up in space."""
    zero = np.zeros(dice.count)
    expected = unit(np.array([FORWARD]) - np.array([RIGHT]) + np.array([UP])) + 0.0 * zero[:, None]
    return Reading("v(0, 0)", rays(ask, zero, zero), expected, bounds(dice)[:, None])


@law("camera/middle", "the middle of the picture looks forward", SLIDE, "v(w/2, h/2) = unit(forward)")
def middle(dice: Dice, ask: Ask) -> Reading:
    """X = Y = 0: neither the aspect ratio nor the axes matter there."""
    half = np.ones(dice.count)
    expected = unit(np.array([FORWARD])) + 0.0 * half[:, None]
    return Reading("v(w/2, h/2)", rays(ask, half * WIDTH / 2, half * HEIGHT / 2), expected, bounds(dice)[:, None])


@law(
    "camera/mirror",
    "pixels mirrored about the middle see mirrored rays",
    SLIDE,
    "v(x) + v(w - x) lies in the plane of forward and up",
)
def mirror(dice: Dice, ask: Ask) -> Reading:
    """v(x) ∝ forward + X·right + Y·up and v(w - x) with -X.

    Brought to the same forward part their sum has no `right` in it.

    The parts are found with the reciprocal basis of (forward, right, up), without the formula.
    """
    i, j = pixels(dice)
    a, b = _parts(rays(ask, i, j)), _parts(rays(ask, WIDTH - i, HEIGHT - j))
    found = a[:, 1:] + b[:, 1:]
    return Reading("X + X', Y + Y'", found, np.zeros((dice.count, 2)), 8.0 * bounds(dice)[:, None])


@law(
    "camera/even", "pixels are evenly spaced on the image plane", SLIDE, "X(x + 1) - X(x) = 2/w, Y(y + 1) - Y(y) = -2/h"
)
def even(dice: Dice, ask: Ask) -> Reading:
    """The picture is flat.

    Equal steps on the plane, not equal angles; both axes have their own step (the aspect factor).
    """
    i, j = pixels(dice)
    step = _parts(rays(ask, i, j))[:, 1:] - _parts(rays(ask, i - 1.0, j - 1.0))[:, 1:]
    expected = np.array([[2.0 / WIDTH, -2.0 / HEIGHT]]) + 0.0 * step
    return Reading("steps of X, Y", step, expected, 8.0 * bounds(dice)[:, None])


def _parts(v: Reals) -> Reals:
    """(1, X, Y) of v ∝ forward + X·right + Y·up; error up to 4 times that of v for this basis."""
    basis = np.array([FORWARD, RIGHT, UP])
    found = v @ np.linalg.inv(basis)
    return found / found[:, :1]


SEEN = "Nothing to meet"


@law("trace/background", "a ray that meets nothing brings the background", SEEN, "colour = background", "trace")
def background(dice: Dice, ask: Ask) -> Reading:
    """The rays look away from the one sphere. The colour is stored as given: exact in float32, no tolerance."""
    v, _, _ = dice.frame()
    v = dice.round(np.where(v[:, 2:] < 0.0, v, -v))
    o = dice.round(dice.point(1.0) * np.array([1.0, 1.0, 0.0]))
    colour = ask("trace", np.concatenate([o, v], axis=1), scene("law-trace"))
    return Reading("colour", colour, np.array([[0.125, 0.25, 0.5]]) + 0.0 * colour, np.zeros((dice.count, 1)))


@law(
    "trace/ambient",
    "without lamps a surface has its ambient colour",
    "uRT-10-RT5-Colors-Ambient_diffuse",
    "colour = ambient",
    "trace",
)
def ambient(dice: Dice, ask: Ask) -> Reading:
    """Rays from around the eye to points within half the radius of the sphere.

    Nothing is added to the ambient colour: no tolerance.
    """
    n, _, _ = dice.frame()
    target = np.array([[0.0, 0.0, 4.0]]) + scaled(n, dice.uniform(0.0, 1.0))
    o = dice.round(dice.point(1.0))
    colour = ask("trace", np.concatenate([o, dice.round(unit(target - o))], axis=1), scene("law-trace"))
    return Reading("colour", colour, np.array([[0.25, 0.5, 0.75]]) + 0.0 * colour, np.zeros((dice.count, 1)))


LAMP = {"kind": "directional", "toward": [0.0, 0.0, -1.0], "color": [1.0, 1.0, 1.0]}


@law(
    "trace/headlight",
    "a white ball lit from the eye shows the cosine of its normal",
    "uRT-06-RT2-2DLight",
    "colour = n_z of the hit",
    "trace",
)
def headlight(dice: Dice, ask: Ask) -> Reading:
    """Parallel rays along z at the distance d from the axis of the unit ball meet it where the cosine is sqrt(1 - d²).

    Pythagoras.

    The lecture's discriminant is off by up to 6u·D² (D = 5 radii away), which moves the cosine by that over itself;
    the normal and the product add 16u.
    """
    x, y = dice.circle()
    d = dice.uniform(0.0, 0.9)
    flat = np.zeros(dice.count)
    o = dice.round(np.stack([d * x, d * y, flat], axis=1))
    v = np.stack([flat, flat, flat + 1.0], axis=1)
    white = GREY | CLEAR | {"ambient": [0.0] * 3, "diffuse": [1.0] * 3}
    ball = {"shape": "sphere", "center": [0.0, 0.0, 5.0], "radius": 1.0, "material": "white"}
    lit = scene("law-headlight", materials={"white": white}, objects=[ball], lights=[LAMP])
    colour = ask("trace", np.concatenate([o, v], axis=1), lit)
    cosine = np.sqrt(1.0 - dot(o, o))
    bound = 2.0 * 6.0 * dice.u * 25.0 / cosine + 16.0 * dice.u
    return Reading("colour", colour, cosine[:, None] + 0.0 * colour, bound[:, None])
