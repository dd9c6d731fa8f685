"""Faults of the sum over the lights, and of shadows."""

from __future__ import annotations

from typing import Any

from oracles.faults.fault import Fault, instead
from reference_tracer.formulas import shading
from reference_tracer.numbers import less, select
from reference_tracer.vector import Vec


def _times(change: Any) -> Any:
    """direct_light with another sum; change(colour, factor, diffuse, cosine, specular, gloss)."""
    return {"direct_light": change}


def _grey(colour: Vec) -> Vec:
    mean = (colour.x + colour.y + colour.z) * (1.0 / 3.0)
    return Vec(mean, mean, mean)


def _cut_at_one(colour: Vec, *terms: Any) -> Vec:
    share = shading.direct_light(colour, *terms)
    return Vec(*(select(less(1.0, part), 1.0, part) for part in share))


def _copied_channel(colour: Vec, factor: Any, diffuse: Vec, *terms: Any) -> Vec:
    return shading.direct_light(colour, factor, Vec(diffuse.x, diffuse.y, diffuse.y), *terms)


def _brightest(total: Vec, share: Vec, ambient: Vec, colour: Vec) -> Vec:
    return Vec(*(select(less(a, b), b, a) for a, b in zip(total, share, strict=True)))


def _half_shade(*terms: Any) -> Vec:
    return shading.direct_light(*terms) * 0.5


def _no_highlight(colour: Vec, factor: Any, diffuse: Vec, cosine: Any, specular: Vec, gloss: Any) -> Vec:
    return shading.direct_light(colour, factor, diffuse, cosine, specular, gloss * 0.0)


_EXAMPLE = "Example of Ray Tracing"
_DISTANCE = "How to Calculate the Distance to Point Lights"
_AMBIENT = "uRT-10-RT5-Colors-Ambient_diffuse"

_BAD = "Ex) Bad and Good Case"
_RESULT = "Phong's effect Result"

_SUM = "c = c + α*light*(diffuse*cosθ + specular*gloss);"

_BLOCKED = "if (λ > 0 && λ < d) hidden;"


def _light(name: str, slide: str, wrong: str, right: str, seen: str, mend: str, **entries: Any) -> Fault:
    return Fault(name, "light", f'L11 "{slide}"', wrong, right, seen, mend, instead(name, **entries))


def _shadow(name: str, wrong: str, right: str, seen: str, mend: str, **entries: Any) -> Fault:
    return Fault(name, "shadow", f'L11 "{_EXAMPLE}"', wrong, right, seen, mend, instead(name, **entries))


