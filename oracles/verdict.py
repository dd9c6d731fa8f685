"""A verdict: what was asked, what came back, how far off it may be, how to ask again.

These models are also the form in which verdicts are stored; their JSON Schema
ships with the reports.
"""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

Word = Literal[
    "pass",  # inside its bound everywhere
    "fail",  # outside it somewhere
    "undecided",  # the case cannot tell at this precision
    "unsupported",  # the tracer says it lacks a feature
    "blocked",  # what it builds on failed
    "invalid",  # no usable answer
    "crash",  # the process died by a signal
    "timeout",  # no answer in time
    "error",  # the tracer said so
    "known",  # fails, and is listed as known
    "fixed",  # passes, although listed as known
]

CONFORMING: frozenset[str] = frozenset({"pass", "undecided", "unsupported", "known"})
"""Words that leave a tracer conforming."""

USABLE: frozenset[str] = frozenset({"pass", "undecided", "known", "fixed"})
"""Words of a rung on which later rungs may build."""


class Frozen(BaseModel):
    """Base of everything stored: no unknown keys, no mutation."""

    model_config = ConfigDict(extra="forbid", frozen=True, ser_json_inf_nan="strings")


class Pixel(Frozen):
    """One value of one pixel; `excess` is its distance in tolerances (inf for tolerance 0)."""

    i: int
    j: int
    channel: Literal["red", "green", "blue"]
    expected: float
    tolerance: float
    got: float
    excess: float
    unit: Literal["linear", "code"] = "linear"


class Judged(Frozen):
    """An image against its truth.

    outside: pixels with a value outside its bound; doubtful: pixels on which a decision cannot be
    made at the tracer's precision, by kind of decision; they are judged by the hull of what they
    may be. tolerance_*: quantiles of the largest tolerance of each pixel: what the scene can see.
    """

    pixels: int
    outside: int
    doubtful: dict[str, int] = Field(default_factory=dict)
    decided: int
    tolerance_median: float
    tolerance_99: float
    tolerance_worst: float
    worst: Pixel | None = None


class Sampled(Frozen):
    """A stochastic tracer's renders against the reference's mean.

    p_image, p_tile: least p-values; tiles_outside: tiles beyond their corrected rate; spots: pixels where no lawful
    mean lies; histogram: the tiles' p-values in ten equal bins, level for a right tracer; smallest_bias: relative
    bias of the whole image that would have been seen nine times in ten.
    """

    runs: int
    spp: int
    alpha: float
    p_image: float
    p_tile: float
    tiles: int
    tiles_outside: int
    spots: int
    histogram: tuple[int, ...]
    smallest_bias: float


class Appearance(Frozen):
    """Numbers that people compare pictures by; None where the package for it is not installed.

    rmse: linear; psnr: dB of what is shown, white 1; flip, delta_e_2000, delta_e_itp: means over the picture.
    """

    rmse: float
    psnr: float
    flip: float | None = None
    delta_e_2000: float | None = None
    delta_e_itp: float | None = None


class Process(Frozen):
    """What a tracer's process did."""

    command: tuple[str, ...]
    status: str
    seconds: float
    output_tail: str = ""


class Pictures(Frozen):
    """PNG files beside the results, by path relative to them."""

    expected: str | None = None
    got: str | None = None
    difference: str | None = None


class Case(Frozen):
    """The plainest case found that breaks a law, or the question that brought no usable answer.

    quantity: what the numbers are; |got - expected| <= bound was to hold (none of them where there was no answer);
    excess: the error in bounds; regime: the kind of case; run: one command that asks this case again.
    """

    quantity: str
    expected: float | None = None
    bound: float | None = None
    got: float | None = None
    excess: float | None = None
    regime: str = ""
    run: str = ""


