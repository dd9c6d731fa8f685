"""Submissions that attack: each has its outcome, and neither a process nor a file of it outlives the grading."""

from __future__ import annotations

import os
import shlex
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest

import raycheck
from raycheck.grading.one import Asked, grade
from raycheck.grading.rubric import Rubric
from raycheck.grading.submissions import Submission, found
from raycheck.sandbox import Jail
from raycheck.sandbox.census import descendants
from raycheck.sandbox.jail import missing
from reports import results
from reports.grades import Record

pytestmark = pytest.mark.skipif(bool(missing()), reason=f"no sandbox here: {missing()}")

RUBRIC = Rubric.model_validate(
    {
        "name": "two rungs",
        "group": [{"name": "first", "points": 10, "rungs": ["background", "headlight-plane"]}],
        "limits": {
            "memory": 256,
            "processes": 48,
            "temporary": 16,
            "disk": 32,
            "build": 60.0,
            "render": 60.0,
        },
    }
)
SHORT = {"build": 5.0, "render": 2.0}
"""Limits for those who are to run out of time; nobody else does on a busy machine."""
OURS = tuple(str(place) for place in (Path.home(), Path(raycheck.__file__).parents[1], tempfile.gettempdir()))
"""Where who grades keeps things: home, the suite, temporary files."""
OWNED = f"owned-{os.getpid()}"
FORBIDDEN = tuple(
    place / OWNED
    for place in (Path("/etc"), Path("/usr"), Path.home(), Path(raycheck.__file__).parent, Path(__file__).parent)
)
"""Files that nobody may make: of the system, of who grades, of the suite."""
NONE: Mapping[str, float] = {}
MARK = "the-rubric-of-this-class"

READER = """
import os, signal, socket, struct, subprocess, sys, time
scene, image = sys.argv[1:3]
words = {line.split()[0]: line.split()[1:] for line in open(scene) if line.strip()}
width, height = int(words["image"][0]), int(words["image"][1])
background = [float(w) for w in words["background"]]
def right():
    with open(image, "wb") as f:
        f.write(b"PF\\n%d %d\\n-1.0\\n" % (width, height))
        f.write(struct.pack("<3f", *background) * (width * height))
"""
"""Every hostile tracer begins so: `right()` writes a picture that is right for the first rung."""

PNG_BOMB = """
import zlib
def chunk(kind, data): return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
head = chunk(b"IHDR", struct.pack(">IIBBBBB", 60000, 60000, 8, 2, 0, 0, 0))
body = chunk(b"IDAT", zlib.compress(bytes(10**7))) + chunk(b"IEND", b"")
open(image, "wb").write(b"\\x89PNG\\r\\n\\x1a\\n" + head + body)
"""


@dataclass(frozen=True)
class Attack:
    """What the tracer does, what its first rung's verdict is, part of the message, more of the manifest."""

    body: str
    verdict: str
    message: str = ""
    more: str = ""

    @property
    def limits(self) -> dict[str, float]:
        """What it is held to."""
        return SHORT if self.verdict in ("timeout", "") else {}


