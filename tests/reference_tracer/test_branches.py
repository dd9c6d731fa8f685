"""Rays whose nearest object is in doubt: every branch a tracer may take lies in the hull, and none is forgotten."""

import numpy as np
import pytest

from reference_tracer import dialects
from reference_tracer.dialects import Dialect
from reference_tracer.lanes import branches, sloppy
from reference_tracer.lanes.affine import Affine
from reference_tracer.lanes.balls import Balls
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import backend, enclose, narrow
from reference_tracer.lanes.span import colours
from reference_tracer.lanes.tables import Tables
from reference_tracer.lanes.wavefront import HIT, Wavefront
from reference_tracer.plain import PlainTracer
from reference_tracer.rulebook import LECTURE
from scenes.json_form import from_data
from scenes.random_scenes import random_scene

U = 2.0**-23
SHADES = {"red": (1.0, 0.0, 0.0), "green": (0.0, 1.0, 0.0), "white": (1.0, 1.0, 1.0), "grey": (0.5, 0.5, 0.5)}


def scene_of(objects, materials=None, depth=0, lights=(), forward=(0.0, 0.0, 1.0), background=(0.0, 0.0, 1.0)):
    """One pixel, whose ray goes from the origin along `forward`."""
    dull = {
        name: {"ambient": list(shade), "diffuse": [0, 0, 0], "specular": [0, 0, 0], "shininess": 1}
        | {"reflect": [0, 0, 0], "transmit": [0, 0, 0], "index": 1.0}
        for name, shade in SHADES.items()
    }
    return from_data(
        {
            "raycheck": 1,
            "name": "doubt",
            "source": "",
            "image": {"width": 1, "height": 1, "sample": [0.5, 0.5]},
            "camera": {"eye": [0, 0, 0], "forward": list(forward), "right": [1, 0, 0], "up": [0, 1, 0]},
            "background": list(background),
            "depth": depth,
            "shadows": False,
            "display": "lecture",
            "materials": dull | (materials or {}),
            "objects": objects,
            "lights": list(lights),
        }
    )


def ball(z, colour, radius=1.0, x=0.0):
    return {"shape": "sphere", "center": [x, 0.0, z], "radius": radius, "material": colour}


def wall(z, colour):
    return {"shape": "plane", "normal": [0.0, 0.0, -1.0], "offset": -z, "material": colour}


def looked_at(scene, offset=0.0, rules=LECTURE):
    """Lowest and highest value of each channel of the pixel, from all branches; and the doubts."""
    lanes = NumPyBackend(64)
    forms = Balls(U, scene, rules, lanes, single=True, offset=offset, ball=Affine)
    front = Wavefront(scene, rules, lanes, forms, Tables(scene, lanes), branches.hull)
    with np.errstate(all="ignore"):
        colour, doubts = front.colours(np.arange(1))
    mid, rad = (np.array([float(getattr(part, name)[0]) for part in colour]) for name in ("mid", "rad"))
    return mid - rad, mid + rad, int(doubts[0])


def holds(bounds, colour):
    low, high, _ = bounds
    return bool((low <= np.array(colour)).all() and (np.array(colour) <= high).all())


NEAR = 4e-7
"""Less than what float32 can tell at a distance of 5."""


def test_a_depth_order_in_doubt_holds_both_surfaces_and_nothing_else():
    bounds = looked_at(scene_of([wall(5.0, "red"), wall(5.0 + NEAR, "green"), wall(9.0, "white")]))
    assert bounds[2] & HIT
    assert holds(bounds, SHADES["red"])
    assert holds(bounds, SHADES["green"])
    assert not holds(bounds, SHADES["white"])
    assert not holds(bounds, (0.0, 0.0, 1.0))


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_silhouette_holds_the_sphere_and_what_is_behind(side):
    graze = 1.0 + side * 1e-8
    bare = looked_at(scene_of([ball(5.0, "red", x=graze)]))
    assert holds(bare, SHADES["red"])
    assert holds(bare, (0.0, 0.0, 1.0))
    backed = looked_at(scene_of([ball(5.0, "red", x=graze), wall(9.0, "green")]))
    assert holds(backed, SHADES["red"])
    assert holds(backed, SHADES["green"])
    assert not holds(backed, (0.0, 0.0, 1.0))


@pytest.mark.parametrize("first", range(4))
def test_every_one_of_several_candidates_is_held(first):
    names = list(SHADES)
    order = names[first:] + names[:first]
    bounds = looked_at(scene_of([wall(5.0 + k * NEAR / 4, name) for k, name in enumerate(order)]))
    for name in names:
        assert holds(bounds, SHADES[name])


def test_more_candidates_than_are_followed_leave_the_ray_anything_up_to_the_brightest():
    walls = [wall(5.0 + k * NEAR / 10, "grey") for k in range(branches.MOST + 2)]
    bounds = looked_at(scene_of([*walls[:-1], {**walls[-1], "material": "white"}]))
    assert holds(bounds, SHADES["white"])
    assert holds(bounds, (0.0, 0.0, 0.0))


