"""Wrong formulas that no dictionary lists: every entry of a rulebook made wrong in the plainest ways.

A known fault is one way to get a formula wrong; a stranger's is another. What any wrong formula can do to pictures is
told by what is done to its result: a number made smaller, a direction turned, a decision reversed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from oracles.faults import Fault
from oracles.faults.fault import instead
from reference_tracer.rulebook import Rulebook
from reference_tracer.vector import Vec, unit

Change = Callable[[Any], Any]
"""From what an entry answers to another answer."""

GROUP = "mutant"
HALF, QUARTER = 0.5, 0.25
TILT = Vec(0.125, -0.0625, 0.1875)
"""Added to a unit direction: about 13 degrees, askew to every axis, so that no scene is blind to it.

These sizes decide nothing: pixels and colours are compared, not by how much they are changed.
"""


def _smaller(answer: Any) -> Any:
    return answer * HALF


def _larger(answer: Any) -> Any:
    return answer * 2.0


def _raised(number: Any) -> Any:
    return number + QUARTER


def _tilted(direction: Vec) -> Vec:
    return unit(direction + TILT)


def _reversed(direction: Vec) -> Vec:
    return -direction


def _askew(direction: Vec) -> Vec:
    return Vec(direction.y, direction.z, direction.x)


def _never(decision: Any) -> Any:
    return decision & ~decision


def _always(decision: Any) -> Any:
    return decision | ~decision


def _not(decision: Any) -> Any:
    return ~decision


def _more(count: int) -> int:
    return count + 1


def _fewer(count: int) -> int:
    return max(0, count - 1)


def _other_side(faced: Any) -> Any:
    return -faced[0], ~faced[1]


def _first(change: Change) -> Change:
    return lambda answer: (change(answer[0]), *answer[1:])


def _second(change: Change) -> Change:
    return lambda answer: (answer[0], change(answer[1]), *answer[2:])


def _each(change: Change) -> Change:
    return lambda answer: tuple(change(part) for part in answer)


_NUMBER: dict[str, Change] = {"made smaller": _smaller, "raised": _raised}
_COLOUR: dict[str, Change] = {"made smaller": _smaller}
_NORMAL: dict[str, Change] = {"tilted": _tilted, "with x, y, z exchanged": _askew, "made shorter": _smaller}
_RAY: dict[str, Change] = {"tilted": _tilted, "with x, y, z exchanged": _askew}
_BENT: dict[str, Change] = _RAY | {"reversed": _reversed}
_HIT: dict[str, Change] = {
    "made nearer": _first(_smaller),
    "made farther": _first(_larger),
    "left out": _second(_never),
}
_LIGHT: dict[str, Change] = {how: _first(change) for how, change in (_RAY | {"made shorter": _smaller}).items()}
_BRANCHES: dict[str, Change] = {
    "made smaller": _each(_smaller),
    "made smaller for the mirrored ray": _first(_smaller),
    "made smaller for the refracted ray": _second(_smaller),
}

WAYS: dict[str, tuple[str, dict[str, Change]]] = {
    "plane_point": ("the pixel's X and Y", {"made smaller": _each(_smaller), "raised": _each(_raised)}),
    "camera_ray": ("the eye's ray", _RAY),
    "sphere_hit": ("a ball's hit", _HIT),
    "plane_hit": ("a plane's hit", _HIT),
    "nearer": ("which hit is nearer", {"turned over": _not}),
    "sphere_normal": ("a ball's normal", _NORMAL),
    "plane_normal": ("a plane's normal", _NORMAL),
    "face": ("the side that is seen", {"turned over": _other_side, "never the inside": _second(_never)}),
    "shading_normal": ("the normal that light is counted by", _NORMAL),
    "light_vector": (
        "the vector to the light",
        _LIGHT | {"taken for nearer": _second(_smaller), "taken for farther": _second(_larger)},
    ),
    "attenuation": ("the attenuation", _NUMBER),
    "direct_light": ("a light's share", _COLOUR),
    "ambient_light": ("the ambient colour", _COLOUR),
    "lambert": ("cosθ", _NUMBER),
    "phong": ("the highlight's factor", _NUMBER),
    "reflect": ("the light's mirror direction", _BENT),
    "blocks": ("shadow", {"never cast": _never, "always cast": _always}),
    "mirror": ("the mirrored ray", _BENT),
    "refract": (
        "the refracted ray",
        {how: _first(change) for how, change in _BENT.items()}
        | {"never totally reflected": _second(_never), "always totally reflected": _second(_always)},
    ),
    "fresnel": ("the Fresnel share", _NUMBER),
    "weights": ("the branch's weight", _BRANCHES),
    "generations": ("the depth", {"one more": _more, "one fewer": _fewer}),
    "last": ("the last generation's colour", _COLOUR),
    "seen": ("the colour that a ray brings back", _COLOUR),
}
"""Of entries: what they answer, in words, and in which ways it is changed."""


def mutants(base: Rulebook) -> Iterator[Fault]:
    """The rulebook with one entry changed, for every entry and way; the names are for readers."""
    for entry, (answer, ways) in WAYS.items():
        for how, change in ways.items():
            rules = instead(f"{entry} {how}", **{entry: _changed(getattr(base, entry), change)})
            yield Fault(f"{answer} {how}", GROUP, "", "", "", "", "", rules)


def _changed(formula: Callable[..., Any], change: Change) -> Callable[..., Any]:
    return lambda *asked: change(formula(*asked))