class Shrunk(Frozen):
    """The smallest scene found that still fails as the verdict's scene does.

    file: the scene, relative to the results, also as text (empty where long); left: what it holds, in words; under:
    conventions that were allowed for, empty for the declared ones. pixel: (i, j) of its most wrong one, with its red,
    green and blue: |got - expected| <= tolerance was to hold in each. least: nothing more can be left out; otherwise
    the search was ended. run: the tracer's own command on that file; judge: the command that judges it.
    """

    file: str
    left: str
    text: str = ""
    under: str = ""
    pixel: tuple[int, int]
    expected: tuple[float, float, float]
    tolerance: tuple[float, float, float]
    got: tuple[float, float, float]
    unit: Literal["linear", "code"] = "linear"
    tries: int
    least: bool
    run: str = ""
    judge: str = ""


class Verdict(Frozen):
    """One check of one subject."""

    check: str
    verdict: Word
    message: str
    slide: str = ""
    teaches: str = ""
    formula: str = ""
    requires: tuple[str, ...] = ()
    blocked_by: str | None = None
    reproduce: str = ""
    judged: Judged | None = None
    case: Case | None = None
    shrunk: Shrunk | None = None
    sampled: Sampled | None = None
    appearance: Appearance | None = None
    process: Process | None = None
    pictures: Pictures = Pictures()
    seconds: float = 0.0


class Suspect(Frozen):
    """A known fault against a tracer's wrong pictures.

    share: of their residual that it explains alone, each picture counting alike, less what it spoils of the right
    ones; pictures: wrong ones that it explains alone. The rest is the dictionary's entry.
    """

    name: str
    group: str
    source: str
    wrong: str
    right: str
    seen: str
    mend: str
    share: float
    pictures: int


class Located(Frozen):
    """Where an error lives that no known fault explains.

    term: of the shading sum; formula: as it should be; likeness: how alike its pictures are to those of the fault
    `like`, 0 to 1; second: the next likely term; laws: those of the term's formulas that the tracer's own answers
    break.
    """

    term: str
    formula: str
    slide: str
    likeness: float
    like: str
    second: str = ""
    laws: tuple[str, ...] = ()


class Diagnosis(Frozen):
    """What explains a tracer's wrong pictures.

    kind: `named` where the faults explain every picture, wrong and right; `likely` where they explain some of the
    wrong ones; `unknown` where no known fault does. failing: wrong pictures; explained: those that the faults
    together explain; alike: faults that make the very same pictures; others: the next best alone; check: the first
    wrong picture that the faults explain, else the first; pixel: where that is wrong at first; picture: what the
    faults make of it.
    """

    kind: Literal["named", "likely", "unknown"]
    sentence: str
    failing: int
    explained: int
    share: float
    faults: tuple[Suspect, ...] = ()
    alike: tuple[str, ...] = ()
    others: tuple[Suspect, ...] = ()
    located: Located | None = None
    check: str = ""
    pixel: tuple[int, int] | None = None
    reproduce: str = ""
    picture: str | None = None


class Standing(Frozen):
    """A party against certified truth.

    p50, p99, worst: quantiles of the pixels' largest absolute error, truth's own bound added; outside: pixels beyond
    the bound of the party's own precision and storage; explained: those that its habit accounts for; at: (i, j) of
    the worst.
    """

    party: str
    precision: str
    seconds: float
    message: str = ""
    p50: float = 0.0
    p99: float = 0.0
    worst: float = 0.0
    at: tuple[int, int] = (0, 0)
    outside: int = 0
    explained: int = 0
    reason: str = ""


class Pair(Frozen):
    """Two parties: where they differ most, by how much, and which of them lies outside its bound there."""

    first: str
    second: str
    worst: float
    at: tuple[int, int]
    wrong: tuple[str, ...]


class SceneStandings(Frozen):
    """One scene: every party's standing, and every pair's worst difference."""

    scene: str
    certified: float
    """Largest bound of the certified values, in pixels that could be decided."""
    undecided: int
    standings: tuple[Standing, ...]
    pairs: tuple[Pair, ...]

    @property
    def unexplained(self) -> int:
        """Pixels outside a bound that nothing accounts for."""
        return sum(standing.outside - standing.explained for standing in self.standings)
