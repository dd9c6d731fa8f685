"""A stochastic tracer's check: renders of seeds of their own, judged by their mean."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from oracles.images import Picture
from oracles.statistics import Found, Samples, area_average, judge
from oracles.truth import Truth
from raycheck.subjects import Attempt, Subject
from scenes.model import Scene

RUNS = 16
"""Renders of a scene, and units of the reference: Welch's t has about 25 degrees of freedom or more."""
UNITS = 32
REFERENCE_SEED = 20
"""The reference draws numbers of its own, always the same: equal runs give equal bytes."""


@dataclass(frozen=True)
class Sampling:
    """The tracer's mean picture with its verdict, and what it was compared with."""

    attempt: Attempt
    found: Found
    reference: NDArray[np.float64]


def sample(subject: Subject, scene: Scene, seed: int, spp: int, expected: Truth, lanes: str) -> Attempt | Sampling:
    """Render RUNS times and judge; the attempt that gave no linear picture, if one did not."""
    values, seconds = [], 0.0
    attempt = Attempt(None, "invalid", "no render was asked for")
    for k in range(RUNS):
        attempt = subject.render(scene, seed + k)
        seconds += attempt.seconds
        if attempt.picture is None:
            return attempt
        if attempt.picture.maximum is not None:
            hint = "a stochastic tracer writes linear values (.pfm .exr .npy): the mean of display codes is no colour"
            return Attempt(None, "invalid", hint, attempt.process, seconds)
        values.append(attempt.picture.values)
    reference = area_average(scene, UNITS, REFERENCE_SEED, lanes)
    found = judge(Samples(np.array(values), spp), reference, expected)
    mean = Picture(np.mean(values, axis=0), roundoff=attempt.picture.roundoff if attempt.picture else 0.0)
    return Sampling(replace(attempt, picture=mean, seconds=seconds), found, reference.mean(axis=0))
