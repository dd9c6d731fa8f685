"""The line protocol against probes of every kind: none hangs, floods or crashes the client, and each is told apart."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from oracles.laws import NoAnswerError
from oracles.laws.cases import Question
from raycheck.probes import wire
from raycheck.probes.client import RESTARTS, ProbeClient
from scenes.catalogue import rung

GREET = """
import os, sys, time
def say(text): sys.stdout.write(text + "\\n"); sys.stdout.flush()
def lines():
    for line in sys.stdin:
        words = line.split()
        if words[0] == "hello": say("raycheck 1 python float32 sphere reflect refract normal phong camera trace")
        else: yield words
"""
ECHO = "for words in lines(): say(words[1])\n"

Opened = Callable[..., ProbeClient]


@pytest.fixture
def probe(tmp_path: Path) -> Iterator[Opened]:
    """A client of a Python probe with this body."""
    made: list[ProbeClient] = []

    def start(body: str, head: str = GREET, precision: str = "float32", patience: float = 60.0) -> ProbeClient:
        path = tmp_path / "probe.py"
        path.write_text(head + body, "utf-8")
        made.append(ProbeClient((sys.executable, "-S", str(path)), tmp_path, "team", precision, patience))
        return made[-1]

    yield start
    for client in made:
        client.close()


def sphere(count: int = 1, first: float = 1.0) -> np.ndarray:
    return np.arange(10.0 * count).reshape(count, 10) + first


def failure(client: ProbeClient, operation: str = "sphere", count: int = 1) -> NoAnswerError:
    with pytest.raises(NoAnswerError) as caught:
        client(operation, sphere(count)[:, : {"reflect": 6}.get(operation, 10)])
    return caught.value


def test_the_greeting_names_the_operations(probe: Opened) -> None:
    assert probe(ECHO).open() == {"sphere", "reflect", "refract", "normal", "phong", "camera", "trace"}


def test_answers_come_back_row_by_row(probe: Opened) -> None:
    assert probe(ECHO)("sphere", sphere(3)).tolist() == [[1.0], [11.0], [21.0]]


def test_miss_and_tir_are_missing_numbers(probe: Opened) -> None:
    client = probe("for words in lines(): say('miss' if words[0] == 'sphere' else 'tir')\n")
    assert np.isnan(client("sphere", sphere(2))).all()
    assert np.isnan(client("refract", np.ones((2, 7)))).all()
    assert client("refract", np.ones((2, 7))).shape == (2, 3)


def test_a_large_batch_fills_no_pipe(probe: Opened) -> None:
    # 3 MB of questions and 4 MB of answers: either is far more than a pipe holds
    client = probe("for words in lines(): say(words[1] + ' ' * 200)\n")
    rows = sphere(20000)
    assert np.array_equal(client("sphere", rows)[:, 0], rows[:, 0].astype(np.float32))


def test_a_probe_that_answers_late_in_blocks_is_served(probe: Opened) -> None:
    body = """
held = []
for words in lines():
    held.append(words[1])
    if len(held) == 500: say("\\n".join(held)); held = []
