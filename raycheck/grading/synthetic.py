"""A class to test on: the example tracers with known faults, alone and combined.

A fault is given twice: as an edit of the tracer's source that fits all languages, and as an edit of the
scene that makes a right tracer draw what the faulty one draws. The second says, without running the
first, which rungs the fault touches.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle, islice
from pathlib import Path

from raycheck.examples import examples
from raycheck.skeleton import LANGUAGES
from scenes.model import Material, PointLight, Scene


@dataclass(frozen=True)
class Fault:
    """pattern, replacement: of the source, each hit at least once; as_scene: the same by the scene."""

    name: str
    pattern: str
    replacement: str
    as_scene: Callable[[Scene], Scene]


def _materials(change: Callable[[Material], Material]) -> Callable[[Scene], Scene]:
    def edit(scene: Scene) -> Scene:
        return scene.model_copy(update={"materials": {name: change(m) for name, m in scene.materials.items()}})

    return edit


def _unattenuated(scene: Scene) -> Scene:
    lights = tuple(
        light.model_copy(update={"attenuation": "none"})
        if isinstance(light, PointLight) and light.attenuation == "inverse_square"
        else light
        for light in scene.lights
    )
    return scene.model_copy(update={"lights": lights})


def _cornered(scene: Scene) -> Scene:
    return scene.model_copy(update={"image": scene.image.model_copy(update={"sample": (0.0, 0.0)})})


FAULTS = (
    Fault(
        "no-shadows",
        r"s\.shadows (?:&&|and) shadowed\(s, p, i, d\)",
        "1 > 2",
        lambda scene: scene.model_copy(update={"shadows": False}),
    ),
    Fault(
        "one-generation-less",
        r"generation ===? s\.depth",
        "generation + 1 >= s.depth",
        lambda scene: scene.with_depth(max(0, scene.depth - 1)),
    ),
    Fault("no-inverse-square", r"1(\.0)? / \(d \* d\)", r"1\1", _unattenuated),
    Fault("corner-sample", r"\+ ?s\.s([xy])\b", r"+ (s.s\1 - s.s\1)", _cornered),
    Fault(
        "index-inverted",
        r"refraction\(v, n, leaving, (?=m\.)",
        "refraction(v, n, leaving == (1 > 2), ",
        _materials(lambda m: m.model_copy(update={"index": 1.0 / m.index})),
    ),
    Fault(
        "highlight-doubled",
        r"(m\.specular(?: \* |, |\.times\())gloss",
        r"\1(gloss + gloss)",
        _materials(lambda m: m.model_copy(update={"specular": tuple(2.0 * x for x in m.specular)})),
    ),
)

COMBINATIONS: tuple[tuple[Fault, ...], ...] = (
    (),
    *((fault,) for fault in FAULTS),
    (FAULTS[0], FAULTS[3]),
    (FAULTS[1], FAULTS[4]),
    (FAULTS[2], FAULTS[5]),
)


@dataclass(frozen=True)
class Member:
    """One submission of the class."""

    language: str
    faults: tuple[Fault, ...]

    @property
    def name(self) -> str:
        """Language and faults."""
        return "-and-".join([self.language, *(fault.name for fault in self.faults)])

    def as_scene(self, scene: Scene) -> Scene:
        """The scene of which a right tracer draws what this one draws."""
        for fault in self.faults:
            scene = fault.as_scene(scene)
        return scene


def members(count: int, languages: Sequence[str] = tuple(LANGUAGES)) -> list[Member]:
    """The first so many of the class: every language with every combination, languages taking turns."""
    pairs = (Member(language, combination) for combination in cycle(COMBINATIONS) for language in languages)
    return list(islice(pairs, min(count, len(languages) * len(COMBINATIONS))))


def write(member: Member, folder: Path) -> Path:
    """Hand the member's submission in to a folder; return its path."""
    source = examples() / f"{member.language}_lecture"
    target = folder / member.name
    target.mkdir(parents=True)
    for path in _sources(source):
        text = path.read_text("utf-8")
        if path.stem.lower() == "tracer":
            text = _edited(text, member)
            (target / path.name).write_text(text, "utf-8")
        else:
            shutil.copy(path, target)
    return target


def _sources(folder: Path) -> Iterator[Path]:
    return (p for p in sorted(folder.iterdir()) if p.name == "Makefile" or p.suffix not in ("", ".class", ".pyc"))


def _edited(text: str, member: Member) -> str:
    for fault in member.faults:
        text, hits = re.subn(fault.pattern, fault.replacement, text)
        if not hits:
            raise ValueError(f"{member.language}: nothing to edit for the fault {fault.name}")
    return text


RUBRIC = """
name = "small"
[[group]]
name = "rays"
points = 8
rungs = ["pixel-corner", "pixel-centre", "off-centre-camera"]
[[group]]
name = "light"
points = 12
rungs = ["phong-10", "attenuation-inverse-square", "shadow-hard"]
[[group]]
name = "branches"
points = 20
rungs = ["mirror-imperfect", "facing-mirrors-3", "glass-sphere"]
"""
"""Of which every fault touches some and none all."""

QUICK_RUBRIC = """
name = "quick"
[[group]]
name = "a"
points = 3
rungs = ["background"]
[hidden]
points = 2
scenes = 1
[limits]
render = 20
"""
_QUICK = """
import struct, sys
words = {line.split()[0]: line.split()[1:] for line in open(sys.argv[1]) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
level = [float(w) for w in words["background"]]
with open(sys.argv[2], "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *level) * (width * height))
"""


def write_quick(folder: Path, count: int) -> Path:
    """Submissions that are quickly done, every third of them wrong, and the rubric for them beside; their folder."""
    (folder / "rubric.toml").write_text(QUICK_RUBRIC, "utf-8")
    for k in range(count):
        one = folder / "class" / f"student-{k:02}"
        one.mkdir(parents=True)
        text = _QUICK if k % 3 else _QUICK.replace("*level", "*[1.0, 2.0, 3.0]")
        (one / "tracer.py").write_text(text, "utf-8")
        render = 'render = ["python3", "-S", "tracer.py", "{scene}", "{image}"]'
        (one / "raycheck.toml").write_text(f'[tracer]\nname = "{k}"\n{render}\n', "utf-8")
    return folder / "class"
