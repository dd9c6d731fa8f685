"""The conformance suite: every rung of the ladder, asked of one subject, judged against truth."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from oracles import kept
from oracles.compare import Comparison, compare, difference
from oracles.conventions import Convention, transfer_of
from oracles.images import Picture
from oracles.images.writing import png_bytes
from oracles.inference import Exhibit, infer, worth_saying
from oracles.metrics import appearance
from oracles.statistics import Found
from oracles.truth import Truth, truth
from oracles.verdict import USABLE, Appearance, Pictures, Verdict
from raycheck.formulas import formula_of
from raycheck.known import Known
from raycheck.lanes import best_lanes
from raycheck.sampling import sample
from raycheck.subjects import Attempt, Subject
from reference_tracer.dialects import Dialect
from reference_tracer.formulas.display import encode
from scenes.catalogue import Rung
from scenes.model import Scene

ROOM = 2**29
"""Bytes of pictures kept for the search of conventions."""


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


class Hearing:
    """One subject before the suite: what it was asked, what it answered, and what that came to.

    `verdicts` asks and judges by the declared dialect; `reconsidered` judges all again by the conventions that the
    pictures follow, if these are others. `convention`: what it is judged by; `exhibits`: the pictures under it.
    """

    def __init__(self, subject: Subject, plan: Plan, folder: Path) -> None:
        self.subject, self.plan = subject, plan
        self.images = folder / "images"
        self.images.mkdir(parents=True, exist_ok=True)
        self.attempts: dict[str, Attempt] = {}
        self.exhibits: dict[str, Exhibit] = {}
        self.bytes = 0
        self.failed: set[str] = set()
        self.convention = Convention(subject.dialect)

    def verdicts(self) -> Iterator[Verdict]:
        """Verdicts in the ladder's order, pictures written to folder/images; truth is computed ahead."""
        words: dict[str, str] = {}
        with _Ahead(self.subject, self.plan) as ahead:
            for rung in self.plan.rungs:
                verdict = _settled(self.subject, self.plan, rung, words)
                if verdict is None:
                    verdict = self._asked(rung, ahead)
                elif self._worth_asking(verdict, words):
                    self._asked(rung, ahead)
                verdict = self.plan.known.apply(verdict)
                words[rung.name] = verdict.verdict
                yield verdict

    def reconsidered(self, verdicts: Sequence[Verdict], told: Callable[[str], object]) -> list[Verdict]:
        """The same verdicts, or those under the conventions that explain most pictures, which then come first."""
        if not self.failed or len(self.exhibits) < 2:
            return list(verdicts)
        found = infer(list(self.exhibits.values()), self.subject.precision, self.subject.dialect, told)
        if found == Convention(self.subject.dialect):
            return list(verdicts)
        again = {name: self._compared(exhibit, found) for name, exhibit in self.exhibits.items()}
        before = {name: name not in self.failed for name in self.exhibits}
        after = {name: comparison.word != "fail" for name, (_, comparison) in again.items()}
        if not worth_saying(before, after):
            return list(verdicts)
        self.convention = found
        reconsidered = [*self._findings(found, after), *self._under(found, again)]
        self.exhibits = {
            name: Exhibit(found.slip.undone(self.exhibits[name].picture), expected, comparison.outside)
            for name, (expected, comparison) in again.items()
        }
        return reconsidered

    def _worth_asking(self, verdict: Verdict, words: dict[str, str]) -> bool:
        """A blocked rung's picture may still tell the convention, if what blocks it is a wrong picture."""
        blocker = (verdict.blocked_by or "").removeprefix("image/")
        return verdict.verdict == "blocked" and words.get(blocker) in ("fail", "blocked") and bool(self.exhibits)

    def _asked(self, rung: Rung, ahead: _Ahead) -> Verdict:
        """Render, compare, keep the pictures."""
        if self.subject.spp is not None:
            return _sampled(self.subject, self.plan, rung, ahead, self.images, self.subject.spp)
        attempt = self.subject.render(self.plan.scene(rung), self.plan.seed)
        self.attempts[rung.name] = replace(attempt, picture=None)
        expected = ahead.truth(rung)
        if attempt.picture is None:
            verdict = _start(rung, self.plan, attempt.word or "invalid", attempt.message)
            pictures = _keep(self.images, rung.name, expected, None, None)
            return verdict.model_copy(update=_evidence(attempt) | {"pictures": pictures})
        comparison = compare(attempt.picture, expected)
        self._exhibit(rung, expected, attempt.picture, comparison)
        return self._verdict(rung, expected, attempt.picture, comparison)

    def _exhibit(self, rung: Rung, expected: Truth, picture: Picture, comparison: Comparison) -> None:
        """Keep a picture for the search of conventions, while there is room."""
        self.bytes += 4 * picture.values.nbytes  # with its truth
        if comparison.word == "fail":
            self.failed.add(rung.name)
        if self.bytes <= ROOM:
            self.exhibits[rung.name] = Exhibit(picture, expected, comparison.outside)

    def _verdict(self, rung: Rung, expected: Truth, picture: Picture, comparison: Comparison) -> Verdict:
        linear = expected.scene.display == "srgb" and picture.maximum is None
        more = "; a linear image is not asked for its display encoding" if linear else ""
        verdict = _start(rung, self.plan, comparison.word, comparison.message + more)
        pictures = _keep(self.images, rung.name, expected, picture, comparison)
        looks = _appearance(picture, expected) if comparison.word == "fail" else None
        evidence = _evidence(self.attempts[rung.name]) | {"judged": comparison.judged, "appearance": looks}
        return verdict.model_copy(update=evidence | {"pictures": pictures})

    def _compared(self, exhibit: Exhibit, found: Convention) -> tuple[Truth, Comparison]:
        """The picture judged under the conventions found."""
        if found.slip.pixel:
            expected = truth(exhibit.scene, self.subject.precision, "numpy", found.rules())
        else:
            expected = kept.truth(exhibit.scene, self.subject.precision, "numpy", found.dialect)
        expected = replace(expected, transfer=transfer_of(found.slip))
        return expected, compare(found.slip.undone(exhibit.picture), expected)

    def _findings(self, found: Convention, after: dict[str, bool]) -> Iterator[Verdict]:
        """What the pictures follow instead of what was declared: the first thing to mend, or to say."""
        told = f"; {sum(after.values())} of {len(after)} pictures are right if that is allowed for"
        if found.slip.words():
            said = " and ".join(found.slip.words())
            yield Verdict(check="convention/picture", verdict="fail", message=f"the pictures {said}{told}")
        if found.dialect != self.subject.dialect:
            lines = "; ".join(_changed(self.subject.dialect, found.dialect))
            message = f"the pictures follow another dialect{told}; say so under [tracer.dialect]: {lines}"
            yield Verdict(check="convention/dialect", verdict="fail", message=message)

    def _under(self, found: Convention, again: dict[str, tuple[Truth, Comparison]]) -> Iterator[Verdict]:
        """All rungs judged again."""
        words: dict[str, str] = {}
        for rung in self.plan.rungs:
            verdict = _settled(self.subject, self.plan, rung, words) or self._judged_again(rung, found, again)
            verdict = self.plan.known.apply(verdict)
            words[rung.name] = verdict.verdict
            yield verdict

    def _judged_again(self, rung: Rung, found: Convention, again: dict[str, tuple[Truth, Comparison]]) -> Verdict:
        if rung.name in again:
            picture = found.slip.undone(self.exhibits[rung.name].picture)
            return self._verdict(rung, again[rung.name][0], picture, again[rung.name][1])
        attempt = self.attempts.get(rung.name)
        if attempt is None:
            return _start(rung, self.plan, "undecided", "was not asked: what it builds on failed at first")
        verdict = _start(rung, self.plan, attempt.word or "undecided", attempt.message or "no room for its picture")
        return verdict.model_copy(update=_evidence(attempt))