FAULTS = (
    _light(
        "light-colour-left-out",
        _RESULT,
        "c = c + α*(diffuse*cosθ + specular*gloss);",
        _SUM,
        "coloured lamps shine white",
        "times the light's colour",
        **_times(lambda c, f, d, cos, s, g: (d * cos + s * g) * f),
    ),
    _light(
        "light-colour-as-grey",
        _RESULT,
        "c = c + α*mean(light)*(...);",
        _SUM,
        "coloured lamps shine grey",
        "channel by channel",
        **_times(lambda c, *t: shading.direct_light(_grey(c), *t)),
    ),
    _light(
        "highlight-in-the-body-colour",
        _RESULT,
        "c = α*light*diffuse*(cosθ + specular*gloss);",
        _SUM,
        "highlights take the colour of the ball",
        "specular has a colour of its own",
        **_times(lambda c, f, d, cos, s, g: (c * f) * (d * cos + (s * d) * g)),
    ),
    _light(
        "highlight-not-attenuated",
        _RESULT,
        "c = α*light*diffuse*cosθ + light*specular*gloss;",
        _SUM,
        "highlights far from the lamp are too bright",
        "α multiplies both terms",
        **_times(lambda c, f, d, cos, s, g: (c * f) * (d * cos) + c * (s * g)),
    ),
    _light(
        "highlight-always-white",
        _RESULT,
        "c = α*(light*diffuse*cosθ + specular*gloss);",
        _SUM,
        "coloured lamps make white highlights",
        "the light's colour multiplies both terms",
        **_times(lambda c, f, d, cos, s, g: (c * f) * (d * cos) + s * (g * f)),
    ),
    _light(
        "each-light-cut-at-1",
        _BAD,
        "share = min(share, 1);",
        "clamp once, when the byte is written",
        "mirrors and bright lamps lose light",
        "clamp the picture, never a sum",
        direct_light=_cut_at_one,
    ),
    _light(
        "green-for-blue",
        _RESULT,
        "b = light.b*diffuse.g*cosθ;",
        "b = light.b*diffuse.b*cosθ;",
        "blue is wrong",
        "a line copied for the next channel",
        direct_light=_copied_channel,
    ),
    _light(
        "ambient-left-out",
        _AMBIENT,
        "c = 0;",
        "c = ambient;",
        "shadows are black",
        "the sum begins with ambient",
        ambient_light=lambda ambient: ambient * 0.0,
    ),
    _light(
        "ambient-of-its-own",
        _AMBIENT,
        "c = ambient + 0.1;",
        "c = ambient;",
        "nothing is black",
        "the scene says all the light there is: the material's ambient",
        ambient_light=lambda ambient: Vec(*(part + 0.1 for part in ambient)),
    ),
    _light(
        "ambient-for-each-light",
        _AMBIENT,
        "for each light: c = c + ambient + ...;",
        "c = ambient; for each light: c = c + ...;",
        "with two lights everything is too bright",
        "ambient once, before the loop",
        ambient_light=lambda ambient: ambient * 0.0,
        add_light=lambda total, share, ambient, colour: (total + ambient) + share,
    ),
    _light(
        "last-light-only",
        _EXAMPLE,
        "c = ambient + share;",
        _SUM,
        "only the last lamp shines",
        "add to c",
        add_light=lambda total, share, ambient, colour: ambient + share,
    ),
    _light(
        "brightest-light-only",
        _EXAMPLE,
        "c = max(c, share);",
        _SUM,
        "lamps do not add up",
        "light adds",
        add_light=_brightest,
    ),
    _shadow(
        "no-shadows",
        "c = c + share;",
        _BLOCKED,
        "no shadows",
        "ask for what stands between",
        blocks=lambda d, light, opaque: less(d, d),
    ),
    _shadow(
        "shadow-from-behind-the-lamp",
        "if (λ > 0) hidden;",
        _BLOCKED,
        "things behind the lamp cast shadows",
        "only λ < d stands between",
        blocks=lambda d, light, opaque: less(0.0, d),
    ),
    _shadow(
        "shadow-only-from-behind",
        "if (λ > d) hidden;",
        _BLOCKED,
        "shadows are where none should be",
        "λ < d stands between",
        blocks=lambda d, light, opaque: less(light, d),
    ),
    _shadow(
        "shadow-squared-distance",
        "if (λ*λ < d) hidden;",
        _BLOCKED,
        "shadows of far things are missing",
        "compare λ with d, or λ² with d²",
        blocks=lambda d, light, opaque: less(d * d, light),
    ),
    _shadow(
        "shadow-up-to-1",
        "if (λ < 1) hidden;  // i made unit",
        _BLOCKED,
        "only near things cast shadows, also from behind lamps",
        "λ < 1 is right for i = k - p only; a unit i needs λ < d",
        blocks=lambda d, light, opaque: less(d, 1.0),
    ),
    _shadow(
        "shadow-bias-too-large",
        "if (λ > 0.3 && λ < d) hidden;",
        _BLOCKED,
        "light leaks under balls where they touch the floor",
        "skip the surface itself, not a distance",
        blocks=lambda d, light, opaque: less(d, light) & less(0.3, d),
    ),
    _shadow(
        "half-shadow",
        "share = share*0.5;",
        "share = 0;",
        "shadows are too bright",
        "a hidden lamp gives nothing",
        shaded_light=_half_shade,
    ),
    _shadow(
        "shadow-hides-the-highlight-only",
        "if (hidden) gloss = 0;",
        "if (hidden) share = 0;",
        "no shadow on dull things",
        "the diffuse term is light too",
        shaded_light=_no_highlight,
    ),
)
