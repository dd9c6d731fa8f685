"""The conformance suite: every rung of the ladder, asked of one subject, judged against truth."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from oracles.compare import Comparison, compare, difference
from oracles.images import Picture
from oracles.images.writing import png_bytes
from oracles.truth import Truth
from oracles.verdict import USABLE, Pictures, Verdict
from raycheck.formulas import formula_of
from raycheck.known import Known
from raycheck.lanes import best_lanes
from raycheck.subjects import Attempt, Subject
from raycheck.truths import truth
from reference_tracer.formulas.display import encode
from scenes.catalogue import Rung
from scenes.model import Scene

Report = Callable[[Verdict, int, int], None]


@dataclass(frozen=True)
class Plan:
    """What to ask: rungs, size of the pictures, seed, whether failed requirements block, and known failures."""

    rungs: Sequence[Rung]
    size: tuple[int, int] | None
    seed: int
    block: bool
    known: Known
    repeat: str
    """The command line that asks one rung again; {scene} stands for its name."""

    def scene(self, rung: Rung) -> Scene:
        """The rung's scene at the wanted size."""
        scene = rung.scene()
        return scene.resized(*self.size) if self.size else scene


def judge(subject: Subject, plan: Plan, folder: Path) -> Iterator[Verdict]:
    """Verdicts in the ladder's order, pictures written to folder/images; truth is computed ahead."""
    images = folder / "images"
    images.mkdir(parents=True, exist_ok=True)
    words: dict[str, str] = {}
    with _Ahead(subject, plan) as ahead:
        for rung in plan.rungs:
            verdict = _settled(subject, plan, rung, words) or _asked(subject, plan, rung, ahead, images)
            verdict = plan.known.apply(verdict)
            words[rung.name] = verdict.verdict
            yield verdict


class _Ahead:
    """Truths computed while the tracer runs; one thread, since a tracer in this process shares its lanes."""

    def __init__(self, subject: Subject, plan: Plan) -> None:
        self.subject, self.plan = subject, plan
        self.lanes = best_lanes()
        self.pool = ThreadPoolExecutor(1) if not subject.in_process else None
        self.pending: dict[str, Future[Truth]] = {}

    def __enter__(self) -> _Ahead:
        if self.pool:
            self.pending = {rung.name: self.pool.submit(self._compute, rung) for rung in self.plan.rungs}
        return self

    def __exit__(self, *_: object) -> None:
        if self.pool:
            self.pool.shutdown(wait=True, cancel_futures=True)

    def _compute(self, rung: Rung) -> Truth:
        return truth(self.plan.scene(rung), self.subject.precision, self.lanes)

    def truth(self, rung: Rung) -> Truth:
        """The truth of this rung, waiting for it if need be."""
        future = self.pending.pop(rung.name, None)
        return future.result() if future else self._compute(rung)


def _start(rung: Rung, plan: Plan, word: str, message: str) -> Verdict:
    return Verdict.model_validate(
        {
            "check": f"image/{rung.name}",
            "verdict": word,
            "message": message,
            "slide": rung.slide,
            "teaches": rung.teaches,
            "formula": formula_of(rung.slide),
            "requires": rung.requires,
            "reproduce": plan.repeat.format(scene=shlex.quote(rung.name)),
        }
    )


def _settled(subject: Subject, plan: Plan, rung: Rung, words: dict[str, str]) -> Verdict | None:
    """A verdict that needs no picture: a feature the tracer lacks, or a requirement that failed."""
    if subject.features is not None:
        missing = sorted(plan.scene(rung).features - set(subject.features))
        if missing:
            return _start(rung, plan, "unsupported", f"needs {', '.join(missing)}, which the tracer does not offer")
    if plan.block:
        for name in rung.requires:
            if words.get(name) == "unsupported":
                return _start(rung, plan, "unsupported", f"builds on image/{name}, which the tracer does not support")
            if words.get(name, "pass") not in USABLE:
                verdict = _start(rung, plan, "blocked", f"builds on image/{name}, which is {words[name]}")
                return verdict.model_copy(update={"blocked_by": f"image/{name}"})
    return None


def _asked(subject: Subject, plan: Plan, rung: Rung, ahead: _Ahead, images: Path) -> Verdict:
    """Render, compare, keep the pictures."""
    attempt = subject.render(plan.scene(rung), plan.seed)
    expected = ahead.truth(rung)
    if attempt.picture is None:
        verdict = _start(rung, plan, attempt.word or "invalid", attempt.message)
        pictures = _keep(images, rung.name, expected, None, None)
    else:
        comparison = compare(attempt.picture, expected)
        linear = expected.scene.display == "srgb" and attempt.picture.maximum is None
        more = "; a linear image is not asked for its display encoding" if linear else ""
        verdict = _start(rung, plan, comparison.word, comparison.message + more)
        verdict = verdict.model_copy(update={"judged": comparison.judged})
        pictures = _keep(images, rung.name, expected, attempt.picture, comparison)
    return verdict.model_copy(update=_evidence(attempt) | {"pictures": pictures})


def _evidence(attempt: Attempt) -> dict[str, object]:
    return {"process": attempt.process, "seconds": attempt.seconds}


def _keep(images: Path, name: str, expected: Truth, picture: Picture | None, comparison: Comparison | None) -> Pictures:
    """Write the PNGs that the report shows; return their names relative to the report."""
    display = expected.scene.display
    files = {"expected": encode(expected.pixels, display)}
    if picture is not None and comparison is not None:
        shown = picture.values if picture.maximum is None else None
        files["got"] = encode(shown, display) if shown is not None else _as_8_bit(picture)
        files["difference"] = difference(picture, expected, comparison.outside)
    for kind, codes in files.items():
        (images / f"{name}.{kind}.png").write_bytes(png_bytes(codes))
    return Pictures(**{kind: f"images/{name}.{kind}.png" for kind in files})


def _as_8_bit(picture: Picture) -> np.ndarray[tuple[int, ...], np.dtype[np.int64]]:
    return (picture.values * 255 // (picture.maximum or 255)).astype(np.int64)
