"""The smallest scene that still fails, found by leaving out and rounding."""

from oracles.shrinking.edits import Pixel
from oracles.shrinking.search import Fails, Limits, Step, shrink, size, words

__all__ = ["Fails", "Limits", "Pixel", "Step", "shrink", "size", "words"]
