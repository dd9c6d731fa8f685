"""Faults of no dictionary: none may be called by a known name, and its term should be found all the same.

Each is a mistake that a student could make, as an edit of the C++ example, with the term of a pixel's colour in which
it lives. They were written before the search was tried on them.
"""

from __future__ import annotations

import argparse
import importlib.util
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from oracles.verdict import Diagnosis
from raycheck.diagnosis import diagnosed
from raycheck.known import Known
from raycheck.laws import LawPlan, all_laws, judge_laws
from raycheck.machine import machine
from raycheck.subjects import attach
from raycheck.suite import Hearing, Plan
from scenes.catalogue import ladder

_SPEC = importlib.util.spec_from_file_location("cpp_variants", Path(__file__).parents[1] / "examples/cpp_variants.py")
assert _SPEC
assert _SPEC.loader
variants: Any = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(variants)

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
_NEAREST = "real f = distance(obj, o, v);"
_BY_CENTRE = "\n        if (f < INFINITE && obj.sphere) f = length(obj.v - o);"
_FOUND = "if (!nearest) return s.background;"
_AT_HIT = "\n    fmin = distance(*nearest, o, v);"
_SHARE = "c = c + l.color * a * (m.diffuse"
_FACING = "if (leaving) n = -n;"

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
                "real far = length(l.v - s.eye);\n        "
                + _FADE.replace("1 / d", "1 / far").replace("d * d", "far * far"),
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

SECOND = (
    Private(
        "a ball's place in depth is its centre", "hit", ((_NEAREST, _NEAREST + _BY_CENTRE), (_FOUND, _FOUND + _AT_HIT))
    ),
    Private(
        "each lamp counts by their number",
        "light",
        ((_SHARE, _SHARE.replace("a *", "a * (real(1) / s.lights.size()) *")),),
    ),
    Private("root of the cosine", "diffuse", ((_DIFFUSE, "(m.diffuse * std::sqrt(cosine) +"),)),
    Private("the highlight is seen from the origin", "specular", ((_GLOSS, _GLOSS.replace("-v", "unit(-p)")),)),
    Private("inverted on entering only", "refracted", (("leaving ? p * index : p * (1 / index)", "p * index"),)),
    Private(
        "grey mirrors",
        "branches",
        (
            (
                _MIRRORED,
                _MIRRORED.replace("m.reflect *", "((m.reflect.x + m.reflect.y + m.reflect.z) / 3) *")
                .replace("find_rgb(s, p, reflection(-v, n), generation + 1)", "1")
                .replace("keep * 1", "keep")
                .replace("ret + (", "ret + find_rgb(s, p, reflection(-v, n), generation + 1) * ("),
            ),
        ),
    ),
    Private(
        "what is behind shades too",
        "visibility",
        (
            (
                _BLOCKS,
                _BLOCKS.replace(
                    "if (distance(obj, p, i) < light)",
                    "if (distance(obj, p, i) < light || distance(obj, p, -i) < light)",
                ),
            ),
        ),
    ),
    Private("glass is no generation", "generation", ((_PASSED, _PASSED.replace("generation + 1", "generation")),)),
    Private(
        "half way to the normal",
        "reflected",
        ((_MIRRORED, _MIRRORED.replace("reflection(-v, n)", "unit(reflection(-v, n) + n)")),),
    ),
    Private("Y is divided by the width", "camera", ((_Y, _Y.replace("s.height", "s.width")),)),
    Private("all normals point up", "normal", ((_FACING, "if (n.y < 0) n = -n;"),)),
    Private(
        "grey ambient",
        "ambient",
        (
            (
                "Vec c = m.ambient;",
                "real grey = (m.ambient.x + m.ambient.y + m.ambient.z) / 3;\n    Vec c{grey, grey, grey};",
            ),
        ),
    ),
)
"""Written when the search had been mended by what the first showed."""

LISTS = {"first": FIRST, "second": SECOND}


def diagnosis(folder: Path) -> tuple[Diagnosis | None, int, str, float]:
    """What a check says of a tracer's folder: the diagnosis, wrong pictures, dialect told, seconds of the diagnosis."""
    subject = attach(str(folder))
    subject.prepare()
    out = folder / "report"
    hearing = Hearing(subject, Plan(ladder(), None, 0, True, Known({}), "{scene}"), out)
    verdicts = hearing.reconsidered(list(hearing.verdicts()), lambda words: None)
    verdicts.extend(judge_laws(subject, LawPlan(all_laws()), hearing.convention, tuple(verdicts), out))
    begin = time.perf_counter()
    found = diagnosed(hearing, verdicts, out)
    seconds = time.perf_counter() - begin
    told = " ".join(v.message for v in verdicts if v.check.startswith("convention/"))
    return found, sum(v.verdict == "fail" for v in verdicts), told, seconds


def row(fault: Private, found: Diagnosis | None) -> str:
    """Kind, names and term told of one fault."""
    if found is None:
        return f"{'SILENT':<8}"
    names = " + ".join(suspect.name for suspect in found.faults) or "no name"
    if found.located is None:
        return f"{found.kind:<8} {names}"
    place = found.located
    word = "right" if place.term == fault.term else "WRONG"
    laws = f", laws {', '.join(place.laws)}" if place.laws else ""
    like = f"{place.likeness:.2f} like {place.like}"
    return f"{found.kind:<8} {word}: {place.term} ({like}{laws}), {names} {found.explained}/{found.failing}"


def main() -> None:
    """A row for each fault; --only first|second, --like WORDS."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--only", choices=sorted(LISTS))
    options.add_argument("--like", default="", help="faults of which the description holds these words")
    chosen = options.parse_args()
    print(machine())
    for name, faults in LISTS.items():
        if chosen.only in (None, name):
            _figures(name, [fault for fault in faults if chosen.like in fault.says])


def _figures(name: str, faults: Sequence[Private]) -> None:
    right = confident = silent = 0
    for fault in faults:
        with tempfile.TemporaryDirectory() as place:
            found, failing, told, seconds = diagnosis(variants.write(Path(place), fault.edits))
        silent += found is None
        confident += bool(found and found.kind == "named")
        right += bool(found and found.located and found.located.term == fault.term)
        print(f"{fault.says:<45} {fault.term:<10} {row(fault, found)}; {failing} failing, {seconds:.1f} s", flush=True)
        if told:
            print(f"    {told}", flush=True)
    print(f"{name}: {len(faults)} faults, wrongly named {confident}, right term {right}, nothing said {silent}")


if __name__ == "__main__":
    main()
