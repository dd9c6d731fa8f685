"""From a subject to its prober."""

from __future__ import annotations

from raycheck.probes.client import ProbeClient
from raycheck.probes.inprocess import PythonProber, ReferenceProber
from raycheck.probes.prober import Prober
from raycheck.subjects import Subject
from raycheck.subjects.command import CommandSubject
from raycheck.subjects.fault import FaultSubject
from raycheck.subjects.inprocess import PythonSubject, ReferenceSubject


def prober_of(subject: Subject) -> Prober | None:
    """How the subject answers formula by formula; None where it offers no way."""
    match subject:
        case CommandSubject() if subject.manifest.probe is not None:
            return ProbeClient(
                subject.manifest.probe,
                subject.folder,
                subject.spec,
                subject.precision,
                room=subject.room,
                budget=subject.probe_budget,
            )
        case ReferenceSubject():
            return ReferenceProber(subject.arithmetic, subject.bits)
        case FaultSubject():
            return ReferenceProber("numpy", subject.bits, subject.fault)
        case PythonSubject():
            prober = PythonProber(lambda: subject.tracer, subject.module, subject.attribute, subject.precision)
            return prober if prober.open() else None
    return None