"""
    assert len(probe(body)("sphere", sphere(2000))) == 2000


def test_one_process_serves_many_batches(probe: Opened) -> None:
    client = probe("for words in lines(): say(str(os.getpid()))\n")
    assert len({float(client("sphere", sphere())[0, 0]) for _ in range(5)}) == 1
    assert client.starts == 1


def test_a_float32_tracer_may_print_nine_digits(probe: Opened) -> None:
    client = probe("for words in lines(): say('0.333333343')\n")
    assert client("sphere", sphere())[0, 0] == float(np.float32(1.0) / np.float32(3.0))


@pytest.mark.parametrize(
    ("answer", "told"),
    [
        ("banana", "'banana' is not an answer; expected 1 finite number or miss"),
        ("nan", "is not finite"),
        ("inf", "is not finite"),
        ("-inf", "is not finite"),
        ("1 2", "has 2 words"),
        ("", "has no words"),
        ("tir", "is not an answer"),
        ("1_0", "is not finite"),
        ("0x10", "is not an answer"),
    ],
)
def test_garbage_is_invalid_and_quoted_with_its_question(probe: Opened, answer: str, told: str) -> None:
    error = failure(probe(f"for words in lines(): say({answer!r} if words[1] == '11' else '1')\n"), count=3)
    assert error.word == "invalid"
    assert told in error.message
    assert error.arguments[0] == 11.0


def test_a_line_without_end_is_cut_off(probe: Opened) -> None:
    client = probe("for words in lines():\n    while True: sys.stdout.write('9' * 65536); sys.stdout.flush()\n")
    begin = time.monotonic()
    assert "a line of more than 4096 bytes" in failure(client).message
    assert time.monotonic() - begin < client.patience


def test_more_lines_than_questions_are_invalid(probe: Opened) -> None:
    client = probe("for words in lines(): say('1\\n1')\n")

    def ask_thrice() -> None:
        for _ in range(3):
            client("sphere", sphere())
            time.sleep(0.05)

    with pytest.raises(NoAnswerError, match="more lines than questions"):
        ask_thrice()


def test_silence_is_a_timeout_that_names_the_question(probe: Opened) -> None:
    body = "for words in lines():\n    if words[1] == '11': time.sleep(60)\n    say('1')\n"
    error = failure(probe(body, patience=2.0), count=3)
    assert (error.word, error.arguments[0]) == ("timeout", 11.0)
    assert "within 2 s" in error.message


def test_a_probe_that_does_not_flush_is_told_to(probe: Opened) -> None:
    error = failure(probe("for words in lines(): sys.stdout.write('1\\n')\n", patience=2.0))
    assert error.word == "timeout"
    assert "flushed" in error.message


def test_slow_but_steady_answers_are_in_time(probe: Opened) -> None:
    client = probe("for words in lines():\n    time.sleep(0.3); say('1')\n", patience=2.0)
    assert len(client("sphere", sphere(10))) == 10


def test_a_crash_names_the_signal_and_the_question(probe: Opened) -> None:
    body = "for words in lines():\n    if words[1] == '21': os.kill(os.getpid(), 11)\n    say('1')\n"
    error = failure(probe(body), count=4)
    assert (error.word, error.arguments[0]) == ("crash", 21.0)
    assert "SIGSEGV" in error.message


def test_an_exit_tells_status_and_last_words(probe: Opened) -> None:
    error = failure(probe("for words in lines(): sys.exit('no such formula')\n"))
    assert error.word == "error"
    assert "exit status 1" in error.message
    assert "no such formula" in error.message


def test_a_probe_that_closes_its_output_is_invalid(probe: Opened) -> None:
    assert failure(probe("for words in lines():\n    os.close(1); time.sleep(600)\n")).word == "invalid"


def test_a_flood_on_stderr_blocks_nothing(probe: Opened) -> None:
    client = probe("for words in lines():\n    os.write(2, b'x' * 300000); say('1')\n")
    assert len(client("sphere", sphere(5))) == 5


def test_after_a_failure_it_is_started_again(probe: Opened) -> None:
    client = probe("for words in lines():\n    if words[1] == '1': sys.exit(3)\n    say('1')\n")
    assert failure(client).word == "error"
    assert client("sphere", sphere(1, 5.0)).tolist() == [[1.0]]
    assert client.starts == 2


def test_starting_again_has_an_end(probe: Opened) -> None:
    client = probe("for words in lines(): sys.exit(3)\n")
    messages = [failure(client).message for _ in range(RESTARTS + 3)]
    assert "is not started again" in messages[-1]
    assert client.starts == RESTARTS + 1


@pytest.mark.parametrize(
    ("greeting", "told"),
    [
        ("hi", "does not answer 'hello 1'"),
        ("raycheck 2 x float32 sphere", "speaks version '2'"),
        ("raycheck 1 x float64 sphere", "computes in float64; raycheck.toml says float32"),
        ("raycheck 1 x double sphere", "does not answer"),
        ("", "does not answer"),
    ],
)
def test_a_wrong_greeting_is_told(probe: Opened, greeting: str, told: str) -> None:
    client = probe(f"import sys\nfor line in sys.stdin: print({greeting!r}, flush=True)\n", head="")
    with pytest.raises(NoAnswerError) as caught:
        client.open()
    assert told in caught.value.message


def test_a_program_that_is_not_there_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(NoAnswerError, match="cannot be started"):
        ProbeClient(("./nothing",), tmp_path, "team", "float32").open()


def test_an_operation_that_it_does_not_offer_is_unsupported(probe: Opened) -> None:
    assert failure(probe("for words in lines(): say('unsupported')\n")).word == "unsupported"
    with pytest.raises(NoAnswerError) as caught:
        probe(ECHO)("plane", sphere())
    assert caught.value.word == "unsupported"


def test_a_scene_is_handed_over_once_as_a_file(probe: Opened) -> None:
    body = """
