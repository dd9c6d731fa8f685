"""Tracers that crash, hang, lie and flood: each gets its verdict with evidence, and the run goes on."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from oracles.verdict import Verdict
from reports.results import Results

Attached = Callable[..., Path]
Check = Callable[..., Results]

ONLY_FIRST = (
    'bad = words["raycheck"][1] == "background"\nif not bad:\n    write(image, width, height)\n    sys.exit()\n'
)
"""Misbehave in the first rung asked, and write a black picture in the others."""

HOSTILE = {
    # body: verdict, part of the message, status of the process
    "import os\nwhile True: os.write(1, bytes(1 << 16))": ("invalid", "printed more than 16 MiB", "too much output"),
    "import time; time.sleep(60)": ("timeout", "no picture within 3 s", "out of time"),
    "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)": ("crash", "SIGSEGV", "killed by SIGSEGV"),
    "import os; os.abort()": ("crash", "SIGABRT", "killed by SIGABRT"),
    "import os, signal; os.kill(os.getpid(), signal.SIGKILL)": ("crash", "SIGKILL", "killed by SIGKILL"),
    "write(image, 1, 1)": ("invalid", "image is 1x1", "exit status 0"),
    "write(image, height, width)": ("invalid", "image is 30x40", "exit status 0"),
    "write(image, width, height, float('nan'))": ("invalid", "nan in the image", "exit status 0"),
    "write(image, width, height, float('-inf'))": ("invalid", "-inf in the image", "exit status 0"),
    "pass": ("invalid", "no image was written", "exit status 0"),
    "print('no such texture', file=sys.stderr); sys.exit(3)": ("error", "exit status 3: no such tex", "exit status 3"),
    "sys.exit(3)": ("error", "exit status 3: it printed nothing", "exit status 3"),
    "raise ValueError('from inside')": ("error", "ValueError: from inside", "exit status 1"),
    "import os; os.symlink('/etc/passwd', image)": ("invalid", "cannot be opened", "exit status 0"),
    "import os; os.symlink('/dev/zero', image)": ("invalid", "cannot be opened", "exit status 0"),
    "import os; os.mkdir(image)": ("invalid", "not a regular file", "exit status 0"),
    "import os; os.mkfifo(image)": ("invalid", "not a regular file", "exit status 0"),
    "write(image, width, height)\nopen(image, 'r+').truncate(700)": ("invalid", "truncated", "exit status 0"),
    "write(image, width, height)\nopen(image, 'ab').write(b'more')": ("invalid", "too long", "exit status 0"),
    "open(image, 'wb').write(b'')": ("invalid", "header ends early", "exit status 0"),
    "open(image, 'wb').write(b'P6 40 30 255\\n' + bytes(3600))": ("invalid", "not a colour PFM", "exit status 0"),
    "write(image.replace('.pfm', '.png'), width, height)": ("invalid", "no image was written", "exit status 0"),
    "f = open(image, 'wb'); f.truncate(1 << 22)": ("invalid", "the file has 4194304 bytes", "exit status 0"),
    "open(image, 'wb').write(b'PF\\n999999 999999\\n-1\\n')": ("invalid", "image is 999999x999999", "exit status 0"),
    "import os, shutil; d = os.path.dirname(image); shutil.rmtree(d); os.symlink('/', d)": (
        "invalid",
        "no image was written",
        "exit status 0",
    ),
}


def first_and_rest(found: Results) -> tuple[Verdict, list[Verdict]]:
    first, *rest = found.verdicts
    return first, rest


@pytest.mark.parametrize("body", HOSTILE, ids=lambda body: body.splitlines()[0][:60])
def test_a_hostile_tracer_gets_its_verdict_with_evidence_and_the_run_goes_on(
    attached: Attached, check: Check, body: str
) -> None:
    word, message, status = HOSTILE[body]
    folder = attached(ONLY_FIRST + body, f"timeout = {3 if word == 'timeout' else 60}")
    scenes = "background,headlight-plane"
    first, rest = first_and_rest(check(folder, "--scenes", scenes, "--size", "40x30", "--no-block"))
    assert first.verdict == word
    assert message in first.message
    assert first.process is not None
    assert status in first.process.status
    assert first.pictures.expected is not None
    assert [v.verdict for v in rest] == ["fail"]


@pytest.mark.parametrize("body", list(HOSTILE)[2:4] + list(HOSTILE)[9:11], ids=lambda body: body[:40])
def test_a_hostile_tracer_given_as_a_command_gets_the_same_verdict(
    script: Callable[..., list[str]], check: Check, body: str
) -> None:
    word, message, _ = HOSTILE[body]
    first, _ = first_and_rest(check("--scenes", "background", "--size", "40x30", "--", *script(body)))
    assert first.verdict == word
    assert message in first.message


def test_an_exr_header_of_a_million_squared_is_refused_before_anything_is_allocated(
    attached: Attached, check: Check
) -> None:
    body = """