def _changed(declared: Dialect, found: Dialect) -> list[str]:
    """The lines of a manifest that turn the declared dialect into the one found."""
    gone = [key for key in declared.other() if key not in found.other()]
    return [*found.lines(), *(f"no line {key}" for key in gone)]


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
        return kept.truth(self.plan.scene(rung), self.subject.precision, self.lanes, self.subject.dialect)

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
            "reproduce": plan.repeat.format(scene=shlex.quote(rung.asked)),
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


def _sampled(subject: Subject, plan: Plan, rung: Rung, ahead: _Ahead, images: Path, spp: int) -> Verdict:
    """Of a stochastic tracer: its mean against the pixels' averages over their areas."""
    expected = ahead.truth(rung)
    tried = sample(subject, plan.scene(rung), plan.seed, spp, expected, best_lanes())
    if isinstance(tried, Attempt):
        verdict = _start(rung, plan, tried.word or "invalid", tried.message)
        pictures = _keep(images, rung.name, expected, None, None)
        return verdict.model_copy(update=_evidence(tried) | {"pictures": pictures})
    verdict = _start(rung, plan, tried.found.word, tried.found.message)
    averaged = replace(expected, pixels=tried.reference, doubts=np.zeros_like(expected.doubts))
    pictures = _keep(images, rung.name, averaged, tried.attempt.picture, tried.found)
    return verdict.model_copy(update=_evidence(tried.attempt) | {"pictures": pictures, "sampled": tried.found.sampled})


def _appearance(picture: Picture, expected: Truth) -> Appearance:
    """How wrong a wrong picture looks; encoded ones are linear to nobody, so their shown values count twice."""
    display = expected.scene.display
    shown = encode(expected.pixels, display) / 255.0
    if picture.maximum is not None:
        got = picture.values / picture.maximum
        return appearance(shown, got, shown, got)
    return appearance(expected.pixels, picture.values, shown, encode(picture.values, display) / 255.0)


def _evidence(attempt: Attempt) -> dict[str, object]:
    return {"process": attempt.process, "seconds": attempt.seconds}


def _keep(
    images: Path, name: str, expected: Truth, picture: Picture | None, comparison: Comparison | Found | None
) -> Pictures:
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
