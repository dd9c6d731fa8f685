"""Speed against accuracy of a class: a dot for each submission that was timed; the best corner is the upper right."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from markupsafe import Markup

from reports.drawings import LogScale, picture, tag
from reports.format import times

WIDTH, HEIGHT = 640.0, 330.0
LEFT, RIGHT, TOP, BOTTOM = 76.0, 600.0, 34.0, 276.0
NONE = 14.0
"""Where those without a wrong pixel are: a line of their own above the logarithmic axis."""
FEWEST = 1e-5
"""Shares of wrong pixels below this are drawn at the axis's upper end: less than a pixel of a submission's pictures."""


@dataclass(frozen=True)
class Dot:
    """speed: times as fast as the reference tracer; outside: share of wrong pixels; place: its page's."""

    name: str
    place: str
    speed: float
    outside: float


def scatter(dots: Sequence[Dot]) -> Markup:
    """The chart; empty without dots."""
    if not dots:
        return Markup("")
    x = LogScale(*_decades([dot.speed for dot in dots]), LEFT, RIGHT)
    y = LogScale(FEWEST, 1.0, TOP, BOTTOM)
    parts = [*_across(x), *_up(y), *(_dot(dot, x, y) for dot in dots)]
    return picture(WIDTH, HEIGHT, "Speed against the share of wrong pixels", *parts, class_="class-scatter")


def _decades(values: Sequence[float]) -> tuple[float, float]:
    """The powers of ten around the values and around 1, which is the reference tracer's."""
    low, high = min(1.0, *values), max(1.0, *values)
    return 10.0 ** math.floor(math.log10(low) - 0.05), 10.0 ** math.ceil(math.log10(high) + 0.05)


def _across(x: LogScale) -> list[Markup]:
    parts = []
    for value in x.decades():
        at = x(value)
        look = "own" if value == 1.0 else "grid"
        parts.append(tag("line", x1=at, x2=at, y1=NONE, y2=BOTTOM, class_=look))
        parts.append(tag("text", f"{value:g}×", x=at, y=BOTTOM + 16, class_="tick mid"))
    middle = (LEFT + RIGHT) / 2
    told = "times as fast as the reference tracer"
    return [*parts, tag("text", told, x=middle, y=BOTTOM + 38, class_="axis-name mid")]


def _up(y: LogScale) -> list[Markup]:
    rows = [(y(value), f"{100 * value:g} %") for value in y.decades()]
    parts = []
    for at, words in [(NONE, "none"), *rows]:
        parts.append(tag("line", x1=LEFT, x2=RIGHT, y1=at, y2=at, class_="grid"))
        parts.append(tag("text", words, x=LEFT - 8, y=at + 3.5, class_="tick end"))
    turned = {"transform": f"rotate(-90 12 {(TOP + BOTTOM) / 2:g})"}
    return [*parts, tag("text", "wrong pixels", x=12.0, y=(TOP + BOTTOM) / 2, class_="axis-name mid", **turned)]


def _dot(dot: Dot, x: LogScale, y: LogScale) -> Markup:
    up = y(dot.outside) if dot.outside > 0.0 else NONE
    told = f"{dot.name}: {times(dot.speed)} as fast, {100 * dot.outside:.2g} % of the pixels wrong"
    look = "dot" if dot.outside == 0.0 else "dot wrong"
    circle = tag("circle", cx=x(dot.speed), cy=up, r=5.0, class_=look)
    return tag("a", tag("title", told), circle, href=dot.place)
