"""A tracer asked only as long as it answers in time: a hang in every scene must not cost the evening."""

from __future__ import annotations

from raycheck.subjects import Attempt, Subject
from scenes.model import Scene

ENOUGH = 3
"""Timeouts after which nothing more is asked."""


class Patience:
    """The same subject, told to be silent after ENOUGH timeouts."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._late = 0
        self.name, self.spec, self.precision = subject.name, subject.spec, subject.precision
        self.scene_form, self.image_form = subject.scene_form, subject.image_form
        self.features, self.in_process = subject.features, subject.in_process
        self.dialect, self.spp = subject.dialect, subject.spp

    def prepare(self) -> None:
        """Build it."""
        self._subject.prepare()

    def render(self, scene: Scene, seed: int) -> Attempt:
        """One picture, or none where there were too many timeouts."""
        if self._late >= ENOUGH:
            return Attempt(None, "timeout", f"not asked: {ENOUGH} pictures before it came not in time")
        attempt = self._subject.render(scene, seed)
        self._late += attempt.word == "timeout"
        return attempt
