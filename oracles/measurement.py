"""What measuring methods gives: maps, frontiers, named cases, points of a chart.

Frozen, and the form in which they are stored. Numbers that do not exist (a cell without hits, a
method that has no such precision) are None.
"""

from __future__ import annotations

from typing import Literal

from oracles.verdict import Frozen

Precision = Literal["float32", "float64"]
Grid = tuple[tuple[float | None, ...], ...]


class Axis(Frozen):
    """What varies along one side of a map, and at which values."""

    name: str
    values: tuple[float, ...]


class Map(Frozen):
    """One method at one precision over the axes of its experiment.

    wrong: share of wrong decisions (hit or miss, refracted or not, no number), row y, column x;
    error: the largest error among the right ones, in the experiment's measure.
    """

    method: str
    precision: Precision
    wrong: Grid
    error: Grid


class Experiment(Frozen):
    """Maps over the same inputs; measure: what `error` is."""

    name: str
    title: str
    about: str
    measure: str
    precision: Precision
    x: Axis
    y: Axis
    cases: int
    maps: tuple[Map, ...]


class Frontier(Frozen):
    """How far one method holds in one respect.

    reach: the last value of the scan before the first failure; None: it failed at the first; open: the scan
    ended without one. predicted: where the error law, an upper bound, allows the first failure.
    """

    question: str
    method: str
    precision: Precision
    reach: float | None
    open: bool
    predicted: float | None
    law: str


class Question(Frozen):
    """What a frontier asks, and which way it is better to be farther."""

    name: str
    title: str
    unit: str
    farther: Literal["up", "down"]


class Answer(Frozen):
    """What somebody makes of a named case."""

    who: str
    got: str
    right: bool


class Case(Frozen):
    """One input on which known formulas fail."""

    number: int
    title: str
    inputs: str
    truth: str
    slide: str
    answers: tuple[Answer, ...]


class Start(Frozen):
    """One start offset in one situation: shares of rays that meet their own surface, and that miss a near one."""

    offset: str
    method: str
    precision: Precision
    distance: float
    world: float
    acne: float
    leaks: tuple[float, ...]
    height: float


class Depth(Frozen):
    """Errors of a picture's values at one depth, of those whose path is certain."""

    method: str
    precision: Precision
    depth: int
    median: float
    most: float
    largest: float
    visible: float


class Point(Frozen):
    """One dot of the chart.

    seconds: of one ray or render, smallest of the rounds; spread: (quartile, median, quartile) of them; error: in the
    panel's measure, None where it has none; wrong: share of wrong decisions. frontier: no right point is
    both faster and more accurate.
    """

    panel: str
    name: str
    kind: str
    precision: str
    seconds: float
    spread: tuple[float, float, float]
    ratio: float
    error: float | None
    bits: float | None
    wrong: float
    baseline: bool
    frontier: bool


class Panel(Frozen):
    """One chart: what its axes are, and what its dots share."""

    name: str
    title: str
    about: str
    per: str
    measure: str
    tolerance: float
