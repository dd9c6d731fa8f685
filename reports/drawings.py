"""Drawings as SVG inside the page: colours by class where the page's light or dark decides, else by attribute."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from markupsafe import Markup

from oracles.measurement import Depth, Experiment, Frontier, Map, Question
from reports import measured


def tag(name: str, *children: str, **attributes: object) -> Markup:
    """One element; class_ for class, other underscores for hyphens. Everything is escaped but other elements."""
    words = Markup("").join(
        Markup(' {}="{}"').format(key.rstrip("_").replace("_", "-"), _short(value)) for key, value in attributes.items()
    )
    return Markup("<{0}{1}>{2}</{0}>").format(name, words, Markup("").join(children))


def _short(value: object) -> object:
    return f"{value:.6g}" if isinstance(value, float) else value


def picture(width: float, height: float, label: str, *children: str, **attributes: object) -> Markup:
    """An SVG that scales with its place and says what it shows."""
    return tag(
        "svg",
        *children,
        viewBox=f"0 0 {width:g} {height:g}",
        role="img",
        aria_label=label,
        **attributes,
    )


@dataclass(frozen=True)
class LogScale:
    """Values from low to high on pixels from start to end; beyond, clamped to the ends."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, x: float) -> float:
        share = (math.log10(min(max(x, self.low), self.high) / self.low)) / math.log10(self.high / self.low)
        return self.start + share * (self.end - self.start)

    def decades(self, most: int = 9) -> list[float]:
        """Powers of ten in the range, at most so many, evenly."""
        first, last = math.ceil(math.log10(self.low) - 1e-9), math.floor(math.log10(self.high) + 1e-9)
        step = max(1, math.ceil((last - first + 1) / most))
        return [10.0**k for k in range(first, last + 1, step)]


RAMP = ((0x1F, 0x4E, 0x79), (0x2A, 0x78, 0x8E), (0x4C, 0xA5, 0x85), (0xA9, 0xCB, 0x6A), (0xF4, 0xD0, 0x4E))
"""Errors from 10⁻¹⁶ to 1: dark blue to yellow, rising in lightness, so that it reads without colour too."""
ALARM = ((0xF0, 0xA0, 0x78), (0xB5, 0x1A, 0x2B))
"""Wrong decisions, from a few to half of all."""


def _mixed(ramp: Sequence[tuple[int, int, int]], share: float) -> tuple[str, bool]:
    """Colour at a share of the ramp, and whether ink on it should be light."""
    place = min(max(share, 0.0), 1.0) * (len(ramp) - 1)
    k = min(int(place), len(ramp) - 2)
    parts = [a + (b - a) * (place - k) for a, b in zip(ramp[k], ramp[k + 1], strict=True)]
    r, g, b = (round(part) for part in parts)
    return f"#{r:02x}{g:02x}{b:02x}", 0.3 * r + 0.59 * g + 0.11 * b < 140


def error_colour(error: float) -> tuple[str, bool]:
    """Of an error from 10⁻¹⁶ to 1."""
    return _mixed(RAMP, (math.log10(max(error, 1e-16)) + 16) / 16)


def wrong_colour(rate: float) -> tuple[str, bool]:
    """Of a share of wrong decisions; half is as bad as guessing."""
    return _mixed(ALARM, rate / 0.5)


def legend() -> tuple[list[str], list[str]]:
    """Both ramps in 24 steps."""
    return [_mixed(RAMP, k / 23)[0] for k in range(24)], [_mixed(ALARM, k / 23)[0] for k in range(24)]


CELL_W, CELL_H, LEFT, TOP = 34.0, 20.0, 52.0, 4.0


def heat(experiment: Experiment, found: Map) -> Markup:
    """One method's map: each cell the error's power of ten, or the per cent of wrong decisions."""
    xs, ys = experiment.x.values, experiment.y.values
    cells = [_cell(experiment, found, column, row) for row in range(len(ys)) for column in range(len(xs))]
    width, height = LEFT + CELL_W * len(xs), TOP + CELL_H * len(ys) + 34
    below = TOP + CELL_H * len(ys)
    labels = [
        tag("text", _tick(y), x=LEFT - 5, y=TOP + (k + 0.5) * CELL_H + 3, class_="tick end") for k, y in enumerate(ys)
    ]
    labels += [
        tag("text", _tick(x), x=LEFT + (k + 0.5) * CELL_W, y=below + 13, class_="tick mid") for k, x in enumerate(xs)
    ]
    labels.append(tag("text", experiment.x.name, x=LEFT + CELL_W * len(xs) / 2, y=below + 29, class_="axis mid"))
    title = f"{found.method}, {found.precision}: {experiment.title}"
    return picture(width, height, title, *cells, *labels, class_="heat")


def _cell(experiment: Experiment, found: Map, column: int, row: int) -> Markup:
    wrong, error = found.wrong[row][column], found.error[row][column]
    x, y = LEFT + column * CELL_W, TOP + row * CELL_H
    box = {"x": x + 0.5, "y": y + 0.5, "width": CELL_W - 1, "height": CELL_H - 1, "rx": 2}
    where = f"{_tick(experiment.x.values[column])}, {_tick(experiment.y.values[row])}"
    if wrong is None:
        return tag("rect", class_="void", **box)
    if wrong > 0:
        fill, light = wrong_colour(wrong)
        text = f"{max(1, round(100 * wrong))}%"
    elif error is None:
        return tag("rect", class_="void", **box)
    else:
        fill, light = error_colour(error)
        text = str(math.floor(math.log10(error))) if error > 0 else "0"
    told = f"{where}: {measured.rate(wrong)} wrong, error {measured.number(error)}"
    ink = tag(
        "text",
        text.replace("-", "−"),
        x=x + CELL_W / 2,
        y=y + CELL_H / 2 + 3.6,
        class_="on-dark" if light else "on-light",
    )
    return tag("g", tag("title", told), tag("rect", fill=fill, **box), ink)


