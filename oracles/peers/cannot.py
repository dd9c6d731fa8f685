"""What a peer has no words for."""

from __future__ import annotations


class CannotSayError(Exception):
    """A scene outside the peer's language; the message says why."""