ATTACKS = {
    "fork bomb": Attack("while True:\n    try: os.fork()\n    except OSError: pass", "invalid", "limit of processes"),
    "thread bomb": Attack(
        "import threading\nfor _ in range(999): threading.Thread(target=time.sleep, args=(9,)).start()",
        "invalid",
        "limit of processes",
    ),
    "setsid daemon": Attack(
        "right()\nif os.fork() == 0:\n    os.setsid()\n    if os.fork() == 0: time.sleep(600)", "pass"
    ),
    "daemon that keeps the pipe and ignores signals": Attack(
        "right()\nif os.fork() == 0:\n    os.setsid()\n    [signal.signal(n, signal.SIG_IGN) for n in (1, 2, 15)]\n"
        "    time.sleep(600)",
        "pass",
    ),
    "memory bomb": Attack("x = []\nwhile True: x.append(bytearray(b'x') * 10**7)", "invalid", "limit of memory"),
    "memory bomb in many processes": Attack(
        "for _ in range(8):\n    if os.fork() == 0:\n        x = bytearray(b'x') * (60 * 10**6); time.sleep(9)\ntime.sleep(9)",  # noqa: E501
        "invalid",
        "limit of memory",
    ),
    "disk filler beside the image": Attack(
        "for k in range(99):\n    with open(os.path.dirname(image) + f'/{k}', 'wb') as f: f.write(bytes(10**7))\ntime.sleep(9)",  # noqa: E501
        "invalid",
        "limit of disk",
    ),
    "a million empty files": Attack(
        "k = 0\nwhile True:\n    k += 1\n    open(os.path.dirname(image) + f'/{k}', 'w').close()",
        "",  # of the disk's limit or of the time's, by how fast the disk is
    ),
    "disk filler in tmp": Attack(
        "try:\n    open('/tmp/x', 'wb').write(bytes(10**8))\nexcept OSError as e: sys.exit(str(e))",
        "error",
        "No space left",
    ),
    "disk filler in shared memory": Attack(
        "try:\n    open('/dev/shm/x', 'wb').write(bytes(10**8))\nexcept OSError as e: sys.exit(str(e))",
        "error",
        "No space left",
    ),
    "disk filler in the root and in dev": Attack(
        f"for p in {('/x', '/dev/x', *map(str, FORBIDDEN))}:\n    try: open(p, 'w'); sys.exit(p)\n"
        "    except OSError: pass\nright()",
        "pass",
    ),
    "stdout flood": Attack("while True: os.write(1, bytes(1 << 16))", "invalid", "printed more than 16 MiB"),
    "sleep": Attack("time.sleep(600)", "timeout", "no picture within 2 s"),
    "sleep with its output closed": Attack("os.close(1); os.close(2); time.sleep(600)", "timeout", "within 2 s"),
    "busy loop": Attack("while True: pass", "timeout", "no picture within 2 s"),
    "symlink as image": Attack("os.symlink('/etc/hostname', image)", "invalid", "cannot be opened"),
    "symlink to a device": Attack("os.symlink('/dev/zero', image)", "invalid", "cannot be opened"),
    "pipe as image": Attack("os.mkfifo(image)", "invalid", "not a regular file"),
    "folder as image": Attack("os.mkdir(image)", "invalid", "not a regular file"),
    "folders without end": Attack(
        "os.chdir(os.path.dirname(image))\nfor _ in range(3000): os.mkdir('d'); os.chdir('d')\nopen(image, 'w')",
        "invalid",
        "header ends early",
    ),
    "huge sparse image": Attack("open(image, 'wb').truncate(1 << 24)", "invalid", "16777216 bytes"),
    "png bomb": Attack(PNG_BOMB, "invalid", "60000x60000", 'image = "png"'),
    "ppm bomb": Attack("open(image, 'wb').write(b'P6 99999 99999 255 x')", "invalid", "99999x99999", 'image = "ppm"'),
    "exr header of nonsense": Attack(
        "open(image, 'wb').write(bytes.fromhex('762f3101') + os.urandom(9999))", "invalid", "", 'image = "exr"'
    ),
    "reads its neighbours": Attack(
        f"for p in ('..', '../..', *{OURS}, os.path.dirname(os.path.dirname(image))):\n"
        "    try: found = os.listdir(p)\n    except OSError: continue\n"
        "    print(p, found)\n"
        "sys.exit(','.join(sorted(os.listdir(os.path.dirname(os.path.dirname(scene))))))",
        "error",
        "exit status 1",
    ),
    "reads a golden, the rubric, another submission": Attack(
        f"hits = subprocess.run(['grep', '-rlsI', '{MARK[:9]}' + '{MARK[9:]}', *{OURS}, '/tmp', '/etc', '/var'],"
        " capture_output=True, text=True).stdout\nif hits: sys.exit('FOUND ' + hits)\nright()",
        "pass",
    ),
    "network": Attack(
        "for target in (('1.1.1.1', 53), ('127.0.0.1', 22)):\n    s = socket.socket(); s.settimeout(1)\n"
        "    try: s.connect(target); sys.exit('connected')\n    except OSError: pass\nright()",
        "pass",
    ),
    "writes to the suite and to its own folder": Attack(
        "for p in (__file__, 'raycheck.toml', scene, '/usr/bin/python3'):\n"
        "    try: open(p, 'a'); sys.exit('opened ' + p)\n    except OSError: pass\nright()",
        "pass",
    ),
    "kills every process": Attack(
        "for pid in (1, os.getppid()):\n    try: os.kill(pid, 9)\n    except OSError: pass\n"
        "signal.signal(15, signal.SIG_IGN)\ntry: os.kill(-1, 15)\nexcept OSError: pass\nright()",
        "",  # it may reach its own keeper, and dies of that
    ),
    "dies of a signal": Attack("os.kill(os.getpid(), 11)", "crash", "SIGSEGV"),
    "becomes root again": Attack(
        "for f in (lambda: os.setuid(0), lambda: os.unshare(0x10000000) if hasattr(os, 'unshare') else 1/0):\n"
        "    try: f(); sys.exit('became')\n    except (OSError, ZeroDivisionError): pass\n"
        "import ctypes\nif ctypes.CDLL(None).unshare(0x10000000) == 0: sys.exit('new namespace')\n"
        "open('/proc/sys/kernel/core_pattern', 'w')",
        "error",
        "exit status 1: ",
    ),
    "own result file": Attack(
        "for p in ('results.json', os.path.dirname(image) + '/results.json', '/tmp/results.json'):\n"
        "    try: open(p, 'w').write('{\"score\": 100}')\n    except OSError: pass",
        "invalid",
        "no image was written",
    ),
    "terminal escapes": Attack(
        "print('\\x1b]0;owned\\x07\\x1b[31m<script>alert(1)</script>'); sys.exit(1)", "error", "<script>"
    ),
    "races on its output file": Attack(
        "right()\nif os.fork() == 0:\n    os.setsid()\n    while True:\n        try: os.unlink(image)\n"
        "        except OSError: pass\n        try: os.symlink('/etc/passwd', image)\n        except OSError: pass",
        "",
    ),
}