def attribute(name, kind, data):
    return name + b"\\0" + kind + b"\\0" + struct.pack("<i", len(data)) + data
box = struct.pack("<4i", 0, 0, 10**6 - 1, 10**6 - 1)
channels = b"".join(c + b"\\0" + struct.pack("<iBxxxii", 2, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\\0"
header = (struct.pack("<ii", 20000630, 2) + attribute(b"channels", b"chlist", channels)
    + attribute(b"compression", b"compression", b"\\0") + attribute(b"dataWindow", b"box2i", box)
    + attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\\0")
    + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
    + attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0))
    + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\\0")
open(image, "wb").write(header + bytes(100_000))
"""
    verdict = check(attached(body, 'image = "exr"'), "--scenes", "background").verdicts[0]
    assert verdict.verdict == "invalid"
    assert "1000000x1000000" in verdict.message or "EXR" in verdict.message


def test_an_invalid_value_is_reported_with_its_position(attached: Attached, check: Check) -> None:
    body = """
write(image, width, height)
with open(image, "r+b") as f:
    f.seek(-4 * 3 * width + 4 * (3 * 7 + 1), 2)
    f.write(struct.pack("<f", float("nan")))
"""
    verdict = check(attached(body), "--scenes", "background", "--size", "40x30").verdicts[0]
    assert "pixel (7, 0) channel G" in verdict.message


def test_what_a_tracer_printed_is_kept_as_harmless_text(attached: Attached, check: Check, tmp_path: Path) -> None:
    body = r"""sys.stdout.buffer.write(b"\x1b[31m<script>alert(1)</script>\x00\xff"); sys.exit(1)"""
    verdict = check(attached(body), "--scenes", "background").verdicts[0]
    assert verdict.process is not None
    assert verdict.process.output_tail == "<script>alert(1)</script>\ufffd"
    page = (tmp_path / "report" / "index.html").read_text("utf-8")
    assert "<script>alert" not in page
    assert "\x1b" not in page


def test_the_name_of_the_exchange_folder_does_not_get_into_the_results(
    attached: Attached, check: Check, tmp_path: Path
) -> None:
    verdict = check(attached("print(image); sys.exit('cannot read ' + scene)"), "--scenes", "background").verdicts[0]
    assert verdict.message == "exit status 1: cannot read background.txt"
    assert verdict.process is not None
    assert verdict.process.output_tail.split("\n") == ["cannot read background.txt", "background.pfm"] or (
        verdict.process.output_tail.split("\n") == ["background.pfm", "cannot read background.txt"]
    )
    assert "/raycheck-" not in (tmp_path / "report" / "results.json").read_text("utf-8")


def test_a_tracer_that_vanishes_midway_leaves_the_verdicts_found_until_then(
    attached: Attached, raycheck: Callable[..., object], tmp_path: Path
) -> None:
    folder = attached("import os; write(image, width, height); os.unlink('run')")
    (folder / "run").symlink_to(Path(__import__("sys").executable))
    text = (folder / "raycheck.toml").read_text("utf-8").splitlines()
    text[2] = 'render = ["./run", "-S", "tracer.py", "{scene}", "{image}"]'
    (folder / "raycheck.toml").write_text("\n".join(text), "utf-8")
    told = raycheck("check", folder, "--no-block", "--out", tmp_path / "report")
    assert told.code == 3  # type: ignore[attr-defined]
    found = json.loads((tmp_path / "report" / "results.json").read_text("utf-8"))
    assert found["complete"] is False
    assert [v["check"] for v in found["verdicts"]] == ["image/background"]


def test_every_notation_and_every_image_ending_reaches_the_tracer(attached: Attached, check: Check) -> None:
    body = "sys.exit(' '.join(w.rsplit('/', 1)[-1] for w in sys.argv[1:]))"
    body = "import sys\n" + body
    folder = attached("")
    (folder / "tracer.py").write_text(body, "utf-8")
    manifest = (folder / "raycheck.toml").read_text("utf-8")
    (folder / "raycheck.toml").write_text(manifest + 'scene = "json"\nimage = "npy"\n', "utf-8")
    verdict = check(folder, "--scenes", "background").verdicts[0]
    assert verdict.message == "exit status 1: background.json background.npy"


def test_width_height_and_seed_are_filled_in(check: Check, tmp_path: Path) -> None:
    program = tmp_path / "say.sh"
    program.write_text('#!/bin/sh\necho "$3" "$4" "$5"\nexit 9\n')
    program.chmod(0o755)
    words = [program, "{scene}", "{image}", "{width}x{height}", "seed={seed}", "{other}"]
    found = check("--scenes", "background", "--size", "41x29", "--seed", "7", "--", *words)
    assert found.verdicts[0].message == "exit status 9: 41x29 seed=7 {other}"
