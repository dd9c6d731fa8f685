"""Dots on two logarithmic axes: time to the right, accuracy up; the best corner is the upper left one."""

from __future__ import annotations

import math
from collections.abc import Sequence

from markupsafe import Markup

from oracles.measurement import Panel, Point
from reports import measured
from reports.drawings import LogScale, picture, spread, tag

WIDTH, HEIGHT = 560.0, 350.0
LEFT, RIGHT, TOP, BOTTOM = 58.0, 512.0, 16.0, 296.0
FINEST = 1e-20
"""Errors below this are drawn at the upper edge, with an arrow."""


METHODS = ("lecture", "geometric", "perpendicular", "haines", "compensated", "wide", "double-word")
"""In this order the methods have the same colour in every panel."""
COLOURS = 10


def tones(points: Sequence[Point]) -> dict[str, str]:
    """A colour class for each series of a panel: its methods, or its arithmetics where the method is one."""
    names = list(dict.fromkeys(series(points, point) for point in points))
    order = METHODS if set(names) <= set(METHODS) else names
    return {name: f"tone{k % COLOURS}" for k, name in enumerate(order) if name in names}


def series(points: Sequence[Point], point: Point) -> str:
    """What a dot's colour tells: the method where there are several, else the arithmetic; of depths the arithmetic."""
    if point.panel == "depth" or len({p.name for p in points}) == 1:
        return point.kind
    return point.name


def scatter(panel: Panel, points: Sequence[Point]) -> Markup:
    """One panel."""
    drawn = [p for p in points if p.error is not None]
    if not drawn:
        return Markup("")
    x, y = _scales(drawn)
    colours = tones(points)
    parts = [*_grid(x, y, panel), *_steps(drawn, x, y)]
    parts += [_dot(p, x, y, colours[series(points, p)]) for p in sorted(drawn, key=lambda p: p.frontier)]
    parts += _labels(points, drawn, x, y, colours)
    return picture(WIDTH, HEIGHT, f"{panel.title}: time against error", *parts, class_="scatter")


def _scales(points: Sequence[Point]) -> tuple[LogScale, LogScale]:
    times = [t for p in points for t in (p.seconds, p.spread[2])]
    errors = [max(p.error or FINEST, FINEST) for p in points]

    def below(value: float) -> float:
        return float(10.0 ** math.floor(math.log10(value) - 0.15))

    def above(value: float) -> float:
        return float(10.0 ** math.ceil(math.log10(value) + 0.15))

    return (
        LogScale(below(min(times)), above(max(times)), LEFT, RIGHT),
        LogScale(below(min(errors)), above(max(errors)), TOP, BOTTOM),
    )


def _grid(x: LogScale, y: LogScale, panel: Panel) -> list[Markup]:
    parts = []
    for value in x.decades(8):
        at = x(value)
        parts.append(tag("line", x1=at, x2=at, y1=TOP, y2=BOTTOM, class_="grid"))
        parts.append(tag("text", measured.duration(value), x=at, y=BOTTOM + 15, class_="tick mid"))
    for value in y.decades(8):
        at = y(value)
        parts.append(tag("line", x1=LEFT, x2=RIGHT, y1=at, y2=at, class_="grid"))
        parts.append(tag("text", measured.power_of_ten(value), x=LEFT - 6, y=at + 3.5, class_="tick end"))
        bits = f"{max(0.0, -math.log2(value)):.0f} bit"
        parts.append(tag("text", bits, x=RIGHT + 6, y=at + 3.5, class_="tick"))
    parts.append(tag("text", f"time for {panel.per}", x=(LEFT + RIGHT) / 2, y=BOTTOM + 34, class_="axis mid"))
    middle = (TOP + BOTTOM) / 2
    turned = {"transform": f"rotate(-90 12 {middle:g})"}
    parts.append(tag("text", panel.measure, x=12.0, y=middle, class_="axis mid", **turned))
    return parts


