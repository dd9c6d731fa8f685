"""The chart's measurements: times side by side, errors against truth, a frontier of right points."""

import numpy as np
import pytest

from oracles.chart import arithmetics, depth, panels, pareto, timing
from oracles.chart.timing import Work, interleaved, summed
from oracles.measurement import Point
from oracles.stability import strata, truth
from reference_tracer import llvm
from reference_tracer.lanes.render import backend
from reference_tracer.methods import SPHERE

needs_llvm = pytest.mark.skipif(llvm.find() is None, reason=f"no libLLVM that works: {llvm.REMEDY}")


def point(name, seconds, error, wrong=0.0, panel="p"):
    return Point(
        panel=panel,
        name=name,
        kind="k",
        precision="float64",
        seconds=seconds,
        spread=(seconds,) * 3,
        ratio=1.0,
        error=error,
        bits=None,
        wrong=wrong,
        baseline=False,
        frontier=False,
    )


def frontier(*points):
    return [p.name for p in pareto.with_frontier(points) if p.frontier]


def test_the_frontier_holds_what_nothing_beats_in_both():
    assert frontier(point("a", 1, 0.1), point("b", 2, 0.2), point("c", 3, 0.01), point("d", 4, 0.01)) == ["a", "c"]


def test_a_wrong_point_is_never_on_the_frontier_and_hides_no_right_one():
    assert frontier(point("wrong", 1, 1e-9, wrong=0.001), point("right", 2, 0.1)) == ["right"]


def test_a_point_without_an_error_is_not_on_the_frontier():
    assert frontier(point("none", 1, None), point("exact", 2, 0.0)) == ["exact"]


def test_each_panel_has_its_own_frontier():
    assert frontier(point("a", 1, 0.1), point("b", 2, 0.2, panel="q")) == ["a", "b"]


def test_of_equal_times_the_more_accurate_stands_alone():
    assert frontier(point("a", 1, 0.2), point("b", 1, 0.1)) == ["b"]


def test_rounds_are_interleaved_after_one_to_warm_up():
    order = []
    works = {name: Work(lambda name=name: order.append(name), 1) for name in "ab"}
    interleaved(works, 2)
    assert order == ["a", "b"] * 3


@pytest.fixture
def takes(monkeypatch):
    """Work that takes so many seconds by a clock that only work moves."""
    clock = [0.0]
    monkeypatch.setattr(timing.time, "perf_counter", lambda: clock[0])

    def work(seconds, units=1):
        calls = []

        def run():
            calls.append(seconds)
            clock[0] += seconds

        return Work(run, units), calls

    return work


def test_times_are_for_a_unit_of_work(takes):
    found = interleaved({"a": takes(0.5, units=8)[0]}, 2)["a"]
    assert (found.least, found.quartiles) == (0.0625, (0.0625, 0.0625, 0.0625))


def test_a_slow_one_sits_out_the_rest(takes):
    (slow, calls), (fast, others) = takes(2.0), takes(0.25)
    found = interleaved({"slow": slow, "fast": fast}, 10, patience=3.0)
    assert len(calls) == 3  # the warm-up and two
    assert len(others) == 11
    assert set(found) == {"slow", "fast"}


def test_the_quartiles_enclose_the_median():
    found = summed([3.0, 1.0, 2.0, 10.0])
    assert found.least == 1.0
    assert found.quartiles[0] <= found.quartiles[1] <= found.quartiles[2] <= 10.0


def arithmetic(kind):
    if kind == "Python":
        return arithmetics.Scalars("Python", "float64", 3)
    if kind == "arb":
        return arithmetics.Scalars("arb", "exact", 3, 128)
    name, _, what = kind.partition(" ")
    lanes = backend(name, 64)
    return arithmetics.BallLanes(lanes, kind, 64) if what == "balls" else arithmetics.Lanes(lanes, kind, 64)


KINDS = ["Python", "numpy", pytest.param("drjit", marks=needs_llvm)]
PROVING = ["arb", "numpy balls", pytest.param("drjit balls", marks=needs_llvm)]


@pytest.mark.parametrize("method", [name for name in SPHERE if name != "wide"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_arithmetic_gives_the_same_bits_in_float64(kind, method):
    rays = strata.inside_the_disc(np.random.default_rng(0), 60, 10.0, np.float64)
    expected = arithmetic("numpy").spheres(SPHERE[method], rays).values
    assert (arithmetic(kind).spheres(SPHERE[method], rays).values == expected).all()


@pytest.mark.parametrize("kind", PROVING)
def test_a_proved_bound_holds(kind):
    rays = strata.inside_the_disc(np.random.default_rng(1), 60, 10.0, np.float64)
    found = arithmetic(kind).spheres(SPHERE["lecture"], rays)
    error = truth.distances(rays.o, rays.v, rays.c, rays.r).error(found.values)
    assert np.isfinite(found.bound).all()
    shown = np.spacing(found.values) / 2  # what rounding the answer to a float adds
    assert (error <= found.bound + shown).all()


@pytest.mark.parametrize(
    "kind", ["Python", "numpy", "arb", "numpy balls", pytest.param("drjit balls", marks=needs_llvm)]
)
def test_the_timed_loop_runs_in_every_arithmetic(kind):
    work = arithmetic(kind).sphere_work(SPHERE["haines"])
    work.run()
    assert work.units % arithmetics.SPHERES == 0


def test_the_panels_are_complete_and_the_known_failures_are_wrong(monkeypatch):
    monkeypatch.setattr(panels, "ROUNDS", 1)
    monkeypatch.setattr(panels, "RAYS", 40)
    monkeypatch.setattr(panels, "NUMPY_RAYS", 64)
    monkeypatch.setattr(panels, "SCALAR_RAYS", 1)
    found = panels.points("numpy", np.random.default_rng(2), lambda what: None)
    assert {p.panel for p in found} == {panel.name for panel in panels.PANELS}
    for panel in panels.PANELS:
        assert sum(p.baseline for p in found if p.panel == panel.name) == 1
    wrong = {(p.panel, p.name, p.kind) for p in found if p.wrong}
    assert ("far", "lecture", "NumPy float32") in wrong
    assert ("refraction", "slide", "NumPy float64") in wrong
    assert not [key for key in wrong if key[0] in ("near", "world", "numbers", "methods")]
    assert all(p.bits is None or p.error for p in found)


def test_the_error_falls_with_depth(monkeypatch):
    monkeypatch.setattr(depth, "ROUNDS", 1)
    monkeypatch.setattr(depth, "JUDGED", (16, 12))
    monkeypatch.setattr(depth, "TIMED", (16, 12))
    found = [p for p in depth.points("numpy", lambda what: None) if p.precision == "float64"]
    errors = [p.error for p in found]
    assert errors == sorted(errors, reverse=True)
    assert [p.name for p in found if p.baseline] == ["depth 3"]
