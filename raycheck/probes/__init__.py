"""Probes: a tracer asked formula by formula, as a process or in this one."""

from raycheck.probes.opening import prober_of
from raycheck.probes.prober import Prober

__all__ = ["Prober", "prober_of"]
