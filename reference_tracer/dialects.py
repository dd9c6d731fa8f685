"""The lawful conventions of other tracers, as rulebooks.

Tracers differ in things that no law settles: which point of a pixel is sampled, Phong's highlight or
Blinn's, what a ray beyond the last generation is worth. A `Dialect` names a choice for each; its
rulebook is the lecture's with those entries replaced, so truth, bounds and goldens are computed under
it. No choice touches geometry, visibility or Snell's law.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType
from typing import Any

from reference_tracer import rulebook
from reference_tracer.formulas import conventions, shading
from reference_tracer.numbers import Condition, Number
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec


@dataclass(frozen=True)
class Dialect:
    """One choice for each convention; the defaults are the scene model's.

    `sample` "" follows the scene; all other words are those of the table [tracer.dialect].
    """

    sample: str = ""
    specular: str = "phong"
    specular_in_shadow: bool = False
    specular_needs_light_in_front: bool = True
    ambient: str = "once"
    faces: str = "both"
    glass_shadow: str = "full"
    limit: str = "zero"
    mix: str = "add"
    tir: str = "none"
    fresnel: str = "scene"
    clamp: str = "display"
    lambert: str = "1"

    def __post_init__(self) -> None:
        for key, value in self.choices().items():
            if value not in CHOICES[key]:
                raise ValueError(f"{key} = {value!r}: expected one of {', '.join(map(repr, CHOICES[key]))}")

    def choices(self) -> dict[str, Any]:
        """Every convention and its choice."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def other(self) -> dict[str, Any]:
        """The choices that differ from the scene model's."""
        return {key: value for key, value in self.choices().items() if value != getattr(SCENE_MODEL, key)}

    def lines(self) -> tuple[str, ...]:
        """The lines that say it in a manifest."""
        return tuple(f"{key} = {_toml(value)}" for key, value in self.other().items())


CHOICES: Mapping[str, tuple[Any, ...]] = MappingProxyType(
    {
        "sample": ("", "corner", "centre"),
        "specular": ("phong", "blinn"),
        "specular_in_shadow": (False, True),
        "specular_needs_light_in_front": (True, False),
        "ambient": ("once", "per_light"),
        "faces": ("both", "outward"),
        "glass_shadow": ("full", "none"),
        "limit": ("zero", "background", "local"),
        "mix": ("add", "lerp"),
        "tir": ("none", "reflect"),
        "fresnel": ("scene", "exact", "schlick"),
        "clamp": ("display", "generation"),
        "lambert": ("1", "1/pi"),
    }
)
"""The choices of each convention, the scene model's first."""

SCENE_MODEL = Dialect()


def _toml(value: Any) -> str:
    return str(value).lower() if isinstance(value, bool) else f'"{value}"'


def rules(dialect: Dialect, base: Rulebook = LECTURE) -> Rulebook:
    """The base with the dialect's entries in the place of the scene model's."""
    if dialect == SCENE_MODEL:
        return base
    entries: dict[str, Any] = {"name": f"{base.name}, {', '.join(dialect.lines())}"}
    for key, value in dialect.other().items():
        entries |= _SIMPLE.get((key, value), {})
    entries["phong"] = _gloss(dialect) if _speaks_of(dialect, "specular") else base.phong
    entries["weights"] = _weights(dialect, base)
    entries["last"] = _last(dialect, entries.get("mix", base.mix), base)
    return replace(base, **entries)


_SIMPLE: dict[tuple[str, Any], dict[str, Any]] = {
    ("sample", "corner"): {"plane_point": conventions.at_corner},
    ("sample", "centre"): {"plane_point": conventions.at_centre},
    ("specular_in_shadow", True): {"shaded_light": conventions.specular_share},
    ("ambient", "per_light"): {
        "ambient_light": conventions.no_ambient,
        "add_light": conventions.add_light_and_ambient,
    },
    ("faces", "outward"): {"shading_normal": conventions.outward_normal},
    ("glass_shadow", "none"): {"blocks": conventions.opaque_blocks},
    ("limit", "local"): {"generations": lambda depth: depth + 1},
    ("mix", "lerp"): {"mix": conventions.lerp},
    ("fresnel", "schlick"): {"fresnel": conventions.schlick},
    ("clamp", "generation"): {"seen": conventions.clamped},
    ("lambert", "1/pi"): {"lambert": conventions.lambert_over_pi},
}
"""Choices that replace an entry whatever the others are."""


def _speaks_of(dialect: Dialect, word: str) -> bool:
    return any(key.startswith(word) and key != "specular_in_shadow" for key in dialect.other())


def _gloss(dialect: Dialect) -> Callable[..., Any]:
    if dialect.specular == "phong" and dialect.specular_needs_light_in_front:
        return shading.phong
    lobe = conventions.phong_lobe if dialect.specular == "phong" else conventions.blinn_lobe
    return conventions.in_front(lobe) if dialect.specular_needs_light_in_front else lobe


def _weights(dialect: Dialect, base: Rulebook) -> Callable[..., tuple[Vec, Vec]]:
    plain = base.weights if dialect.fresnel == "scene" else fresnel_on_glass
    return conventions.total_reflects(plain) if dialect.tir == "reflect" else plain


def fresnel_on_glass(
    reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Callable[[], Number]
) -> tuple[Vec, Vec]:
    """The weights times F and 1 - F on every transparent surface, and wherever the scene asks."""
    F = share()
    kept = F if asked else conventions.on_glass(transmit, F)
    return reflect * kept, transmit * (1.0 - F)


def _last(dialect: Dialect, mix: Callable[..., Vec], base: Rulebook) -> Callable[..., Vec]:
    """What a ray of the last generation brings: its branches end in what the limit is worth."""
    if dialect.mix == "add" and dialect.limit != "background":
        return base.last

    def dark(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, refracted: Vec) -> Vec:
        return mix(local, reflect, Vec(0.0, 0.0, 0.0), transmit, Vec(0.0, 0.0, 0.0))

    return {"zero": dark, "background": mix, "local": rulebook.last}[dialect.limit]
