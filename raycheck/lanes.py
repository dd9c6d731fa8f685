"""Which lanes this machine has."""

from __future__ import annotations

from importlib.util import find_spec

from reference_tracer import llvm


def best_lanes() -> str:
    """DrJit where it works, NumPy elsewhere: the results are the same."""
    return "drjit" if find_spec("drjit") and llvm.find() else "numpy"
