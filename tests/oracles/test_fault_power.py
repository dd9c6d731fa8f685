"""The catalogue notices every fault of the dictionary and fails no correct tracer; the dictionary says so truly."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from oracles.faults import FAULTS, TWINS, Fault, Twin, fault
from oracles.faults.power import Bench, kills, touches
from oracles.faults.words import explained, listed, page
from oracles.gates import GATES
from reference_tracer.lanes.numpy_backend import NumPyBackend
from reference_tracer.lanes.render import render
from scenes.catalogue import ladder, rung

ROOT = Path(__file__).resolve().parents[2]
WIDTH, HEIGHT = 48, 36
NOTICED = [entry for entry in FAULTS if entry.fate == "killed"]
EXCUSED = [entry for entry in FAULTS if entry.fate != "killed"]


def name_of(entry: Fault | Twin) -> str:
    return entry.name


@cache
def benches() -> tuple[Bench, ...]:
    return tuple(Bench(entry.scene().resized(WIDTH, HEIGHT)) for entry in ladder())


@pytest.mark.parametrize("entry", NOTICED, ids=name_of)
def test_a_scene_of_the_catalogue_notices_the_fault(entry: Fault) -> None:
    assert next(kills(benches(), entry), None)


def test_every_scene_of_the_catalogue_notices_a_fault() -> None:
    idle = [bench.scene.name for bench in benches() if not any(bench.kill(entry) for entry in NOTICED)]
    assert idle == []


@pytest.mark.parametrize("entry", EXCUSED, ids=name_of)
def test_a_fault_said_to_go_unnoticed_does_and_says_why(entry: Fault) -> None:
    assert entry.reason
    assert next(kills(benches(), entry), None) is None


@pytest.mark.parametrize("entry", TWINS, ids=name_of)
def test_no_scene_fails_a_correct_tracer(entry: Twin) -> None:
    assert [bench.scene.name for bench in benches() if bench.wrongly_killed(entry)] == []


def test_a_wrong_twin_would_be_noticed() -> None:
    wrong = Twin("wrong", "mirrored by 2n - i", fault("mirrored-by-2n-minus-i").rules)
    assert any(bench.wrongly_killed(wrong) for bench in benches())


@pytest.mark.parametrize("scene", ["background", "headlight-plane", "depth-order", "mirror-perfect", "refract-plane"])
def test_a_scene_that_a_fault_is_said_not_to_touch_is_the_same_bit_for_bit(scene: str) -> None:
    seen = rung(scene).scene().resized(16, 12)
    right = render(seen, NumPyBackend(32)).pixels
    untouched = [entry for entry in FAULTS if not touches(seen, entry.entries)]
    assert untouched
    for entry in untouched:
        assert np.array_equal(render(seen, NumPyBackend(32), entry.rules).pixels, right), entry.name


def test_there_are_eighty_faults_of_distinct_names_with_all_words() -> None:
    names = [entry.name for entry in (*FAULTS, *TWINS)]
    assert len(FAULTS) >= 80
    assert len(set(names)) == len(names)
    for entry in FAULTS:
        assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", entry.name)
        assert all((entry.source, entry.wrong, entry.right, entry.seen, entry.mend)), entry.name
        assert entry.wrong != entry.right, entry.name
        assert entry.entries or entry.picture, entry.name


def test_the_equivalent_fault_gives_fresnels_share_beyond_the_critical_angle_too() -> None:
    from reference_tracer.formulas import optics
    from reference_tracer.vector import Vec

    sine = np.linspace(0.0, 0.999, 200)
    zero, n = np.zeros_like(sine), Vec(np.zeros_like(sine), np.ones_like(sine), np.zeros_like(sine))
    v = Vec(sine, -np.sqrt(1.0 - sine * sine), zero)
    leaving = np.ones_like(sine, dtype=bool)
    other = fault("fresnel-without-total-reflection").rules.fresnel(v, n, leaving, 1.5)
    assert np.array_equal(other, optics.fresnel(v, n, leaving, 1.5))


def test_an_unknown_name_is_told_its_neighbours() -> None:
    with pytest.raises(KeyError, match="upside-down"):
        fault("upsidedown")


def test_the_page_of_the_documents_begins_with_the_dictionary() -> None:
    text = (ROOT / "docs" / "faults.md").read_text("utf-8")
    assert text.startswith(page())
    assert set(re.findall(r"^## (.+)$", text[len(page()) :], re.MULTILINE)) == {"Not in it", "Before other gates"}


def test_the_gates_of_the_documents_miss_faults_that_there_are() -> None:
    text = (ROOT / "docs" / "faults.md").read_text("utf-8")[len(page()) :]
    rows = re.findall(r"^\| [^|]+ \| (\d+): ([^|]+) \| (\d+)", text, re.MULTILINE)
    assert len(rows) == len(GATES)
    for count, names, _ in rows:
        missed = names.strip().split(", ")
        assert len(missed) == int(count)
        assert set(missed) <= {entry.name for entry in NOTICED}


def test_list_and_entry_name_every_fault() -> None:
    text = "\n".join(listed())
    for entry in FAULTS:
        assert f"  {entry.name} " in text
        told = "\n".join(explained(entry))
        assert entry.wrong in told
        assert entry.right in told
