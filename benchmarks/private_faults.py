"""Faults that no dictionary lists: is none of them called by a known name, and is its term found all the same?

Each is a mistake that a student could make, as an edit of the C++ example, with the term of a pixel's colour in which
it lives. They were written before the search was tried on them.
"""

from __future__ import annotations

from dataclasses import dataclass

Edits = tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Private:
    """A mistake of no dictionary: what it is, the term it lives in, and how the C++ example is made to have it."""

    says: str
    term: str
    edits: Edits


_Y = "real Y = 1 - 2 * (j + s.sy) / s.height;"
_X = "real X = -1 + 2 * (i + s.sx) / s.width;"
_FAR_ROOT = "if (-bv + root > EPS) return -bv + root;"
_TOWARDS = "Vec w = l.point ? l.v - p : l.v;"
_FADE = 'real a = l.attenuation == "inverse" ? 1 / d : l.attenuation == "inverse_square" ? 1 / (d * d) : 1;'
_DIFFUSE = "(m.diffuse * cosine +"
_GLOSS = "real gloss = dot(reflection(i, n), -v);"
_POWER = "gloss = gloss > 0 ? std::pow(gloss, real(m.shininess)) : 0;"
_BLOCKS = "if (distance(obj, p, i) < light) return true;\n    return false;"
_MIRRORED = "ret = ret + m.reflect * keep * find_rgb(s, p, reflection(-v, n), generation + 1);"
_PASSED = "ret = ret + m.transmit * pass * find_rgb(s, p, t, generation + 1);"
_BENT = "t = unit(s - n * std::sqrt(1 - sin2));"
_LIMIT = "if (generation == s.depth) return ret;"

FIRST = (
    Private("rows are counted from one", "camera", ((_Y, _Y.replace("j +", "j + 1 +")),)),
    Private("X is divided by the height", "camera", ((_X, _X.replace("s.width", "s.height")),)),
    Private("inside a ball the near root's size", "hit", ((_FAR_ROOT, _FAR_ROOT.replace("return -bv", "return bv")),)),
    Private("a plane's formula adds the origin", "hit", (("(obj.s - dot(obj.v, o))", "(obj.s + dot(obj.v, o))"),)),
    Private(
        "divided by the radius twice",
        "normal",
        (("obj.sphere ? unit(p - obj.v)", "obj.sphere ? (p - obj.v) * (1 / (obj.s * obj.s))"),),
    ),
    Private("lamps are seen from the eye", "light", ((_TOWARDS, _TOWARDS.replace("- p", "- s.eye")),)),
    Private(
        "fades with the lamp's distance from the eye",
        "light",
        (
            (
                _FADE,
                f"real far = length(l.v - s.eye);\n        {_FADE.replace('1 / d', '1 / far').replace('d * d', 'far * far')}",
            ),
        ),
    ),
    Private("ambient times diffuse", "ambient", (("Vec c = m.ambient;", "Vec c = m.ambient * m.diffuse;"),)),
    Private("cosine to the eye", "diffuse", ((_DIFFUSE, "(m.diffuse * -dot(v, n) +"),)),
    Private(
        "falls with the angle, not its cosine",
        "diffuse",
        ((_DIFFUSE, "(m.diffuse * (1 - std::acos(cosine < 1 ? cosine : 1) / real(1.5707963267949)) +"),),
    ),
    Private(
        "half vector, exponent doubled",
        "specular",
        ((_GLOSS, "real gloss = dot(n, unit(i - v));"), (_POWER, _POWER.replace("m.shininess", "2 * m.shininess"))),
    ),
    Private("half the exponent", "specular", ((_POWER, _POWER.replace("m.shininess)", "m.shininess) / 2")),)),
    Private(
        "only the last object shades",
        "visibility",
        (
            (
                f"for (const Object& obj : s.objects)\n        {_BLOCKS}",
                "bool dark = false;\n    for (const Object& obj : s.objects) dark = distance(obj, p, i) < light;\n"
                "    return dark;",
            ),
        ),
    ),
    Private("the mirrored ray starts anew", "reflected", ((_MIRRORED, _MIRRORED.replace("s, p,", "s, o,")),)),
    Private(
        "only the height is mirrored",
        "reflected",
        ((_MIRRORED, _MIRRORED.replace("reflection(-v, n)", "Vec{v.x, -v.y, v.z}")),),
    ),
    Private("the cosine is not bent", "refracted", ((_BENT, "t = unit(s + n * dot(v, n));"),)),
    Private(
        "the index enters twice",
        "refracted",
        (("leaving ? p * index : p * (1 / index)", "leaving ? p * (index * index) : p * (1 / (index * index))"),),
    ),
    Private(
        "the mirror's weight enters twice", "branches", ((_MIRRORED, _MIRRORED.replace("keep", "m.reflect * keep")),)
    ),
    Private(
        "glass weighed by what is not mirrored",
        "branches",
        ((_PASSED, _PASSED.replace("pass", "(Vec{1, 1, 1} - m.reflect) * pass")),),
    ),
    Private(
        "each bounce counts twice",
        "generation",
        (
            (_LIMIT, "if (generation >= s.depth) return ret;"),
            (_MIRRORED, _MIRRORED.replace("+ 1)", "+ 2)")),
            (_PASSED, _PASSED.replace("+ 1)", "+ 2)")),
        ),
    ),
)
"""Written first, before anything of the search was tried."""