def test_a_doubt_further_down_is_met_the_same_way():
    mirror = {
        "mirror": {"ambient": [0, 0, 0], "diffuse": [0, 0, 0], "specular": [0, 0, 0], "shininess": 1}
        | {"reflect": [0.5, 0.5, 0.5], "transmit": [0, 0, 0], "index": 1.0}
    }
    objects = [wall(5.0, "mirror"), wall(-5.0, "red"), wall(-5.0 - NEAR, "green"), wall(-9.0, "white")]
    bounds = looked_at(scene_of(objects, mirror, depth=1))
    assert bounds[2] & HIT
    assert holds(bounds, (0.5, 0.0, 0.0))
    assert holds(bounds, (0.0, 0.5, 0.0))
    assert not holds(bounds, (0.5, 0.5, 0.5))


def test_a_surface_within_the_start_offset_may_be_missed():
    bounds = looked_at(scene_of([wall(1e-4, "red"), wall(5.0, "green")]), offset=1e-3)
    assert holds(bounds, SHADES["red"])
    assert holds(bounds, SHADES["green"])


def test_without_a_candidate_the_hull_is_too_small(monkeypatch):
    candidates = branches._candidates

    def blind(*args):
        reach, may = candidates(*args)
        return reach, may & (np.arange(len(may)) != 1)[:, None]

    scene = scene_of([wall(5.0, "red"), wall(5.0 + NEAR, "green")])
    assert holds(looked_at(scene), SHADES["green"])
    monkeypatch.setattr(branches, "_candidates", blind)
    assert not holds(looked_at(scene), SHADES["green"])


SEEDS = range(40)


def outside(scene, rules, seed):
    """Pixels of a tracer with an error in every operation that lie outside the narrowed bound."""
    found = narrow(scene, enclose(scene, backend("numpy", 64), U, 0.0, rules), U, 0.0, rules)
    got = sloppy.render(scene, 2.0**-24, seed, rules).pixels
    return np.count_nonzero(~(np.abs(got - found.pixels) <= found.radius)), found


@pytest.mark.parametrize("seed", SEEDS)
def test_the_hull_holds_tracers_that_err_in_every_operation(seed):
    count, _ = outside(random_scene(seed), LECTURE, seed)
    assert count == 0


# The span that doubtful rays are held to

HEAVY = {
    "heavy": {"ambient": [0.5, 0.5, 0.5], "diffuse": [1, 1, 1], "specular": [1, 1, 1], "shininess": 100}
    | {"reflect": [0.9, 0.9, 0.9], "transmit": [0.8, 0.8, 0.8], "index": 1.5}
}
LAMP = {"kind": "point", "position": [0, 0, 0], "color": [1, 1, 1], "attenuation": "inverse_square"}


@pytest.mark.parametrize("mix", ["add", "lerp"])
@pytest.mark.parametrize("tir", ["none", "reflect"])
@pytest.mark.parametrize("limit", ["zero", "background", "local"])
def test_no_colour_leaves_the_span_of_its_generation(mix, tir, limit):
    rules = dialects.rules(Dialect(mix=mix, tir=tir, limit=limit))
    scene = scene_of([ball(5.0, "heavy"), wall(7.0, "heavy")], HEAVY, depth=3, lights=[LAMP]).resized(16, 12)
    tracer = PlainTracer(scene, rules)
    spans = colours(scene, rules, 2.0**-53)
    pixels = np.array([tracer.pixel(i, j) for i in range(16) for j in range(12)])
    for channel, (low, top) in enumerate(spans[0]):
        assert low <= pixels[:, channel].min()
        assert pixels[:, channel].max() <= top
    assert (pixels.min() < 0.0) <= (mix == "lerp")


def test_the_span_of_a_lerp_with_weights_above_one_goes_below_zero():
    rules = dialects.rules(Dialect(mix="lerp"))
    scene = scene_of([wall(5.0, "heavy")], HEAVY, depth=0, lights=[LAMP])
    value = PlainTracer(scene, rules).pixel(0, 0)
    assert min(value) < 0.0
    assert colours(scene, rules, U)[0][0][0] <= min(value)


def test_a_highlight_may_be_brighter_than_its_colour_by_what_rounding_makes_of_a_high_power():
    scene = scene_of([wall(5.0, "heavy")], HEAVY, lights=[LAMP])
    top = colours(scene, LECTURE, U)[0][0][1]
    exact = 0.5 + (1.0 + 1.0) / 25.0
    assert exact + ((1.0 + 8.0 * U) ** 100 - 1.0) / 25.0 <= top <= exact * 1.01


def test_a_lamp_on_a_surface_may_be_as_bright_as_it_likes():
    scene = scene_of([wall(0.0, "heavy"), wall(5.0, "heavy")], HEAVY, lights=[LAMP])
    assert colours(scene, LECTURE, U)[0][0][1] == np.inf
