"""Our own tracer obeys every law in every number type, and other correct forms of the formulas do too."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from flint import arb, ctx
from hypothesis import given, settings
from hypothesis import strategies as st

from oracles.laws import Ask, Law, formula_laws
from oracles.laws.cases import reading
from oracles.laws.dice import repeated, seeded
from raycheck.lanes import best_lanes
from reference_tracer.exact import ArbOperations
from reference_tracer.numbers import less, select, sqrt0
from reference_tracer.operations import _FORMULAS, ANSWERS, formulas
from reference_tracer.rulebook import LECTURE, Rulebook
from reference_tracer.vector import Vec, dot, length, select_vec, unit
from scenes.model import Scene

LAWS = formula_laws()
KINDS = [("plain", 64), ("numpy", 32), ("numpy", 64), ("drjit", 32), ("drjit", 64)]


def name_of(law: Law) -> str:
    return law.name


@cache
def tracer(kind: str, bits: int) -> Ask:
    if kind == "drjit" and best_lanes() != "drjit":
        pytest.skip("no libLLVM that DrJit can use")
    return formulas(kind, bits)


@pytest.mark.parametrize(("kind", "bits"), KINDS)
@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_our_tracer_obeys_the_law_in_every_number_type(law: Law, kind: str, bits: int) -> None:
    ask = tracer(kind, bits)
    found = reading(law, seeded(200 if kind == "plain" else 2000, f"float{bits}", 7), ask)
    assert found.excess().max() <= 1.0


@pytest.mark.parametrize("precision", ["float32", "float64"])
@pytest.mark.parametrize("law", LAWS, ids=name_of)
def test_a_law_can_tell_in_a_good_part_of_its_cases(law: Law, precision: str) -> None:
    found = reading(law, seeded(2000, precision, 3), tracer("numpy", int(precision[-2:])))
    assert found.decided().mean() > 0.2


@pytest.mark.parametrize("law", LAWS, ids=name_of)
@settings(max_examples=15)
@given(columns=st.lists(st.integers(0, 64).map(lambda k: k / 64.0), max_size=24))
def test_our_tracer_obeys_the_law_one_case_at_a_time(law: Law, columns: list[float]) -> None:
    dice = repeated(np.array([columns]).reshape(1, len(columns)), "float64")
    assert reading(law, dice, tracer("numpy", 64)).excess().max() <= 1.0


def exact(operation: str, arguments: Any, scene: Scene | None = None) -> Any:
    """The formulas on real numbers, directions made unit first, answers rounded to doubles."""
    assert ArbOperations.rank
    before, ctx.prec = ctx.prec, 200
    try:
        rows = []
        for row in arguments.tolist():
            numbers = [arb(x) for x in row]
            for at in UNIT[operation]:
                numbers[at : at + 3] = unit(Vec(*numbers[at : at + 3]))
            rows.append([float(x) for x in _FORMULAS[operation](LECTURE, numbers)])
        return np.array(rows).reshape(len(rows), ANSWERS[operation])
    finally:
        ctx.prec = before


UNIT: dict[str, tuple[int, ...]] = {"sphere": (3,), "plane": (3,), "normal": (), "reflect": (0, 3), "refract": (0, 3)}


@pytest.mark.parametrize("law", [law for law in LAWS if law.asks[0] in UNIT], ids=name_of)
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_the_exact_tracer_obeys_the_law(law: Law, precision: str) -> None:
    # Wider than double precision could show: expected values and bounds hold of the mathematics itself. A tie
    # (a ray that is exactly tangent) is decided by the sign of an enclosure here, so it is left to the band.
    found = reading(law, seeded(160, precision, 5), exact)
    assert found.excess().max() <= 1.0


def haines(b: Vec, bv: Any, v: Vec, r: Any) -> tuple[Any, Any, Any]:
    """Haines et al., Ray Tracing Gems, chapter 7: the perpendicular residual, and c/q for the root that cancels."""
    off = b - v * bv
    D = r * r - dot(off, off)
    c = dot(b, b) - r * r
    root = sqrt0(D)
    q = select(less(0.0, bv), -bv - root, root - bv)
    other = c / select(less(q, 0.0) | less(0.0, q), q, 1.0)
    return select(less(0.0, bv), q, other), select(less(0.0, bv), other, q), D


def geometric(b: Vec, bv: Any, v: Vec, r: Any) -> tuple[Any, Any, Any]:
    """L11 "Alternative Solution by Geometry": d² = |b|² - (b∘v)²."""
    D = r * r - (dot(b, b) - bv * bv)
    return -bv - sqrt0(D), -bv + sqrt0(D), D


def slide_refract(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
    """L11 "Get Refraction Vector" as it stands, mended only where it divides by 0 or takes the root of less."""
    d = -dot(v, n)
    p = unit(n * d + v)
    s2 = sqrt0(1.0 - d * d) * select(leaving, index, 1.0 / index)
    return p * s2 - n * sqrt0(1.0 - s2 * s2), ~less(s2, 1.0)


def vector_refract(v: Vec, n: Vec, leaving: Any, index: Any) -> tuple[Vec, Any]:
    """ηv + (ηcosθ1 - cosθ2)n with η = n1/n2."""
    eta = select(leaving, index, 1.0 / index)
    c1 = -dot(v, n)
    k = 1.0 - eta * eta * (1.0 - c1 * c1)
    return v * eta + n * (eta * c1 - sqrt0(k)), ~less(0.0, k)


FORMS = {
    "Haines' sphere": replace(LECTURE, sphere_distances=haines),
    "the geometric sphere": replace(LECTURE, sphere_distances=geometric),
    "the slide's refraction": replace(LECTURE, refract=slide_refract),
    "the vector refraction": replace(LECTURE, refract=vector_refract),
    "reflection by parts": replace(LECTURE, reflect=lambda i, n: n * dot(i, n) - (i - n * dot(i, n))),
    "a plane made unit first": replace(
        LECTURE,
        plane_hit=lambda o, v, n, offset, elsewhere, start: LECTURE.plane_hit(
            o, v, unit(n), offset / length(n), elsewhere, start
        ),
    ),
    "normals turned by select": replace(
        LECTURE, face=lambda v, n: (select_vec(less(0.0, dot(n, v)), -n, n), less(0.0, dot(n, v)))
    ),
}


@pytest.mark.parametrize("bits", [32, 64])
@pytest.mark.parametrize("form", FORMS)
def test_other_correct_forms_of_the_formulas_obey_every_law(form: str, bits: int) -> None:
    ask = formulas("numpy", bits, FORMS[form])
    broken = {}
    for law in LAWS:
        for seed in range(3):
            excess = reading(law, seeded(2000, f"float{bits}", seed), ask).excess().max()
            if excess > 1.0:
                broken[law.name] = excess
    assert broken == {}


@pytest.mark.parametrize("bits", [32, 64])
def test_scaled_by_a_power_of_two_our_tracer_answers_bit_for_bit(bits: int) -> None:
    (scale,) = (law for law in LAWS if law.name == "sphere/scale")
    found = reading(scale, seeded(4000, f"float{bits}", 1), tracer("numpy", bits))
    same = (found.got == found.expected) | (np.isnan(found.got) & np.isnan(found.expected))
    assert same.all()


def wrong(**entries: Any) -> Rulebook:
    return replace(LECTURE, **entries)


def far_first(b: Vec, bv: Any, v: Vec, r: Any) -> tuple[Any, Any, Any]:
    _, far, D = LECTURE.sphere_distances(b, bv, v, r)
    return far, far, D


CATCHES = [
    (wrong(sphere_distances=far_first), {"sphere/nearest-root", "sphere/centre", "sphere/grow"}),
    (
        wrong(reflect=lambda i, n: unit(n * 2.0 - i)),
        {"reflect/angle", "reflect/tangential", "phong/lobe", "phong/peak"},
    ),
    (wrong(reflect=lambda i, n: i - n * (2.0 * dot(i, n))), {"reflect/angle", "reflect/normal-incidence"}),
    (wrong(refract=lambda v, n, leaving, index: LECTURE.refract(v, n, leaving, 1.0 / index)), {"refract/snell"}),
    (
        wrong(refract=lambda v, n, leaving, index: LECTURE.refract(v, n, less(index, 0.0), index)),
        {"refract/snell", "refract/slab", "refract/reversible", "refract/fermat", "refract/beyond-critical"},
    ),
    (wrong(face=lambda v, n: (n, less(0.0, dot(n, v)))), {"refract/forward", "refract/normal-incidence"}),
    (wrong(sphere_normal=lambda p, c: unit(c - p)), {"normal/outward"}),
    (wrong(sphere_normal=lambda p, c: p - c), {"normal/unit"}),
    (wrong(lambert=dot), {"phong/dark-behind", "phong/range"}),
    (wrong(lambert=lambda i, n: LECTURE.lambert(i, n) * 0.999), {"phong/lambert"}),
    (wrong(phong=lambda i, n, v, s, m: LECTURE.phong(i, n, v, s + 1, m)), {"phong/lobe", "phong/exponents-add"}),
    (wrong(plane_hit=lambda o, v, n, *rest: LECTURE.plane_hit(o, v, unit(n), *rest)), {"plane/normal-length"}),
    (wrong(camera_ray=lambda f, r, u, X, Y: (f + r * X) + u * Y), {"camera/unit"}),
    (wrong(camera_ray=lambda f, r, u, X, Y: LECTURE.camera_ray(f, r, u, X, -Y)), {"camera/corner", "camera/even"}),
]


@pytest.mark.parametrize(
    ("rules", "expected"), CATCHES, ids=lambda value: "+".join(sorted(value))[:40] if isinstance(value, set) else ""
)
def test_a_wrong_formula_breaks_the_laws_that_speak_of_it(rules: Rulebook, expected: set[str]) -> None:
    ask = formulas("numpy", 64, rules)
    caught = {law.name for law in LAWS if reading(law, seeded(1000, "float64", 0), ask).excess().max() > 1.0}
    assert expected <= caught
    assert {name.split("/")[0] for name in caught} - {"trace"} <= {name.split("/")[0] for name in expected} | {"phong"}
