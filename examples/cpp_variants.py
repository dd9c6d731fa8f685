"""The C++ example in other words: lawful dialects, slips of convention, faults. Each is a few edits of its source.

An edit (old, new) must fit exactly one place, so that a change of the example cannot leave a variant that is none.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

EXAMPLE = Path(__file__).parent / "cpp_lecture"
Edits = tuple[tuple[str, str], ...]

_X, _Y = "real X = -1 + 2 * (i + s.sx) / s.width;", "real Y = 1 - 2 * (j + s.sy) / s.height;"
_FIND = "Vec find_rgb(const Scene& s, Vec o, Vec v, int generation) {"
_LIMIT = "if (generation == s.depth) return ret;"
_FRESNEL = "real F = s.fresnel ? fresnel(v, n, leaving, m.index) : 0;"
_WEIGHTS = "real keep = s.fresnel ? F : 1, pass = s.fresnel ? 1 - F : 1;"
_ON_GLASS = (
    (_FRESNEL, f"bool glassy = s.fresnel || !black(m.transmit);\n    {_FRESNEL.replace('s.fresnel', 'glassy')}"),
    (_WEIGHTS, _WEIGHTS.replace("s.fresnel", "glassy")),
)
_SCHLICK = """real fresnel(Vec v, Vec n, bool leaving, real index) {
    real n1 = leaving ? index : 1, n2 = leaving ? 1 : index;
    real c = -dot(v, n), sin2 = (n1 / n2) * (n1 / n2) * (1 - c * c);
    if (sin2 >= 1) return 1;
    if (n1 > n2) c = std::sqrt(1 - sin2);
    real f0 = (n1 - n2) / (n1 + n2);
    f0 *= f0;
    return f0 + (1 - f0) * (1 - c) * (1 - c) * (1 - c) * (1 - c) * (1 - c);
}
real exact_fresnel(Vec v, Vec n, bool leaving, real index) {"""
_SHADOW = "if (distance(obj, p, i) < light) return true;"
_STORED = "float rgb[3] = {float(c.x), float(c.y), float(c.z)};"

DIALECTS: Mapping[str, Edits] = {
    'sample = "corner"': ((_X, _X.replace("s.sx", "real(0)")), (_Y, _Y.replace("s.sy", "real(0)"))),
    'sample = "centre"': ((_X, _X.replace("s.sx", "real(0.5)")), (_Y, _Y.replace("s.sy", "real(0.5)"))),
    'specular = "blinn"': (("real gloss = dot(reflection(i, n), -v);", "real gloss = dot(n, unit(i - v));"),),
    "specular_in_shadow = true": (
        ("if (s.shadows && shadowed(s, p, i, d)) continue;", "bool dark = s.shadows && shadowed(s, p, i, d);"),
        ("(m.diffuse * cosine +", "(m.diffuse * (dark ? 0 : cosine) +"),
    ),
    "specular_needs_light_in_front = false": (("if (cosine <= 0) continue;", "if (cosine < 0) cosine = 0;"),),
    'ambient = "per_light"': (
        ("Vec c = m.ambient;", "Vec c;"),
        ("Vec w = l.point ? l.v - p : l.v;", "c = c + m.ambient * l.color;\n        Vec w = l.point ? l.v - p : l.v;"),
    ),
    'faces = "outward"': (("local_colour(s, m, p, n, v);", "local_colour(s, m, p, leaving ? -n : n, v);"),),
    'glass_shadow = "none"': ((_SHADOW, _SHADOW.replace("if (", "if (black(obj.material.transmit) && ")),),
    'limit = "background"': (
        (_FIND, f"{_FIND}\n    if (generation > s.depth) return s.background;"),
        (_LIMIT, ""),
    ),
    'limit = "local"': ((_LIMIT, "if (generation == s.depth + 1) return ret;"),),
    'mix = "lerp"': ((_LIMIT, f"ret = ret * (Vec{{1, 1, 1}} - m.reflect - m.transmit);\n    {_LIMIT}"),),
    'tir = "reflect"': (
        (
            "Vec t;\n",
            "Vec t;\n    if (!black(m.transmit) && !refraction(v, n, leaving, m.index, t))\n"
            "        return ret + (m.reflect + m.transmit) * find_rgb(s, p, reflection(-v, n), generation + 1);\n",
        ),
    ),
    'fresnel = "exact"': _ON_GLASS,
    'fresnel = "schlick"': (*_ON_GLASS, ("real fresnel(Vec v, Vec n, bool leaving, real index) {", _SCHLICK)),
    'clamp = "generation"': (
        (
            "Vec find_rgb(const Scene& s, Vec o, Vec v, int generation) {",
            "Vec found(const Scene& s, Vec o, Vec v, int generation);\n"
            "Vec find_rgb(const Scene& s, Vec o, Vec v, int generation) {\n"
            "    Vec c = found(s, o, v, generation);\n"
            "    return {c.x < 1 ? c.x : 1, c.y < 1 ? c.y : 1, c.z < 1 ? c.z : 1};\n}\n"
            "Vec found(const Scene& s, Vec o, Vec v, int generation) {",
        ),
    ),
    'lambert = "1/pi"': (("(m.diffuse * cosine +", "(m.diffuse * (cosine / real(3.14159265358979)) +"),),
}
"""By the line that a manifest says it with."""

_ROWS = "for (int j = height - 1; j >= 0; j--)"
_PIXEL = "const Vec& c = pixels[std::size_t(j) * width + i];"

SLIPS: Mapping[str, Edits] = {
    "upside down": ((_ROWS, "for (int j = 0; j < height; j++)"),),
    "mirrored": ((_PIXEL, _PIXEL.replace("+ i]", "+ width - 1 - i]")),),
    "BGR": ((_STORED, "float rgb[3] = {float(c.z), float(c.y), float(c.x)};"),),
    "gamma 2.2": ((_STORED, f"{_STORED}\n            for (float& x : rgb) x = std::pow(x, 1 / 2.2f);"),),
    "sRGB": (
        (
            _STORED,
            f"{_STORED}\n            for (float& x : rgb)\n"
            "                x = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;",
        ),
    ),
    "half": ((_X, _X.replace("s.sx", "s.sx + real(0.5)")), (_Y, _Y.replace("s.sy", "s.sy + real(0.5)"))),
    "w-1": ((_X, _X.replace("s.width", "(s.width - 1)")), (_Y, _Y.replace("s.height", "(s.height - 1)"))),
}
"""By the word of oracles.conventions."""

FAULTS: Mapping[str, Edits] = {
    "reflection 2n - i": (("return n * (2 * dot(i, n)) - i;", "return unit(n * 2 - i);"),),
    "ratio not inverted on leaving": (("leaving ? p * index : p * (1 / index)", "p * (1 / index)"),),
    "shadows pass the light": ((_SHADOW, _SHADOW.replace("light", "INFINITE")),),
    "light vector not unit": (("Vec i = unit(w);", "Vec i = w;"),),
    "nearest is the last": (("if (f < fmin) {", "if (f < INFINITE) {"),),
}
"""Real faults, which no convention excuses."""


def source(edits: Iterable[tuple[str, str]]) -> str:
    """The example's source with these edits; raise ValueError where one does not fit exactly once."""
    text = (EXAMPLE / "tracer.cpp").read_text("utf-8")
    for old, new in edits:
        if text.count(old) != 1:
            raise ValueError(f"{old!r} occurs {text.count(old)} times in the example")
        text = text.replace(old, new)
    return text


def write(folder: Path, edits: Iterable[tuple[str, str]], dialect: Iterable[str] = ()) -> Path:
    """A tracer's folder with that variant and the example's manifest, which declares these dialect lines."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tracer.cpp").write_text(source(edits), "utf-8")
    (folder / "Makefile").write_text((EXAMPLE / "Makefile").read_text("utf-8"), "utf-8")
    manifest = (EXAMPLE / "raycheck.toml").read_text("utf-8")
    lines = "\n".join(dialect)
    (folder / "raycheck.toml").write_text(f"{manifest}\n[tracer.dialect]\n{lines}\n", "utf-8")
    return folder
