"""Goldens: stored truth, with its bound, its provenance, and a way to find out that it still stands."""

from oracles.golden.making import make
from oracles.golden.record import Golden, GoldenError, load
from oracles.golden.verifying import verify

__all__ = ["Golden", "GoldenError", "load", "make", "verify"]
