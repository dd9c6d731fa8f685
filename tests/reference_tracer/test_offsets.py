"""Where secondary rays start: what each offset promises, and where it does not hold."""

import numpy as np
import pytest

from reference_tracer.methods import SPHERE
from reference_tracer.methods.offsets import OFFSETS, project, waechter_binder
from reference_tracer.numbers import less
from reference_tracer.vector import Vec, dot, unit


def hits(n, D, W, dtype=np.float32, seed=0):
    """Rounded hit points of random rays on a unit sphere at W, and new directions that leave it: p, normal, v, c, r."""
    rng = np.random.default_rng(seed)
    a, w, new = (x / np.linalg.norm(x, axis=1)[:, None] for x in rng.standard_normal((3, n, 3)))
    aim = 0.9 * np.cross(a, w) / np.linalg.norm(np.cross(a, w), axis=1)[:, None] * rng.uniform(0, 1, n)[:, None]
    v = aim - a * D
    v /= np.linalg.norm(v, axis=1)[:, None]
    c = Vec(*(np.full(n, W * k, dtype) for k in (0.6, 0.48, 0.64)))
    o = Vec(*((a * D).astype(dtype).T + np.array(c)))
    v, new, r = Vec(*v.astype(dtype).T), Vec(*new.astype(dtype).T), np.ones(n, dtype)
    rules = SPHERE["haines"]
    distance, meets = rules.sphere_hit(rules.sphere_distances, o, v, c, r, np.zeros(n, bool), 0.0)
    assert meets.all()
    p = o + v * distance
    normal = unit(p - c)
    outward = less(0.0, dot(new, normal))
    new = Vec(*(np.where(outward, part, -part) for part in new))
    return p, normal, new, c, r


def self_hits(name, D, W):
    p, n, v, c, r = hits(2000, D, W)
    o, least = OFFSETS[name](p, n, v, c, r)
    rules = SPHERE["haines"]
    _, meets = rules.sphere_hit(rules.sphere_distances, o, v, c, r, np.zeros(len(r), bool), least)
    return meets.mean()


@pytest.mark.parametrize("D", [10.0, 1e3])
@pytest.mark.parametrize("W", [0.0, 1e4])
def test_a_projected_start_never_meets_its_own_sphere(D, W):
    assert self_hits("project", D, W) == 0.0


def test_without_an_offset_about_half_of_the_rays_do():
    assert 0.3 < self_hits("none", 10.0, 0.0) < 0.6


def test_a_least_distance_is_outgrown_by_the_worlds_offset():
    assert self_hits("t-min 1e-3", 10.0, 0.0) == 0.0
    assert self_hits("t-min 1e-3", 10.0, 1e4) > 0.0


def test_a_step_in_the_last_place_is_outgrown_by_the_distance():
    assert self_hits("Wächter-Binder", 10.0, 0.0) == 0.0
    assert self_hits("Wächter-Binder", 1e3, 0.0) > 0.1


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_projected_start_is_moved_to_the_side_it_leaves_to_and_not_far(dtype):
    p, n, v, c, r = hits(500, 10.0, 0.0, dtype)
    u = 2.0**-24 if dtype == np.float32 else 2.0**-53
    for direction, side in ((v, 1), (-v, -1)):
        o, least = project(p, n, direction, c, r)
        q = np.stack([np.asarray(part, np.float64) for part in o], axis=1)
        height = np.linalg.norm(q, axis=1) - 1
        assert least == 0.0
        assert (side * height > 0).all()
        assert np.abs(height).max() <= 30 * u  # γ5·|q|·|n|₁ <= 5u·3, and the point's own error


def test_the_offset_on_bits_is_refused_where_there_are_none():
    p, n, v, c, r = hits(3, 10.0, 0.0, np.float64)
    with pytest.raises(TypeError, match="float32"):
        waechter_binder(p, n, v, c, r)