asked = 0
for words in lines():
    if words[0] == "scene":
        asked += 1
        assert open(words[1]).read().startswith("raycheck 1 point-light")
        say("ok")
    else: say(f"{asked} 0 0")
"""
    client, scene = probe(body), rung("point-light").scene()
    assert client("camera", np.ones((2, 2)), scene)[:, 0].tolist() == [1.0, 1.0]
    assert client("trace", np.ones((1, 6)), scene)[0, 0] == 1.0


def test_a_scene_that_is_not_taken_is_told(probe: Opened) -> None:
    with pytest.raises(NoAnswerError, match="does not answer a scene; expected ok"):
        probe("for words in lines(): say('what')\n")("camera", np.ones((1, 2)), rung("point-light").scene())


def test_nothing_is_left_running_after_close(probe: Opened) -> None:
    client = probe(
        "import subprocess\nchild = subprocess.Popen(['sleep', '600'])\nfor words in lines(): say(str(child.pid))\n"
    )
    child = int(client("sphere", sphere())[0, 0])
    client.close()
    deadline = time.monotonic() + 60.0
    while time.monotonic() < deadline and _runs(child):
        time.sleep(0.02)
    assert not _runs(child)


def _runs(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().split(")")[1].split()[0] != "Z"
    except OSError:
        return False


def test_the_line_runs_as_it_is_printed(probe: Opened, tmp_path: Path) -> None:
    client = probe(ECHO)
    client.shown = str(tmp_path)
    line = client.line((Question("sphere", (0.1,) * 10), Question("reflect", (-0.5,) * 6)), tmp_path / "laws")
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1:] == ["0.10000000000000001", "-0.5"]


def test_the_line_of_a_scene_finds_its_file_from_where_it_is_typed(
    probe: Opened, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = tmp_path / "it's here"
    here.mkdir()
    monkeypatch.chdir(here)
    client = probe(
        "for words in lines(): say(open(' '.join(words[1:])).readline().strip() if words[0] == 'scene' else '1 2 3')\n"
    )
    client.shown = str(tmp_path)
    line = client.line((Question("camera", (1.0, 2.0), rung("point-light").scene()),), Path("report/laws"))
    done = subprocess.run(["sh", "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[1:] == ["raycheck 1 point-light", "1 2 3"]


def test_numbers_travel_without_loss() -> None:
    for value in (0.1, 1 / 3, 5e-324, -1.7976931348623157e308, math.pi):
        assert float(wire.question("x", (value,)).split()[1]) == value


def test_a_probe_gets_no_more_of_our_environment_than_it_needs(probe: Opened, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SECRET_TOKEN", "1")
    assert probe("for words in lines(): say(str(int('SECRET_TOKEN' in os.environ)))\n")("sphere", sphere())[0, 0] == 0.0
    assert "SECRET_TOKEN" in os.environ
