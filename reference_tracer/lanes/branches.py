"""The other branches of rays whose nearest object is in doubt, traced, and the hull of all.

The wavefront follows the branch that the midpoints take. Here every other object that a tracer of the
enclosed precision may find nearest is followed too, and the background where all may be missed; the colour
is the hull of what they bring. Doubts further down are met the same way. On NumPy ball lanes.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from reference_tracer.lanes.backend import State, each
from reference_tracer.lanes.ball import INFINITY, INFLATE, Doubtful
from reference_tracer.lanes.balls import HIT, lower_end
from reference_tracer.lanes.floats import Nearest
from reference_tracer.lanes.wavefront import Rays, Wavefront
from reference_tracer.vector import Vec

MOST = 4
"""Other objects followed; a ray with more may be anything up to the brightest colour."""

Lanes = NDArray[np.int64]


def hull(front: Wavefront, rays: Rays, nearest: Nearest, doubts: Lanes, generation: int) -> tuple[Vec, Any]:
    """Colours of these rays over all branches that their doubts leave open; the midpoints stay."""
    colour, found = front.follow(rays, nearest, doubts & ~HIT, generation)
    lanes = np.flatnonzero(doubts & HIT)
    if lanes.size == 0:
        return colour, found
    part, more = _all_branches(
        front, Rays(*_at(tuple(rays), lanes)), nearest.row[lanes], _at(colour, lanes), generation
    )
    found = np.array(found)
    found[lanes] |= more | HIT
    return Vec(*(_with_radius(a, lanes, b.rad) for a, b in zip(colour, part, strict=True))), found


def _all_branches(front: Wavefront, rays: Rays, taken: Lanes, colour: Vec, generation: int) -> tuple[Vec, Lanes]:
    """The hull of the branch taken, whose colour is known, and of all others; and the doubts these bring."""
    reach, may = _candidates(front, rays, taken)
    place = np.cumsum(may, axis=0)
    lanes, row = np.nonzero((may & (place <= MOST)).T)
    doubts = np.where(place.max(axis=0, initial=0) > MOST, HIT, 0)
    colour = front.numbers.bounded(colour, doubts, generation)
    if lanes.size:
        branch = Rays(*_at(tuple(rays), lanes))
        met = Nearest(front.meet_row(branch, row), row)
        brought, more = front.follow(branch, met, np.zeros_like(lanes), generation)
        colour = _widened(colour, lanes, brought)
        np.bitwise_or.at(doubts, lanes, more)
    astray = np.flatnonzero((reach == INFINITY) & (taken >= 0))
    return _widened(colour, astray, front.rules.seen(front.stray(generation))), doubts


def _candidates(front: Wavefront, rays: Rays, taken: Lanes) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """How far each ray goes at most, inf where it may meet nothing; and, objects × lanes, what else it may meet."""

    def nearer(reach: Any, distance: Any, meets: Doubtful, row: int) -> Any:
        sure = meets.value & meets.sure
        return np.minimum(reach, np.where(sure & ~np.isnan(distance.upper), distance.upper, INFINITY))

    reach = front.over_objects(rays, nearer, np.full(taken.shape, INFINITY))
    may = np.zeros((front.tables.spheres + front.tables.planes, taken.size), dtype=bool)

    def note(state: Any, distance: Any, meets: Doubtful, row: int) -> Any:
        may[row] = meets.possible & (lower_end(distance) <= reach) & (taken != row)
        return state

    front.over_objects(rays, note, reach)
    return reach, may


def _at(state: State, lanes: Lanes) -> Any:
    """The state of these lanes."""
    return each(state, lambda array: array[..., lanes])


def _with_radius(ball: Any, lanes: Lanes, radius: NDArray[np.float64]) -> Any:
    """The ball with at least these radii on these lanes, one of which may be named more than once."""
    whole = np.array(ball.rad)
    np.maximum.at(whole, lanes, radius)
    return type(ball)(ball.mid, whole, ball.precision)


def _widened(colour: Vec, lanes: Lanes, brought: Vec) -> Vec:
    """The colour with, on these lanes, radii that reach what another branch brings."""
    return Vec(*(_reaching(a, lanes, b) for a, b in zip(colour, brought, strict=True)))


def _reaching(ball: Any, lanes: Lanes, other: Any) -> Any:
    return _with_radius(ball, lanes, (np.abs(other.mid - ball.mid[lanes]) + other.rad) * INFLATE)
