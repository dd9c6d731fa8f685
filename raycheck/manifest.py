"""raycheck.toml: how a tracer is built, called, and what it promises."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from raycheck.errors import UsageError
from reference_tracer.dialects import Dialect
from scenes.disk import read_bounded

FILE = "raycheck.toml"
MAX_BYTES = 2**16
Word = Annotated[str, Field(pattern=r"^[^\x00]*$")]
Words = Annotated[tuple[Word, ...], Field(min_length=1, max_length=100)]
FEATURES = ("plane", "shadow", "reflect", "refract", "fresnel")
LECTURE: tuple[Literal["plane", "shadow", "reflect", "refract"], ...] = ("plane", "shadow", "reflect", "refract")
"""What the lecture teaches; Fresnel's shares are for those who say that they have them."""


class Frozen(BaseModel):
    """Base: no unknown keys, no mutation."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class DialectTable(Frozen):
    """The [tracer.dialect] table: lawful conventions other than the scene model's."""

    sample: Literal["corner", "centre"] | None = None
    specular: Literal["phong", "blinn"] = "phong"
    specular_in_shadow: Annotated[bool, Field(strict=True)] = False
    specular_needs_light_in_front: Annotated[bool, Field(strict=True)] = True
    ambient: Literal["once", "per_light"] = "once"
    faces: Literal["both", "outward"] = "both"
    glass_shadow: Literal["full", "none"] = "full"
    limit: Literal["zero", "background", "local"] = "zero"
    mix: Literal["add", "lerp"] = "add"
    tir: Literal["none", "reflect"] = "none"
    fresnel: Literal["scene", "exact", "schlick"] = "scene"
    clamp: Literal["display", "generation"] = "display"
    lambert: Literal["1", "1/pi"] = "1"

    def choices(self) -> Dialect:
        """The dialect that the table names."""
        return Dialect(**(self.model_dump() | {"sample": self.sample or ""}))


class Manifest(Frozen):
    """The [tracer] table."""

    name: Annotated[str, Field(min_length=1, max_length=200)]
    build: Words | None = None
    render: Words
    probe: Words | None = None
    scene: Literal["text", "json"] = "text"
    image: Literal["pfm", "exr", "npy", "ppm", "png"] = "pfm"
    precision: Literal["float32", "float64"] = "float32"
    features: tuple[Literal["plane", "shadow", "reflect", "refract", "fresnel"], ...] = LECTURE
    stochastic: bool = False
    spp: Annotated[int, Field(ge=1, le=2**20, strict=True)] = 64
    timeout: Annotated[float, Field(gt=0, le=3600, strict=True)] = 30.0
    dialect: DialectTable = DialectTable()


class _File(Frozen):
    tracer: Manifest


def load(folder: Path) -> Manifest:
    """Read and validate a tracer's manifest; raise UsageError naming file, key and value."""
    path = folder / FILE
    try:
        data = read_bounded(path, MAX_BYTES)
    except OSError as error:
        hint = "a tracer's folder holds a raycheck.toml, or give its command after --"
        raise UsageError(f"{path}: {error.strerror}", hint) from None
    try:
        return _File.model_validate(tomllib.loads(data.decode("utf-8"))).tracer
    except ValidationError as error:
        raise UsageError(f"{path}: {explain(error)}") from None
    except (ValueError, RecursionError) as error:  # ValueError: TOML's and Unicode's own, and integers without end
        raise UsageError(f"{path}: not TOML: {error}") from None


def explain(error: ValidationError) -> str:
    """The first problem in one line: key, value, what was expected."""
    first = error.errors(include_url=False)[0]
    key = ".".join(str(part) for part in first["loc"])
    match first["type"]:
        case "missing":
            example = ': for example render = ["./tracer", "{scene}", "{image}"]' if key.endswith("render") else ""
            return f"key {key} is missing{example}"
        case "extra_forbidden":
            known = DialectTable.model_fields if "dialect" in first["loc"] else Manifest.model_fields
            return f"unknown key {key}; known are {', '.join(known)}"
        case _:
            return f"{key} = {first['input']!r:.60}: {first['msg']}"
