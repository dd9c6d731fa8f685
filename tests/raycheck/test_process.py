"""Running a stranger's program: every way it can end, and nothing of it left."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from raycheck import process
from raycheck.process import Ended, clean, run

FILES = 2**20


def python(body: str, cwd: Path, timeout: float = 300.0, file_limit: int = FILES) -> Ended:
    return run([sys.executable, "-S", "-c", body], cwd, timeout, file_limit)


def alive(pid: int) -> bool:
    """Is this process there and not a zombie that waits for init."""
    try:
        return Path(f"/proc/{pid}/stat").read_text("utf-8").rsplit(")", 1)[1].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def zombies_of_ours() -> list[str]:
    """The PIDs of children of this process that nobody has collected."""
    found = []
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, parent = entry.read_text("utf-8").rsplit(")", 1)[1].split()[:2]
        except (FileNotFoundError, ProcessLookupError):
            continue
        if state == "Z" and int(parent) == os.getpid():
            found.append(entry.parent.name)
    return found


def soon(gone: int) -> bool:
    """A killed process may still be on its way out."""
    for _ in range(6000):
        if not alive(gone):
            return True
        time.sleep(0.01)
    return False


@pytest.mark.parametrize("code", [0, 1, 3, 139, 255])
def test_an_exit_status_is_reported_as_it_is(tmp_path: Path, code: int) -> None:
    ended = python(f"raise SystemExit({code})", tmp_path)
    assert (ended.how, ended.code, ended.status) == ("exited", code, f"exit status {code}")


@pytest.mark.parametrize("name", ["SIGSEGV", "SIGABRT", "SIGKILL", "SIGTERM", "SIGFPE"])
def test_a_program_that_dies_by_a_signal_has_it_named(tmp_path: Path, name: str) -> None:
    ended = python(f"import os, signal; os.kill(os.getpid(), signal.{name})", tmp_path)
    assert (ended.how, ended.status) == ("signal", f"killed by {name}")
    assert ended.code == getattr(signal, name)


def test_a_signal_without_a_name_has_its_number() -> None:
    assert process.signal_name(63) == "signal 63"


def test_a_missing_program_raises(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        run(["./nothing"], tmp_path, 1.0, FILES)


def test_a_time_out_ends_the_program_and_its_children(tmp_path: Path) -> None:
    body = """
import os, time
child = os.fork()
if child: print(os.getpid(), child, flush=True)
time.sleep(600)
"""
    ended = python(body, tmp_path, timeout=3.0)
    assert (ended.how, ended.status) == ("timeout", "stopped: out of time")
    assert ended.seconds < 60.0
    pids = [int(word) for word in ended.tail.split()]
    assert len(pids) == 2
    assert all(soon(pid) for pid in pids)


def test_a_program_that_ignores_sigterm_is_ended_all_the_same(tmp_path: Path) -> None:
    body = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)"
    assert python(body, tmp_path, timeout=3.0).how == "timeout"


def test_a_program_that_closes_its_output_and_sleeps_is_out_of_time(tmp_path: Path) -> None:
    ended = python("import os, time; os.close(1); os.close(2); time.sleep(600)", tmp_path, timeout=3.0)
    assert ended.how == "timeout"
    assert ended.seconds < 60.0


def test_a_child_that_keeps_the_pipe_open_does_not_hold_us_up_and_is_ended(tmp_path: Path) -> None:
    body = """
import os, time
child = os.fork()
if child == 0:
    time.sleep(600)
print(child, flush=True)
os._exit(5)
"""
    ended = python(body, tmp_path)
    assert (ended.how, ended.code) == ("exited", 5)
    assert ended.seconds < 60.0
    assert soon(int(ended.tail))


def test_a_child_that_goes_on_printing_after_the_program_does_not_hold_us_up(tmp_path: Path) -> None:
    body = """
import os
if os.fork():
    os._exit(0)
while True:
    os.write(1, b"x")