@pytest.fixture(scope="module")
def places(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder of temporary files of its own, so that what is left over is seen."""
    folder = tmp_path_factory.mktemp("temporary")
    usual, tempfile.tempdir = tempfile.tempdir, str(folder)
    yield folder
    tempfile.tempdir = usual


@pytest.fixture
def graded(tmp_path: Path, places: Path) -> Callable[..., Record]:
    """Grade one submission, then look for what outlived it."""

    def run(submission: Submission | None = None, limits: Mapping[str, float] = NONE) -> Record:
        out = tmp_path / "out"
        for name in ("records", "students"):
            (out / name).mkdir(parents=True)
        (tmp_path / "rubric.toml").write_text(f"# {MARK}", "utf-8")
        before = set(descendants(os.getpid()))
        begin = time.monotonic()
        held = RUBRIC.limits.model_copy(update=dict(limits))
        rubric = RUBRIC.model_copy(update={"limits": held})
        record = grade(Asked(rubric, 3, out, Jail(held)), submission or found(tmp_path / "class")[0])
        assert time.monotonic() - begin < 300.0
        assert set(descendants(os.getpid())) <= before, "a process outlived the grading"
        assert list(places.iterdir()) == [], "a file outlived the grading"
        assert {p.name for p in tmp_path.iterdir()} <= {"class", "out", "rubric.toml"}
        return record

    return run


@pytest.fixture
def handed_in(tmp_path: Path) -> Callable[..., Path]:
    """A submission in Python of this body."""

    def write(body: str, more: str = "", name: str = "mallory") -> Path:
        folder = tmp_path / "class" / name
        folder.mkdir(parents=True)
        (folder / "tracer.py").write_text(READER + body, "utf-8")
        render = 'render = ["python3", "-S", "tracer.py", "{scene}", "{image}"]'
        (folder / "raycheck.toml").write_text(f'[tracer]\nname = "<script>"\n{render}\n{more}\n', "utf-8")
        return folder

    return write


@pytest.mark.parametrize("name", ATTACKS)
def test_an_attack_gets_its_verdict_and_leaves_nothing(
    graded: Callable[..., Record], handed_in: Callable[..., Path], tmp_path: Path, name: str
) -> None:
    attack = ATTACKS[name]
    handed_in(attack.body, attack.more)
    record = graded(limits=attack.limits)
    first = record.groups[0].lines[0]
    if attack.verdict:
        assert (first.verdict, attack.message in first.why) == (attack.verdict, True), first
    told = results.read(tmp_path / "out" / "students" / record.slug)
    assert MARK not in told.model_dump_json()
    assert "root:x:" not in told.model_dump_json()


def test_a_tracer_that_looks_around_sees_only_its_own(
    graded: Callable[..., Record], handed_in: Callable[..., Path], tmp_path: Path
) -> None:
    handed_in(
        "print('ROOT', sorted(os.listdir('/'))); print('TMP', len(os.listdir('/tmp'))); print('PS', "
        "len([p for p in os.listdir('/proc') if p.isdigit()])); print('ENV', sorted(os.environ)); sys.exit(1)"
    )
    record = graded()
    process = results.read(tmp_path / "out" / "students" / record.slug).verdicts[0].process
    assert process is not None
    seen = dict(line.split(" ", 1) for line in process.output_tail.splitlines() if line[:2].isupper())
    suite = {Path(raycheck.__file__).parts[1]} - {"tmp", "usr"}  # these it has of its own, and to read
    assert not (suite | {"home", "opt", "mnt", "srv", "var", "boot", "sys"}) & set(eval(seen["ROOT"]))  # noqa: S307
    assert int(seen["PS"]) <= 4
    assert set(eval(seen["ENV"])) <= {"HOME", "LANG", "LC_CTYPE", "PATH", "PWD", "TMPDIR"}  # noqa: S307


BUILDS = {
    "build that fails": ("false", "build"),
    "build that hangs": ("sleep 600", "build"),
    "build that forks": ("f() { f | f & }; f; sleep 600", "build"),
    "build that fills the disk": ("while :; do head -c 9000000 /dev/zero > $RANDOM$$.$((n=n+1)); done", "build"),
    "build that edits the suite": (f"touch {shlex.join(map(str, FORBIDDEN))}", "build"),
    "build that preloads": ("export LD_PRELOAD=$PWD/x.so; echo LD_PRELOAD=$PWD/x.so > /tmp/profile; exit 1", "build"),
    "build that replaces its manifest": (
        'printf \'[tracer]\\nname="x"\\nrender=["true"]\\n\' > raycheck.toml',
        "graded",
    ),
    "build that leaves links": ("ln -s /etc/passwd tracer; ln -sf / root", "graded"),
    "build that locks its folder": ("mkdir -p locked/in; chmod 000 locked", "graded"),
}


@pytest.mark.parametrize("name", BUILDS)
def test_a_hostile_build_is_held_too(graded: Callable[..., Record], handed_in: Callable[..., Path], name: str) -> None:
    command, outcome = BUILDS[name]
    folder = handed_in("right()", 'build = ["make"]')
    (folder / "Makefile").write_text("all:\n\t@" + command.replace("$", "$$") + "\n", "utf-8")
    record = graded(limits=SHORT if outcome == "build" else {})
    assert record.outcome == outcome, record.message
    assert not any(path.exists() for path in FORBIDDEN)
    if outcome == "graded":
        assert record.groups[0].lines[0].verdict == "pass"


MANIFESTS = {
    "no manifest": None,
    "not toml": "[tracer",
    "path in the image's name": '[tracer]\nname="x"\nrender=["true", "{scene}"]\nimage="../../x"',
    "not a program": '[tracer]\nname="x"\nrender=["./no-such", "{scene}", "{image}"]',
    "deep": "a = " + "[" * 9999,
}


@pytest.mark.parametrize("name", MANIFESTS)
def test_a_manifest_that_cannot_be_used_is_said_to_be_one(
    graded: Callable[..., Record], handed_in: Callable[..., Path], name: str
) -> None:
    folder = handed_in("right()")
    text = MANIFESTS[name]
    (folder / "raycheck.toml").unlink()
    if text is not None:
        (folder / "raycheck.toml").write_text(text, "utf-8")
    record = graded()
    assert record.outcome == ("start" if name == "not a program" else "manifest")
    assert record.earned == 0.0
    assert str(folder.parent.parent) not in record.message


def test_a_link_in_a_folder_is_refused(graded: Callable[..., Record], handed_in: Callable[..., Path]) -> None:
    folder = handed_in("right()")
    (folder / "passwords").symlink_to("/etc/passwd")
    record = graded()
    assert (record.outcome, "'passwords' is a link" in record.message) == ("refused", True)


def test_a_submission_that_is_a_link_is_refused(
    graded: Callable[..., Record], handed_in: Callable[..., Path], tmp_path: Path
) -> None:
    handed_in("right()", name="victim")
    (tmp_path / "class" / "thief").symlink_to(tmp_path / "class" / "victim")
    assert graded(found(tmp_path / "class")[0]).outcome == "refused"


def test_canned_pictures_earn_nothing(graded: Callable[..., Record], handed_in: Callable[..., Path]) -> None:
    # Right at the catalogue's own size, whatever is asked
    handed_in("if (width, height) != (160, 120): width, height = 160, 120\nright()")
    record = graded()
    assert record.earned == 0.0
    assert record.outcome == "protocol"


def test_a_hang_in_every_scene_costs_three_timeouts(
    graded: Callable[..., Record], handed_in: Callable[..., Path]
) -> None:
    handed_in("time.sleep(600)")
    assert [line.verdict for line in graded(limits=SHORT).groups[0].lines] == ["timeout", "timeout"]
