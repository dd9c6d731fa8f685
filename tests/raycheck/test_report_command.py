"""raycheck report in a folder that more than one command wrote to: the page belongs to the newest."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest

from reports import chart, results, stability

NAMES = (results.FILE, stability.FILE, chart.FILE)


@pytest.mark.parametrize("older", [stability.FILE, chart.FILE])
def test_a_new_check_is_reported_though_an_older_measurement_lies_beside_it(
    raycheck: Any, tmp_path: Path, older: str
) -> None:
    (tmp_path / older).write_text("{}")
    os.utime(tmp_path / older, (1, 1))
    raycheck("check", f"images:{tmp_path}", "--scenes", "background", "--out", tmp_path)
    page = (tmp_path / "index.html").read_bytes()
    told = raycheck("report", tmp_path)
    assert told.code == 0
    assert f"{tmp_path} holds results.json and {older}: the page is of results.json, the newest" in told.err
    assert (tmp_path / "index.html").read_bytes() == page


@pytest.mark.parametrize("newest", NAMES)
def test_the_newest_of_all_is_read(raycheck: Any, tmp_path: Path, newest: str) -> None:
    for name in NAMES:
        (tmp_path / name).write_text("[]")
        os.utime(tmp_path / name, (2, 2) if name == newest else (1, 1))
    told = raycheck("report", tmp_path)
    assert told.code == 2
    assert str(tmp_path / newest) in told.err.splitlines()[-1]