"""
    ended = python(body, tmp_path)
    assert ended.how in ("exited", "flood")
    assert ended.seconds < 60.0


@pytest.mark.parametrize("stream", [1, 2])
def test_endless_output_is_stopped_on_either_stream(tmp_path: Path, stream: int) -> None:
    ended = python(f"import os\nwhile True: os.write({stream}, b'x' * 65536)", tmp_path, timeout=60.0)
    assert (ended.how, ended.status) == ("flood", "stopped: too much output")
    assert len(ended.tail) <= process.TAIL


def test_output_up_to_the_limit_is_not_a_flood(tmp_path: Path) -> None:
    ended = python(f"import os, sys\nsys.stdout.write('x' * {process.OUTPUT_LIMIT - 4} + 'end')", tmp_path, 60.0)
    assert ended.how == "exited"
    assert ended.tail.endswith("xend")


def test_no_child_of_ours_is_left_uncollected(tmp_path: Path) -> None:
    python("pass", tmp_path)
    python("import time; time.sleep(60)", tmp_path, timeout=0.2)
    python("import os; os.kill(os.getpid(), 11)", tmp_path)
    assert zombies_of_ours() == []


def test_no_file_descriptor_of_ours_is_left_open(tmp_path: Path) -> None:
    python("pass", tmp_path)
    before = sorted(os.listdir("/proc/self/fd"))
    python("pass", tmp_path)
    python("import time; time.sleep(60)", tmp_path, timeout=0.2)
    assert len(os.listdir("/proc/self/fd")) == len(before)


def test_standard_input_is_empty(tmp_path: Path) -> None:
    assert python("import sys; print(repr(sys.stdin.read()))", tmp_path).tail == "''"


def test_a_file_over_the_limit_cannot_be_written(tmp_path: Path) -> None:
    # The limit is set from outside just after the start: give it the time that a renderer takes
    body = f"import time; time.sleep(0.5); open('big', 'wb').write(bytes({2 * FILES}))"
    ended = python(body, tmp_path)
    assert ended.how == "signal" or "File too large" in ended.tail
    assert (tmp_path / "big").stat().st_size <= FILES


def test_no_core_is_dumped(tmp_path: Path) -> None:
    body = "import os, time; time.sleep(0.3); os.abort()"
    assert python(body, tmp_path).status == "killed by SIGABRT"
    assert list(tmp_path.iterdir()) == []


def test_secrets_of_our_environment_do_not_reach_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAYCHECK_SECRET", "hunter2")
    monkeypatch.setenv("GITHUB_TOKEN", "hunter2")
    ended = python("import os; print(dict(os.environ))", tmp_path)
    assert "PATH" in ended.tail
    assert "hunter2" not in ended.tail


def test_an_environment_that_is_given_is_the_one_the_program_has(tmp_path: Path) -> None:
    body = "import os; print(sorted(set(os.environ) - {'LC_CTYPE'}))"
    ended = run([sys.executable, "-S", "-c", body], tmp_path, 20.0, FILES, {"ONLY": "this"})
    assert ended.tail == "['ONLY']"


def test_the_program_runs_where_it_is_told(tmp_path: Path) -> None:
    assert python("import os; print(os.getcwd())", tmp_path).tail == str(tmp_path.resolve())


def test_words_are_not_given_to_a_shell(tmp_path: Path) -> None:
    ended = run(["echo", "$HOME", ";", "touch", "x", "`id`", "*"], tmp_path, 20.0, FILES)
    assert ended.tail == "$HOME ; touch x `id` *"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("output", "text"),
    [
        (b"plain\n", "plain"),
        (b"a\tb\nc", "a\tb\nc"),
        (b"\x1b[31mred\x1b[0m", "red"),
        (b"\x1b]0;title\x07after", "after"),
        (b"\x1b[2J\x1b[Hgone", "gone"),
        (b"bell\x07 back\x08 nul\x00", "bell back nul"),
        (b"carriage\rreturn", "carriagereturn"),
        (b"\xff\xfe broken", "\ufffd\ufffd broken"),
        ("\u202ereversed".encode(), "reversed"),
        (b"\x9b31m", "\ufffd31m"),
        (b"ends in escape\x1b", "ends in escape"),
        (b"", ""),
    ],
)
def test_output_is_made_harmless_text(output: bytes, text: str) -> None:
    assert clean(output) == text


def test_only_the_end_of_long_output_is_kept() -> None:
    text = clean(b"start" + b"x" * 100_000 + b"end")
    assert len(text) == process.TAIL
    assert text.endswith("end")


def test_an_interrupt_while_we_wait_ends_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(child: object, deadline: float, hold: object) -> tuple[str, bytes]:
        pids.append(child.pid)  # type: ignore[attr-defined]
        raise KeyboardInterrupt

    pids: list[int] = []
    monkeypatch.setattr(process, "_watch", interrupted)
    with pytest.raises(KeyboardInterrupt):
        python("import time; time.sleep(60)", tmp_path)
    assert soon(pids[0])
    assert zombies_of_ours() == []


def test_an_interrupt_while_the_program_starts_waits_until_it_can_be_stopped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[subprocess.Popen[bytes]] = []

    class Struck(subprocess.Popen):  # type: ignore[type-arg]
        def __init__(self, *arguments: object, **options: object) -> None:
            super().__init__(*arguments, **options)  # type: ignore[call-overload]
            started.append(self)
            signal.raise_signal(signal.SIGINT)  # before anybody holds the child

    monkeypatch.setattr(process.subprocess, "Popen", Struck)
    with pytest.raises(KeyboardInterrupt):
        process.run([sys.executable, "-c", "import time; time.sleep(60)"], tmp_path, 30.0, 2**20)
    assert started[0].returncode == -signal.SIGKILL
