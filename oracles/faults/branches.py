"""Faults of the recursion: what a branch counts for, and where it ends."""

from __future__ import annotations

from typing import Any

from oracles.faults.fault import maker
from reference_tracer import rulebook
from reference_tracer.formulas import optics
from reference_tracer.numbers import Condition, less, select
from reference_tracer.vector import Vec, select_vec


def _swapped(reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Any) -> tuple[Vec, Vec]:
    return rulebook.weights(transmit, reflect, total, asked, share)


def _one_or_the_other(reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Any) -> tuple[Vec, Vec]:
    reflect, transmit = rulebook.weights(reflect, transmit, total, asked, share)
    return reflect, optics.cut(_any(reflect), transmit)


def _any(weight: Vec) -> Condition:
    return less(0.0, weight.x) | less(0.0, weight.y) | less(0.0, weight.z)


def _unweighted(weight: Vec) -> Vec:
    return Vec(*(select(_any(weight), 1.0, part) for part in weight))


def _replaces(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    return select_vec(_any(reflect), reflect * reflected, local) + transmit * transmitted


def _local_twice(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    return (local + reflect * (local + reflected)) + transmit * transmitted


def _red_for_all(local: Vec, reflect: Vec, reflected: Vec, transmit: Vec, transmitted: Vec) -> Vec:
    found: Vec = (local + reflected * reflect.x) + transmitted * transmit.x
    return found


def _passes_the_rest(reflect: Vec, transmit: Vec, total: Condition, asked: bool, share: Any) -> tuple[Vec, Vec]:
    rest = Vec(*(select(_any(transmit), 1.0 - part, 0.0) for part in reflect))
    return rulebook.weights(reflect, rest, total, asked, share)


_MIRROR = "Mirror with No Transparency"

_TR = "Refraction with geo.tr vector"

_NOTHING = "Nothing to meet"
_THREE = "Ray Tracing has three features"

_SUM = "c = local + reflect*find_rgb(p, r) + transmit*find_rgb(p, t);"


_mix = maker("branches")
_depth = maker("recursion")

FAULTS = (
    _mix(
        "weights-swapped",
        _TR,
        "c = local + transmit*find_rgb(p, r) + reflect*find_rgb(p, t);",
        _SUM,
        "glass is a mirror, mirrors are clear",
        "reflect with r, transmit with t",
        weights=_swapped,
    ),
    _mix(
        "mirror-or-glass",
        _TR,
        "if (reflect > 0) ...; else if (transmit > 0) ...;",
        _SUM,
        "glass that also reflects is not clear",
        "both branches are followed",
        weights=_one_or_the_other,
    ),
    _mix(
        "mirror-hides-its-own-colour",
        _MIRROR,
        "c = reflect*find_rgb(p, r);",
        _SUM,
        "imperfect mirrors lose their own colour",
        "it is not a perfect mirror: add",
        mix=_replaces,
    ),
    _mix(
        "mirror-image-not-weighed",
        _MIRROR,
        "c = local + find_rgb(p, r);",
        _SUM,
        "mirrors are too bright",
        "times reflect",
        mix=lambda own, r, a, t, b: rulebook.mix(own, _unweighted(r), a, t, b),
    ),
    _mix(
        "glass-not-weighed",
        _TR,
        "c = local + find_rgb(p, t);",
        _SUM,
        "glass takes no light and has no colour",
        "times transmit",
        mix=lambda own, r, a, t, b: rulebook.mix(own, r, a, _unweighted(t), b),
    ),
    _mix(
        "local-colour-twice",
        _TR,
        "c = local + reflect*(local + find_rgb(p, r)) + ...;",
        _SUM,
        "mirrors are too bright",
        "the local colour enters once",
        mix=_local_twice,
    ),
    _mix(
        "red-weighs-all",
        _TR,
        "c = local + reflect.r*find_rgb(p, r) + ...;",
        _SUM,
        "coloured mirrors and glass are grey",
        "channel by channel",
        mix=_red_for_all,
    ),
    _mix(
        "half-of-each-branch",
        _TR,
        "c = local + (a + b)/2;",
        _SUM,
        "mirrors and glass are too dark",
        "the weights say how much, no mean",
        mix=lambda own, r, a, t, b: own + (r * a + t * b) * 0.5,
    ),
    _mix(
        "branches-times-local",
        _TR,
        "c = local + local*reflect*find_rgb(p, r) + ...;",
        _SUM,
        "mirrors show only what has their own colour",
        "the reflected light is added as it is",
        mix=lambda own, r, a, t, b: own + own * (r * a + t * b),
    ),
    _mix(
        "branches-weighed-twice",
        _TR,
        "c = local + reflect*find_rgb(p, r, reflect*weight) + ...;",
        _SUM,
        "mirrors and glass are too dark",
        "weigh where the colour comes back, or on the way there, not both",
        mix=lambda own, r, a, t, b: rulebook.mix(own, r * r, a, t * t, b),
    ),
    _mix(
        "what-is-not-reflected-passes",
        _TR,
        "c = local + reflect*find_rgb(p, r) + (1 - reflect)*find_rgb(p, t);",
        _SUM,
        "glass is too clear, and has no colour of its own",
        "transmit is the material's own weight",
        weights=_passes_the_rest,
    ),
    _depth(
        "strays-in-mirrors-are-black",
        _NOTHING,
        "if (k < 0) return generation == 0 ? background : 0;",
        "if (k < 0) return background;",
        "mirrors and glass are black where they show the sky",
        "a reflected or refracted ray that meets nothing brings the background as well",
        stray=lambda background, generation: background if generation == 0 else background * 0.0,
    ),
    _depth(
        "strays-before-the-eye-are-black",
        _NOTHING,
        "clear the picture; draw only what is hit;",
        "if (k < 0) return background;",
        "the sky is black, but mirrors show it",
        "an eye ray that meets nothing brings the background as well",
        stray=lambda background, generation: background * 0.0 if generation == 0 else background,
    ),
    _depth(
        "one-generation-too-few",
        _THREE,
        "if (generation >= depth - 1) return c;",
        "if (generation == depth) return c;",
        "the last image in mirrors is missing",
        "`depth` generations follow the eye ray",
        generations=lambda depth: max(depth - 1, 0),
    ),
    _depth(
        "two-generations-too-many",
        _THREE,
        "if (generation > depth + 1) return c;",
        "if (generation == depth) return c;",
        "mirrors show more images than asked for",
        "`depth` generations follow the eye ray",
        generations=lambda depth: depth + 2,
    ),
    _depth(
        "always-three-generations",
        _THREE,
        "#define DEPTH 3",
        "depth = scene.depth;",
        "right where the scene asks for 3",
        "the scene says how many",
        generations=lambda depth: 3,
    ),
    _depth(
        "no-recursion",
        _THREE,
        "if (generation == 0) return c;",
        "if (generation == depth) return c;",
        "mirrors and glass are black",
        "follow the branches",
        generations=lambda depth: 0,
    ),
    _depth(
        "last-generation-is-black",
        _THREE,
        "if (generation == depth) return 0;",
        "if (generation == depth) return local;",
        "the last image in mirrors is black, and all where depth is 0",
        "the last ray still has a local colour",
        last=lambda local, *branches: local * 0.0,
    ),
)
