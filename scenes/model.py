"""The scene model, format version 1: validated once, frozen, shared by all rooms.

Lengths share one unit, directions need not be unit, colours are linear RGB and
not negative. The JSON Schema in `scenes/schema/scene-1.json` is generated from
these classes; a test keeps the two equal.
"""

from __future__ import annotations

import hashlib
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, model_validator

MAX_SIDE = 16384
MAX_OBJECTS = 10_000
MAX_LIGHTS = 1_000


class Frozen(BaseModel):
    """Base of all scene parts: no unknown keys, no coercion, no NaN, no mutation."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def _not_zero(vector: tuple[float, float, float]) -> tuple[float, float, float]:
    if not any(vector):
        raise ValueError("a vector other than (0, 0, 0)")
    return vector


def _integer(value: Any) -> Any:
    if type(value) is not int:  # true and 1.0 equal 1
        raise ValueError("the integer 1")
    return value


Version = Annotated[Literal[1], BeforeValidator(_integer)]
Vector = tuple[float, float, float]
Direction = Annotated[Vector, AfterValidator(_not_zero)]
Intensity = Annotated[float, Field(ge=0)]
Colour = tuple[Intensity, Intensity, Intensity]
Positive = Annotated[float, Field(gt=0)]
Unit = Annotated[float, Field(ge=0, le=1)]
Side = Annotated[int, Field(ge=1, le=MAX_SIDE)]
SceneName = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$", max_length=64)]
MaterialName = Annotated[str, Field(pattern=r"^[A-Za-z0-9_.+-]+$", max_length=64)]
Source = Annotated[str, Field(pattern=r"^[^\r\n]*$", max_length=500)]


class ImagePlane(Frozen):
    """Pixels and the sample inside each: [0, 0] the corner (the lecture), [0.5, 0.5] the centre."""

    width: Side
    height: Side
    sample: tuple[Unit, Unit]


class Camera(Frozen):
    """Ray of image-plane point (X, Y): unit(forward + X·right + Y·up) from `eye`."""

    eye: Vector
    forward: Direction
    right: Direction
    up: Direction


class Material(Frozen):
    """Weights of the shading sum; `index` is n inside over n outside."""

    ambient: Colour
    diffuse: Colour
    specular: Colour
    shininess: Annotated[int, Field(ge=1, le=1_000_000)]
    reflect: Colour
    transmit: Colour
    index: Positive


class Sphere(Frozen):
    """Points p with |p - center| = radius."""

    shape: Literal["sphere"]
    center: Vector
    radius: Positive
    material: MaterialName


class Plane(Frozen):
    """Points p with normal·p = offset, `normal` taken as given; unit for shading."""

    shape: Literal["plane"]
    normal: Direction
    offset: float
    material: MaterialName


class PointLight(Frozen):
    """Light at `position`; its colour times 1, 1/d or 1/d² at distance d."""

    kind: Literal["point"]
    position: Vector
    color: Colour
    attenuation: Literal["none", "inverse", "inverse_square"]


class DirectionalLight(Frozen):
    """Light from infinitely far, `toward` pointing to it."""

    kind: Literal["directional"]
    toward: Direction
    color: Colour


Object = Annotated[Sphere | Plane, Field(discriminator="shape")]
Light = Annotated[PointLight | DirectionalLight, Field(discriminator="kind")]


class Scene(Frozen):
    """All that a tracer needs to draw one picture."""

    raycheck: Version
    name: SceneName
    source: Source
    image: ImagePlane
    camera: Camera
    background: Colour
    depth: Annotated[int, Field(ge=0, le=16)]
    shadows: bool
    fresnel: bool = False
    display: Literal["lecture", "srgb"]
    materials: Annotated[dict[MaterialName, Material], Field(json_schema_extra={"additionalProperties": False})]
    objects: Annotated[tuple[Object, ...], Field(max_length=MAX_OBJECTS)]
    lights: Annotated[tuple[Light, ...], Field(max_length=MAX_LIGHTS)]

    @model_validator(mode="after")
    def _materials_are_known(self) -> Self:
        for k, thing in enumerate(self.objects):
            if thing.material not in self.materials:
                known = ", ".join(self.materials) or "none"
                raise ValueError(f"objects.{k}.material: a defined material ({known}), not {thing.material!r}")
        return self

    def resized(self, width: int, height: int) -> Scene:
        """The same view at another size; `right` follows the aspect ratio."""
        aspect = (width * self.image.height) / (height * self.image.width)
        image = self.image.model_copy(update={"width": width, "height": height})
        x, y, z = self.camera.right
        camera = self.camera.model_copy(update={"right": (x * aspect, y * aspect, z * aspect)})
        return self.model_copy(update={"image": image, "camera": camera})

    def with_depth(self, depth: int) -> Scene:
        """The same scene with another number of generations."""
        return self.model_copy(update={"depth": depth})

    @property
    def tie_order(self) -> tuple[int, ...]:
        """Places of the objects in the order in which equal distances are decided: spheres, then planes."""
        return tuple(sorted(range(len(self.objects)), key=lambda k: not isinstance(self.objects[k], Sphere)))

    @property
    def features(self) -> frozenset[str]:
        """Features a tracer needs for this scene, in the manifest's words."""
        used = [self.materials[thing.material] for thing in self.objects]
        found: set[str] = {str(thing.shape) for thing in self.objects} - {"sphere"}
        if self.shadows and self.lights:
            found.add("shadow")
        if self.depth and any(any(m.reflect) for m in used):
            found.add("reflect")
        if self.depth and any(any(m.transmit) for m in used):
            found.add("refract")
        if self.fresnel:
            found.add("fresnel")
        return frozenset(found)

    def content_hash(self) -> str:
        """SHA-256 over the JSON as this version writes it: the same file, the same hash."""
        return hashlib.sha256(self.model_dump_json().encode()).hexdigest()
