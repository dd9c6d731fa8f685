"""What the wavefront needs of an array library, and how a state of numbers is taken apart.

The wavefront is written once against `Backend`; NumPy and DrJit implement it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol

from numpy.typing import NDArray

from reference_tracer.vector import Vec

Array = Any
"""A one-dimensional array of the backend: reals, integers or booleans."""

State = Any
"""Nested tuples of arrays, Vec and numbers."""


class Backend(Protocol):
    """One array library at one precision."""

    name: str
    precision: int
    tile: int
    """Rays of the first generation handled at once."""

    def packets(self, values: Sequence[tuple[float, float, float, float]]) -> Array:
        """A table of rows of four reals, at least one row, never a literal."""

    def integers(self, values: Sequence[int]) -> Array:
        """A table of integers, at least one entry, never a literal."""

    def scalar(self, value: float) -> Any:
        """One real for all lanes that is no part of the kernel."""

    def count(self, n: int) -> Any:
        """A loop bound."""

    def indices(self, begin: int, end: int) -> Array:
        """The integers begin .. end-1, one a lane."""

    def zeros(self, like: Array) -> Array:
        """As many zeros of the same type."""

    def to_single(self, reals: Array) -> Array:
        """Each real rounded to float32 and back."""

    def to_real(self, integers: Array) -> Array:
        """Integers as reals."""

    def gather(self, table: Array, index: Array) -> Array:
        """table[index], for a lane of indices or a loop counter."""

    def packet(self, table: Array, row: Array) -> tuple[Array, Array, Array, Array]:
        """The four reals of a row, for a lane of rows or a loop counter."""

    def gather_or_zero(self, table: Array, index: Array) -> Array:
        """table[index], 0 for the index -1."""

    def fold(
        self, count: Any, step: Callable[[Any, State], State], state: State, wanted: Callable[[State], Array]
    ) -> State:
        """State = step(k, state) for k = 0 .. count-1, on the lanes where it is wanted.

        What a step does to other lanes must not matter: a backend may run it there or not.
        """

    def compress(self, mask: Array) -> Array:
        """The lanes where mask holds, ascending."""

    def concatenate(self, a: Array, b: Array) -> Array:
        """A followed by b."""

    def positions(self, lanes: int, index: Array, begin: int) -> Array:
        """An array of lanes entries: begin + k at index[k], -1 elsewhere."""

    def evaluate(self, state: State) -> None:
        """Compute now what has been recorded."""

    def width(self, array: Array) -> int:
        """Number of entries."""

    def numpy(self, array: Array) -> NDArray[Any]:
        """The entries as a NumPy array."""


def leaves(state: State) -> list[Array]:
    """The arrays in a state, in order."""
    if isinstance(state, tuple):
        return [leaf for part in state for leaf in leaves(part)]
    parts = getattr(state, "parts", None)
    return leaves(parts) if parts is not None else [state]


def rebuild(state: State, arrays: list[Array]) -> State:
    """A state of the same form with other arrays; consumes them from the front."""
    if isinstance(state, tuple):
        inner = [rebuild(part, arrays) for part in state]
        return Vec(*inner) if isinstance(state, Vec) else tuple(inner)
    parts = getattr(state, "parts", None)
    if parts is None:
        return arrays.pop(0)
    return state.with_parts(rebuild(parts, arrays))


def each(state: State, change: Callable[[Array], Array]) -> State:
    """The state with every array changed."""
    return rebuild(state, [change(leaf) for leaf in leaves(state)])
