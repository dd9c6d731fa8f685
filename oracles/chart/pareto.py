"""Which points are worth having."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from oracles.measurement import Point


def with_frontier(points: Sequence[Point]) -> list[Point]:
    """The points of each panel, those marked that no right one beats in time and error at once; by time."""
    panels = dict.fromkeys(point.panel for point in points)
    return [marked for panel in panels for marked in _marked(p for p in points if p.panel == panel)]


def is_right(point: Point) -> bool:
    """Whether a point may stand on a frontier: it has an error, and no wrong decision."""
    return point.error is not None and point.wrong == 0.0


def _marked(points: Iterable[Point]) -> list[Point]:
    best = float("inf")
    found = []
    for point in sorted(points, key=lambda p: (p.seconds, p.error if p.error is not None else best)):
        worth = is_right(point) and point.error is not None and point.error < best
        if worth and point.error is not None:
            best = point.error
        found.append(point.model_copy(update={"frontier": worth}))
    return found
