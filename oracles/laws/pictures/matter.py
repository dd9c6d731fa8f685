"""Laws of recursion and matter: depth, branches without weight, glass that is not there."""

from __future__ import annotations

from oracles.laws.dice import Dice
from oracles.laws.pictures.law import Studio, law
from oracles.laws.pictures.light import BLACK
from oracles.laws.pictures.sets import changed, lit, recoloured, stage
from oracles.laws.pictures.sight import Sight

DEPTH = "Ray Tracing has three features"
BRANCHES = "Refraction with geo.tr vector"


@law(
    "image/depth-without-branches",
    "where nothing reflects or transmits, depth does not matter",
    DEPTH,
    "depth 0 = depth 3",
)
def depth_without_branches(dice: Dice, studio: Studio) -> Sight:
    """No path is longer than the eye ray, so every depth draws the same."""
    scene = lit(dice)
    return studio.show(scene.with_depth(3)) - studio.show(scene.with_depth(0))


@law(
    "image/depth-beyond-paths",
    "one mirror ball alone: no path is longer than one reflection",
    DEPTH,
    "depth 1 = depth 3",
    "reflect",
)
def depth_beyond_paths(dice: Dice, studio: Studio) -> Sight:
    """A ray that leaves a ball outward never meets it again, so every path ends after one reflection.

    A tracer whose reflected rays meet their own start sees more at depth 3.
    """
    scene = stage(dice, frozenset({"reflect"}))
    alone = changed(scene, objects=(scene.objects[1],))
    return studio.show(alone.with_depth(3)) - studio.show(alone.with_depth(1))


@law(
    "image/depth-zero",
    "at depth 0 mirrors and glass show their local colour only",
    DEPTH,
    "generation < depth",
    "reflect",
)
def depth_zero(dice: Dice, studio: Studio) -> Sight:
    """No ray is traced after the eye ray, so the branches' weights do not matter."""
    scene = stage(dice, studio.features).with_depth(0)
    plain = recoloured(scene, reflect=lambda m: BLACK, transmit=lambda m: BLACK)
    return studio.show(scene) - studio.show(plain)


@law(
    "image/weight-zero", "a branch of weight 0 is not there", BRANCHES, "transmit = 0: index does not matter", "reflect"
)
def weight_zero(dice: Dice, studio: Studio) -> Sight:
    """0 times whatever a branch would bring is 0; the index of what transmits nothing changes nothing."""
    scene = recoloured(stage(dice, studio.features), transmit=lambda m: BLACK)
    return studio.show(recoloured(scene, index=lambda m: 1.75)) - studio.show(scene)


@law(
    "image/shininess-unused",
    "without specular weight the exponent does not matter",
    "Phong Effect",
    "S = 0: s does not matter",
)
def shininess_unused(dice: Dice, studio: Studio) -> Sight:
    """The highlight is weighed by S alone, so no exponent can bring light into a surface without it."""
    scene = recoloured(lit(dice), specular=lambda m: BLACK)
    return studio.show(recoloured(scene, shininess=lambda m: 77)) - studio.show(scene)


@law(
    "image/reflect-adds",
    "what a mirror shows is weighed by its colour",
    "Mirror with No Transparency",
    "RGB(2R) - RGB(R) = RGB(R) - RGB(0)",
    "reflect",
)
def reflect_adds(dice: Dice, studio: Studio) -> Sight:
    """Linear in the weight of the reflected ray, as long as it is reflected once (depth 1)."""
    scene = stage(dice, studio.features - {"refract"}).with_depth(1)
    half = recoloured(scene, reflect=lambda m: tuple(c / 2.0 for c in m.reflect))
    none = recoloured(scene, reflect=lambda m: BLACK)
    return studio.show(scene) - studio.show(half) * 2.0 + studio.show(none)


@law("image/invisible-ball", "a clear ball of index 1 is not seen", "Refraction", "n1 = n2: t = v", "refract")
def invisible_ball(dice: Dice, studio: Studio) -> Sight:
    """It bends nothing and weighs nothing, but for two generations of each ray through it.

    Depth 2 for local light alone.

    Without shadows, which clear things cast in this model too.
    """
    scene = lit(dice).with_depth(2)
    clear = scene.materials["matte"].model_copy(
        update=dict.fromkeys(("ambient", "diffuse", "specular"), BLACK) | {"transmit": (1.0, 1.0, 1.0), "index": 1.0}
    )
    bubble = scene.objects[0].model_copy(update={"center": (0.25, 0.25, -2.5), "radius": 0.5, "material": "clear"})
    other = changed(scene, materials=scene.materials | {"clear": clear}, objects=(*scene.objects, bubble))
    return studio.show(other) - studio.show(scene)
