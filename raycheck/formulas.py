"""The formula that a slide of L11 states, in one line of text, for the report."""

from __future__ import annotations

FORMULAS = {
    "Basic Buffering": "image of width × height, three channels R, G, B, top row first",
    "uRT-06-RT2-2DLight": "cosθ = i∘n with i = -v",
    "Ray Vector Calculation": "X = -1 + 2x/w, Y = 1 - 2y/h, v = unit(forward + X·right + Y·up)",
    "Modifying Viewpoint in RT Example": "v = unit(forward + X·right + Y·up) from the eye",
    "Ray Tracing with a Sphere": "λ = -b∘v ± sqrt((b∘v)² - (|b|² - r²)), b = o - c; n = (p - c)/|p - c|",
    "If Ray passes the Sphere or Not": "D = (b∘v)² - (|b|² - r²) >= 0; the smallest λ > 0",
    "Ray Tracing Depth Sorting": "the object of the smallest λ > 0",
    "Modified FindRGB": "the object of the smallest λ > 0",
    "uRT-10-RT5-Colors-Ambient_diffuse": "RGB = ambient + diffuse·cosθ",
    "Light Position": "i = unit(k - p); α = func(distance)",
    "Ray Tracing has three features": "generation < depth; α = 1/d or 1/d²",
    "Ex) Bad and Good Case": "code = floor(255·clamp(c, 0, 1)); cosθ = max(i∘n, 0)",
    "Phong's effect Result": "r = 2(i∘n)n - i; specular·max(r∘(-v), 0)^s",
    "Phong Effect": "specular·max(r∘(-v), 0)^s where i∘n > 0, else 0",
    "Object Modeling in uObj": "normal∘p = offset; λ = (offset - normal∘o)/(normal∘v)",
    "Example of Ray Tracing": "a light counts unless something stands strictly between p and it",
    "Mirror with No Transparency": "RGB = local + reflect·colour(p, r), r = 2(-v∘n)n + v",
    "Refraction": "n1 sinθ1 = n2 sinθ2",
    "Get Refraction Vector": "entering sinθ2 = sinθ1/n, leaving sinθ2 = n·sinθ1; none where sinθ2 >= 1",
    "Various Types of Transparency": "t = sinθ2 p_u - cosθ2 n, p = (i∘n)n - i",
    "Refraction with geo.tr vector": "RGB = local + reflect·colour(p, r) + transmit·colour(p, t)",
    "Nothing to meet": "a ray that meets nothing has the background's colour",
}
"""By slide title, as the catalogue names it."""


def formula_of(slide: str) -> str:
    """The formula of a slide of the catalogue; empty for others."""
    return FORMULAS.get(slide, "")
