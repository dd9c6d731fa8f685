"""Mitsuba in a variant, silent. Only the peer's own process imports this."""

from __future__ import annotations

from typing import Any


def start(variant: str) -> Any:
    """The module `mitsuba` with the variant chosen."""
    import mitsuba as mi

    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    return mi