def _tick(x: float) -> str:
    """An axis value: short numbers as they are, others as a power of ten where they are one."""
    if x == 0 or 0.01 <= abs(x) < 1000:
        return f"{x:g}"
    return measured.number(x)


BAR_LEFT, BAR_WIDTH, BAR_STEP = 118.0, 560.0, 22.0


def frontiers(question: Question, found: Iterable[Frontier]) -> Markup:
    """Reach of each method on one logarithmic axis: a dot for float32, a square for float64, a tick for the law."""
    own = list(found)
    methods = list(dict.fromkeys(f.method for f in own))
    values = [v for f in own for v in (f.reach, f.predicted) if v]
    if not values:
        return Markup("")
    low, high = 10.0 ** math.floor(math.log10(min(values))), 10.0 ** math.ceil(math.log10(max(values)))
    ends = (BAR_LEFT, BAR_LEFT + BAR_WIDTH) if question.farther == "up" else (BAR_LEFT + BAR_WIDTH, BAR_LEFT)
    scale = LogScale(low, high, *ends)
    height = BAR_STEP * len(methods) + 40
    grid = [_grid_line(scale(x), x, height) for x in scale.decades()]
    marks = [_reach(f, scale, 10 + BAR_STEP * (methods.index(f.method) + 0.5)) for f in own]
    names = [
        tag("text", name, x=BAR_LEFT - 10, y=14 + BAR_STEP * (k + 0.5), class_="tick end who")
        for k, name in enumerate(methods)
    ]
    unit = tag("text", question.unit, x=BAR_LEFT + BAR_WIDTH / 2, y=height - 2, class_="axis mid")
    return picture(BAR_LEFT + BAR_WIDTH + 30, height, question.title, *grid, *names, *marks, unit, class_="bars")


def _grid_line(at: float, value: float, height: float) -> Markup:
    line = tag("line", x1=at, x2=at, y1=8, y2=height - 28, class_="grid")
    return line + tag("text", measured.power_of_ten(value), x=at, y=height - 16, class_="tick mid")


def _reach(found: Frontier, scale: LogScale, y: float) -> Markup:
    kind = "single" if found.precision == "float32" else "double"
    y += -3.5 if kind == "single" else 3.5
    parts = []
    if found.predicted:
        at = scale(found.predicted)
        parts.append(tag("line", x1=at, x2=at, y1=y - 5, y2=y + 5, class_=f"law {kind}"))
    if found.reach is not None:
        at = scale(found.reach)
        parts.append(tag("line", x1=BAR_LEFT, x2=at, y1=y, y2=y, class_=f"stem {kind}"))
        parts.append(tag("circle", cx=at, cy=y, r=4.2, class_=f"{kind}{' open' if found.open else ''}"))
    told = f"{found.method}, {found.precision}: {measured.number(found.reach)}"
    told += " (no failure found)" if found.open else f", law {measured.number(found.predicted)}"
    return tag("g", tag("title", told), *parts)


def depths(found: Sequence[Depth]) -> Markup:
    """99 % quantile and largest error of the pixels by depth, a line a method and precision."""
    width, height, left, bottom = 720.0, 250.0, 60.0, 210.0
    values = [v for d in found for v in (d.most, d.largest) if v > 0]
    if not values:
        return Markup("")
    scale = LogScale(
        10.0 ** math.floor(math.log10(min(values))), 10.0 ** math.ceil(math.log10(max(values))), bottom, 12
    )
    deepest = max(d.depth for d in found)

    def across(depth: int) -> float:
        return left + 20 + (width - left - 190) * depth / max(1, deepest)

    parts = []
    for value in scale.decades(8):
        parts.append(tag("line", x1=left, x2=width - 160, y1=scale(value), y2=scale(value), class_="grid"))
        parts.append(tag("text", measured.power_of_ten(value), x=left - 6, y=scale(value) + 4, class_="tick end"))
    parts += [tag("text", str(k), x=across(k), y=bottom + 16, class_="tick mid") for k in range(deepest + 1)]
    parts.append(tag("text", "depth", x=across(deepest) / 2 + left / 2, y=bottom + 34, class_="axis mid"))
    lines = groupby(sorted(found, key=lambda d: (d.precision, d.method)), key=lambda d: (d.precision, d.method))
    last: list[tuple[float, str, str]] = []
    for k, ((precision, method), group) in enumerate(lines):
        own = sorted(group, key=lambda d: d.depth)
        path = " ".join(f"{across(d.depth):.1f},{scale(d.largest):.1f}" for d in own)
        parts.append(tag("polyline", tag("title", f"{method}, {precision}"), points=path, class_=f"curve tone{k % 3}"))
        parts += [tag("circle", cx=across(d.depth), cy=scale(d.largest), r=3, class_=f"dot tone{k % 3}") for d in own]
        last.append((scale(own[-1].largest), f"{method}, {precision}", f"tone{k % 3}"))
    for y, text, tone in spread(last):
        parts.append(tag("text", text, x=width - 152, y=y + 4, class_=f"label {tone}"))
    return picture(width, height, "Largest error of a pixel by depth", *parts, class_="lines")


def spread(labels: Iterable[tuple[float, str, str]], step: float = 14.0) -> list[tuple[float, str, str]]:
    """Labels moved down until none covers another, in order from the top."""
    found: list[tuple[float, str, str]] = []
    for y, text, tone in sorted(labels):
        found.append((max(y, found[-1][0] + step) if found else y, text, tone))
    return found
