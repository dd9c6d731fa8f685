"""Judging tracers that draw random numbers: a wrong mean is told from noise at a stated false-alarm rate."""

from oracles.statistics.gate import Found, Samples, judge
from oracles.statistics.reference import area_average

__all__ = ["Found", "Samples", "area_average", "judge"]
