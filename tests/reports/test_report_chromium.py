"""The page in a real browser, from file://, under its own policy."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from reports import page
from reports.results import Results

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--enable-logging=stderr",
)

pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium on PATH: the page is not loaded in a browser")


def load(path: Path, profile: Path) -> subprocess.CompletedProcess[str]:
    """The document as the browser holds it after scripts ran, and the browser's log."""
    command = (str(BROWSER), *FLAGS, f"--user-data-dir={profile}", "--dump-dom", path.as_uri())
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)


def test_the_page_shows_in_a_browser_and_breaks_no_policy(results: Results, folder: Path, tmp_path: Path) -> None:
    loaded = load(page.write(results, folder), tmp_path / "profile")
    assert "a-fail" in loaded.stdout
    assert "0.123456789" in loaded.stdout
    assert loaded.stdout.count("data:image/png;base64,") == 3 * 9 + 1
    assert 'id="filter">' in loaded.stdout, "the script did not run"
    assert "Content Security Policy" not in loaded.stderr


def document_after(script: str, results: Results, folder: Path, profile: Path) -> str:
    """The document after a reader's actions; without the policy, which would stop this script too."""
    path = page.write(results, folder)
    html = re.sub("<meta http-equiv[^>]*>", "", path.read_text("utf-8"))
    path.write_text(html.replace("</body>", f"<script>{script}</script></body>"), "utf-8")
    return load(path, profile).stdout


def test_the_filter_leaves_the_checks_that_hold_every_word(results: Results, folder: Path, tmp_path: Path) -> None:
    script = """
        const box = document.getElementById("wanted");
        box.value = "Phong a-CRASH";
        box.dispatchEvent(new Event("input"));
        document.title = every("main [data-check]:not([hidden]) .name").map((e) => e.textContent).join()
            + " " + every(".ladder li:not([hidden])").length
            + " " + every("main > section:not([hidden]) h2").map((e) => e.textContent).join()
            + " " + document.getElementById("shown").value;
    """
    dom = document_after(script, results, folder, tmp_path / "profile")
    assert "<title>a-crash 1 Against the tracer,What this run was 1 of 11 checks</title>" in dom


def test_the_swap_exchanges_expected_and_got_and_back(results: Results, folder: Path, tmp_path: Path) -> None:
    script = """
        const article = document.querySelector("article");
        const shown = () => every("img", article).map((image) => image.src);
        const before = shown();
        const press = () => { article.querySelector(".swap button").click(); return shown(); };
        const there = press(), back = press();
        document.title = [there[0] === before[1], there[1] === before[0], there[2] === before[2],
            before[0] !== before[1], back.join() === before.join()].join();
    """
    dom = document_after(script, results, folder, tmp_path / "profile")
    assert "<title>true,true,true,true,true</title>" in dom


def test_the_policy_stops_a_script_that_is_not_ours(results: Results, folder: Path, tmp_path: Path) -> None:
    path = page.write(results, folder)
    altered = path.read_text("utf-8").replace("</main>", "<script>document.title = 'owned'</script></main>")
    path.write_text(altered, "utf-8")
    loaded = load(path, tmp_path / "profile")
    assert "Content Security Policy" in loaded.stderr
    assert "<title>owned" not in loaded.stdout
