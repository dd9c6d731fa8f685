"""Subjects: every way a tracer can be attached."""

from raycheck.subjects.attach import attach, attach_command, dialect_of, jailed
from raycheck.subjects.subject import Attempt, Subject

__all__ = ["Attempt", "Subject", "attach", "attach_command", "dialect_of", "jailed"]
