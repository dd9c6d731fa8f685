"""Probes that attack: laws asked in the jail end, tell a word, and leave neither a process nor a file behind."""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from raycheck.grading.one import Asked, grade
from raycheck.grading.rubric import Rubric
from raycheck.grading.submissions import found
from raycheck.sandbox import Jail, jail
from raycheck.sandbox.census import descendants
from raycheck.sandbox.jail import missing
from reports.grades import Record

pytestmark = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")

RUBRIC = Rubric.model_validate(
    {
        "name": "laws",
        "group": [
            {"name": "first", "points": 1, "rungs": ["background"]},
            {"name": "laws", "points": 4, "laws": ["reflect/unit", "reflect/angle"]},
        ],
        "limits": {"memory": 256, "processes": 48, "temporary": 16, "disk": 32, "render": 5.0, "probe": 4.0},
    }
)
TRACER = """
import os, signal, socket, struct, sys, time
def say(text): sys.stdout.write(text + "\\n"); sys.stdout.flush()
def greet():
    sys.stdin.readline(); say("raycheck 1 python float64 reflect")
def answer():
    for line in sys.stdin:
        w = [float(x) for x in line.split()[1:]]
        d = sum(a * b for a, b in zip(w, w[3:]))
        say(" ".join("%.17g" % (2 * d * b - a) for a, b in zip(w, w[3:])))
if "--probe" in sys.argv:
BODY
    sys.exit()
words = {line.split()[0]: line.split()[1:] for line in open(sys.argv[1]) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
with open(sys.argv[2], "wb") as f:
    f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
    f.write(struct.pack("<3f", *[float(w) for w in words["background"]]) * (width * height))
"""
PRIVATE = (str(Path.home() / ".bashrc"), "/home", __file__, "/etc/shadow")
"""What a submission has no business to see: the grader's home, other homes, the suite, passwords."""
EATS = "x = []\nwhile True: x.append(bytearray(b'x') * 10**7)"
ATTACKS = {
    "none": ("greet(); answer()", "pass", ""),
    "memory bomb when asked": (f"greet(); sys.stdin.readline()\n{EATS}", "invalid", "limit of memory"),
    "fork bomb": ("greet()\nwhile True:\n    try: os.fork()\n    except OSError: pass", "", ""),
    "sleep": ("greet(); time.sleep(60)", "timeout", ""),
    "a letter a second": (
        "greet(); sys.stdin.readline()\nwhile True: sys.stdout.write('1'); sys.stdout.flush(); time.sleep(1)",
        "timeout",
        "all of them together",
    ),
    "an answer a second": (
        "greet()\nfor _ in sys.stdin: say('1 0 0'); time.sleep(1)",
        "timeout",
        "all of them together",
    ),
    "flood": ("greet(); sys.stdin.readline()\nwhile True: os.write(1, b'1 0 0' + bytes(1 << 16))", "invalid", ""),
    "nonsense": ("greet()\nfor _ in sys.stdin: say('nan nan nan')", "invalid", "is not finite"),
    "daemon": (
        "greet()\nif os.fork() == 0:\n    os.setsid(); signal.signal(15, signal.SIG_IGN); os.close(1); time.sleep(60)\n"
        "answer()",
        "pass",
        "",
    ),
    "dies of a signal": ("greet(); sys.stdin.readline(); os.kill(os.getpid(), 11)", "crash", "SIGSEGV"),
    "looks around": (
        f"found = [p for p in {PRIVATE} if os.path.exists(p)]\n"
        "try: socket.create_connection(('1.1.1.1', 53), 1); found.append('network')\nexcept OSError: pass\n"
        "for p in (__file__, '/usr/x', '/dev/x'):\n"
        "    try: open(p, 'a'); found.append(p)\n    except OSError: pass\n"
        "greet(); answer() if not found else sys.exit(str(found))",
        "pass",
        "",
    ),
}


@contextmanager
def nothing_outlives(folder: Path) -> Iterator[None]:
    """What is left of processes and temporary files is an error."""
    place = folder / "temporary"
    place.mkdir()
    usual, tempfile.tempdir = tempfile.tempdir, str(place)
    before = set(descendants(os.getpid()))
    try:
        yield
        assert set(descendants(os.getpid())) <= before, "a process outlived the grading"
        assert list(place.iterdir()) == [], "a file outlived the grading"
    finally:
        tempfile.tempdir = usual


def graded(folder: Path, body: str) -> Record:
    own = folder / "class" / "mallory"
    own.mkdir(parents=True)
    indented = "\n".join(f"    {line}" for line in body.splitlines())
    (own / "tracer.py").write_text(TRACER.replace("BODY", indented), "utf-8")
    python = '["python3", "-S", "tracer.py", '
    call = f'render = {python}"{{scene}}", "{{image}}"]\nprobe = {python}"--probe"]'
    (own / "raycheck.toml").write_text(f'[tracer]\nname = "<script>"\nprecision = "float64"\n{call}\n', "utf-8")
    for name in ("records", "students"):
        (folder / "out" / name).mkdir(parents=True)
    begin = time.monotonic()
    with nothing_outlives(folder):
        record = grade(Asked(RUBRIC, 3, folder / "out", Jail(RUBRIC.limits)), found(folder / "class")[0])
    assert time.monotonic() - begin < 30.0
    return record


@pytest.mark.parametrize("name", ATTACKS)
def test_an_attacking_probe_gets_its_word_and_leaves_nothing(tmp_path: Path, name: str) -> None:
    body, word, message = ATTACKS[name]
    record = graded(tmp_path, body)
    pictures, laws = record.groups
    assert pictures.earned == 1.0
    first = laws.lines[0]
    if word:
        assert (first.verdict, message in first.why) == (word, True), first
    assert laws.earned == (4.0 if word == "pass" else 0.0), laws


@pytest.mark.parametrize("when", ["asked", "idle"])
def test_a_probe_beyond_its_memory_is_stopped_without_control_groups(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, when: str
) -> None:
    @contextmanager
    def none(limits: object) -> Iterator[None]:
        yield None

    monkeypatch.setattr(jail, "cgroup", none)
    eats = f"greet()\n{EATS}" if when == "idle" else f"greet(); sys.stdin.readline()\n{EATS}"
    first = graded(tmp_path, eats).groups[1].lines[0]
    assert (first.verdict, "limit of memory" in first.why) == ("invalid", True), first
