"""Laws of light: it adds, it scales, and it comes from somewhere."""

from __future__ import annotations

from oracles.laws.dice import Dice
from oracles.laws.pictures.law import Studio, law
from oracles.laws.pictures.moves import same
from oracles.laws.pictures.sets import changed, dimmed, lit, moved, recoloured, stage
from oracles.laws.pictures.sight import Sight
from scenes.model import PointLight, Scene

LAMP = "Light Position"
EFFECT = "Phong's effect Result"
BLACK = (0.0, 0.0, 0.0)


@law("image/lights-add", "two lamps give what each gives alone", LAMP, "RGB(l1 + l2) + RGB(none) = RGB(l1) + RGB(l2)")
def lights_add(dice: Dice, studio: Studio) -> Sight:
    """Light is linear: it is neither averaged nor clamped before the display.

    The dark picture holds what needs no lamp.
    """
    scene = stage(dice, studio.features)
    both, none = studio.show(scene), studio.show(changed(scene, lights=()))
    first, second = (studio.show(changed(scene, lights=(lamp,))) for lamp in scene.lights)
    return both + none - first - second


@law("image/light-scales", "a lamp twice as bright gives twice as much", LAMP, "RGB(2l) - RGB(l) = RGB(l) - RGB(none)")
def light_scales(dice: Dice, studio: Studio) -> Sight:
    """Linearity in the lamp's colour; shadows and highlights keep their places."""
    scene = stage(dice, studio.features)
    double = studio.show(dimmed(scene, (2.0, 2.0)))
    return double - studio.show(scene) * 2.0 + studio.show(changed(scene, lights=()))


@law("image/split-lamp", "two lamps of half the light in one place are one lamp", LAMP, "RGB(l) = RGB(l/2 + l/2)")
def split_lamp(dice: Dice, studio: Studio) -> Sight:
    """Halves are exact in binary. A tracer that adds the ambient colour for each lamp breaks it."""
    scene = stage(dice, studio.features)
    halves = dimmed(scene, (0.5, 0.5))
    return studio.show(changed(halves, lights=halves.lights * 2)) - studio.show(scene)


@law("image/black-lamp", "a black lamp lights nothing", LAMP, "color = 0: no term")
def black_lamp(dice: Dice, studio: Studio) -> Sight:
    """Its share is a product with 0, whatever stands in between."""
    scene = stage(dice, studio.features)
    return studio.show(dimmed(scene, (0.0, 0.0))) - studio.show(changed(scene, lights=()))


@law("image/lamp-direction-length", "the length of a lamp's direction does not matter", LAMP, "i = unit(toward)")
def lamp_direction_length(dice: Dice, studio: Studio) -> Sight:
    """A direction is made unit before its cosine is taken. Eight times is exact."""
    scene = stage(dice, studio.features)
    point, sun = scene.lights
    longer = sun.model_copy(update={"toward": tuple(8.0 * x for x in sun.toward)}) if sun.kind == "directional" else sun
    return studio.show(changed(scene, lights=(point, longer))) - studio.show(scene)


def _faded(scene: Scene, kind: str, brightness: float) -> Scene:
    """Only the point lamp, fading with the distance in this way, its colour times the brightness."""
    (lamp,) = (lamp for lamp in scene.lights if isinstance(lamp, PointLight))
    colour = tuple(brightness * c for c in lamp.color)
    return changed(scene, lights=(lamp.model_copy(update={"attenuation": kind, "color": colour}),))


def _twice(scene: Scene) -> Scene:
    return moved(scene, lambda p: (2.0 * p[0], 2.0 * p[1], 2.0 * p[2]), same, 2.0)


@law("image/inverse-square", "twice as far, four times the lamp", LAMP, "α = 1/d²")
def inverse_square(dice: Dice, studio: Studio) -> Sight:
    """In a world of twice the size 1/d² falls to a quarter, which a lamp of four times the colour makes up for."""
    scene = lit(dice)
    return studio.show(_twice(_faded(scene, "inverse_square", 64.0))) - studio.show(
        _faded(scene, "inverse_square", 16.0)
    )


@law("image/inverse", "twice as far, twice the lamp", "Ray Tracing has three features", "α = 1/d")
def inverse(dice: Dice, studio: Studio) -> Sight:
    """In a world of twice the size 1/d falls to a half, which a lamp of twice the colour makes up for."""
    scene = lit(dice)
    return studio.show(_twice(_faded(scene, "inverse", 8.0))) - studio.show(_faded(scene, "inverse", 4.0))


@law("image/material-adds", "diffuse and specular light add", EFFECT, "RGB(D, S) = RGB(D, 0) + RGB(0, S)")
def material_adds(dice: Dice, studio: Studio) -> Sight:
    """Each lamp's share is linear in the material's weights; ambient light and background are black here."""
    scene = changed(recoloured(lit(dice), ambient=lambda m: BLACK), background=BLACK)
    diffuse = recoloured(scene, specular=lambda m: BLACK)
    specular = recoloured(scene, diffuse=lambda m: BLACK)
    return studio.show(scene) - studio.show(diffuse) - studio.show(specular)


@law(
    "image/ambient-adds",
    "the ambient colour is added once",
    "uRT-10-RT5-Colors-Ambient_diffuse",
    "RGB(2A) - RGB(A) = RGB(A) - RGB(0)",
)
def ambient_adds(dice: Dice, studio: Studio) -> Sight:
    """Linear in the ambient colour, in every reflection too."""
    scene = stage(dice, studio.features)
    double = recoloured(scene, ambient=lambda m: tuple(2.0 * c for c in m.ambient))
    none = recoloured(scene, ambient=lambda m: BLACK)
    return studio.show(double) - studio.show(scene) * 2.0 + studio.show(none)


@law(
    "image/background-adds",
    "the background is added where rays go astray",
    "Nothing to meet",
    "RGB(2B) - RGB(B) = RGB(B) - RGB(0)",
)
def background_adds(dice: Dice, studio: Studio) -> Sight:
    """Linear in the background's colour: seen directly, in mirrors and through glass."""
    scene = stage(dice, studio.features)
    double = changed(scene, background=tuple(2.0 * c for c in scene.background))
    return studio.show(double) - studio.show(scene) * 2.0 + studio.show(changed(scene, background=BLACK))


@law("image/black", "black things before a black background are black", "Basic Buffering", "0 + 0·light = 0")
def black(dice: Dice, studio: Studio) -> Sight:
    """Every term is a product with 0: no tolerance, whatever the lamps."""
    scene = recoloured(
        changed(stage(dice, studio.features), background=BLACK),
        **dict.fromkeys(("ambient", "diffuse", "specular"), lambda m: BLACK),
    )
    return studio.show(scene)


@law("image/energy", "no pixel is brighter than its lamps can make it", EFFECT, "RGB <= A + Σ color·(D + S)")
def energy(dice: Dice, studio: Studio) -> Sight:
    """Cosine and highlight are at most 1. Local light only; the limit is that of the brightest material and channel."""
    scene = lit(dice)
    lamps = [max(lamp.color) for lamp in scene.lights]
    used = [scene.materials[thing.material] for thing in scene.objects]
    brightest = max(max(m.ambient) + sum(lamps) * (max(m.diffuse) + max(m.specular)) for m in used)
    return studio.show(scene).above(max(brightest, *scene.background))
