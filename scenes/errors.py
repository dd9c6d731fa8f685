"""What can be wrong with a scene file, said so that its author can mend it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class SceneError(Exception):
    """A scene that cannot be used.

    message: what is wrong; place: file and path (or line) inside it; got: the
    offending value; hint: what was expected instead.
    """

    message: str
    place: str
    got: str = ""
    hint: str = ""

    def __str__(self) -> str:
        got = f" (got {self.got})" if self.got else ""
        hint = f"; expected {self.hint}" if self.hint else ""
        return f"{self.place}: {self.message}{got}{hint}"