def _steps(points: Sequence[Point], x: LogScale, y: LogScale) -> list[Markup]:
    """The frontier: right along the time, then up to the next better point."""
    best = sorted((p for p in points if p.frontier), key=lambda p: p.seconds)
    if not best:
        return []
    path = f"M{x(best[0].seconds):.1f} {BOTTOM:.1f}"
    for p in best:
        path += f" H{x(p.seconds):.1f} V{y(p.error or FINEST):.1f}"
    return [tag("path", d=f"{path} H{RIGHT:.1f}", class_="pareto")]


def _dot(p: Point, x: LogScale, y: LogScale, tone: str) -> Markup:
    at, up = x(p.seconds), y(p.error or FINEST)
    look = f"{'hollow' if p.wrong else 'full'} {tone}"
    size = 3.4 if p.precision == "float32" else 4.8
    parts = [tag("line", x1=at, x2=x(p.spread[2]), y1=up, y2=up, class_=f"whisker {tone}")]
    if p.baseline:
        parts.append(tag("circle", cx=at, cy=up, r=9, class_="ring"))
    if (p.error or 0.0) < FINEST:
        tip = f"M{at - 3:.1f} {up - 10:.1f} L{at:.1f} {up - 13:.1f} L{at + 3:.1f} {up - 10:.1f}"
        parts.append(tag("path", d=f"M{at:.1f} {up - 5:.1f} V{up - 13:.1f} {tip}", class_=f"arrow {tone}"))
    parts.append(_shape(p.kind, at, up, size, look))
    told = f"{p.name}, {p.kind}: {measured.duration(p.seconds)}, error {measured.number(p.error)}"
    if p.wrong:
        told += f", {measured.rate(p.wrong)} wrong"
    return tag("g", tag("title", told), *parts)


def _shape(kind: str, x: float, y: float, size: float, look: str) -> Markup:
    """Circle NumPy, square DrJit, triangle for numbers that prove themselves, diamond for the rest."""
    if "balls" in kind or "arb" in kind:
        h = size * 1.15
        return tag("path", d=f"M{x:.1f} {y - h:.1f} L{x + h:.1f} {y + h * 0.8:.1f} H{x - h:.1f} Z", class_=look)
    if kind.startswith("NumPy"):
        return tag("circle", cx=x, cy=y, r=size, class_=look)
    if kind.startswith("DrJit"):
        s = size * 0.9
        return tag("rect", x=x - s, y=y - s, width=2 * s, height=2 * s, class_=look)
    h = size * 1.25
    return tag(
        "path", d=f"M{x:.1f} {y - h:.1f} L{x + h:.1f} {y:.1f} L{x:.1f} {y + h:.1f} L{x - h:.1f} {y:.1f} Z", class_=look
    )


def _labels(
    points: Sequence[Point], drawn: Sequence[Point], x: LogScale, y: LogScale, colours: dict[str, str]
) -> list[Markup]:
    """Names of the frontier and of the baseline, beside their dots."""
    named = [p for p in drawn if p.frontier or p.baseline]
    one = len({p.name for p in points}) == 1
    texts: dict[tuple[str, int], Point] = {}
    for p in named:
        text = p.kind if one else p.name
        texts.setdefault((text, round(y(p.error or FINEST) / 14)), p)
    found = []
    for (text, _), p in texts.items():
        at, up = x(p.seconds), y(p.error or FINEST)
        right = at < RIGHT - 110
        found.append(
            (up - 7, text, at + 9 if right else at - 9, "start" if right else "end", colours[series(points, p)])
        )
    placed = spread([(up, str(k), "") for k, (up, *_) in enumerate(found)], 12.0)
    parts = []
    for up, k, _ in placed:
        _, text, at, side, tone = found[int(k)]
        parts.append(tag("text", text, x=at, y=up, class_=f"label {side} {tone}"))
    return parts
