"""What grading costs, and that nothing changes its outcome: a synthetic class on one process, two, and a cluster.

    python benchmarks/grading.py [--members 60] [--kills 20] [--seeds 200]

Prints: float32 examples over drawn scenes; time a submission with one job and two; kill -9 at random
moments; a Dask cluster of two workers, one killed midway; the cost of the jail itself.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from oracles.compare import compare
from oracles.images import read
from oracles.truth import truth
from raycheck import process
from raycheck.examples import examples
from raycheck.grading.synthetic import members, write
from raycheck.lanes import best_lanes
from raycheck.sandbox import OPEN, Jail
from scenes.generator import generate
from scenes.text import to_text

ROOT = Path(__file__).resolve().parents[1]
CALL = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()"]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT)}
RUBRIC = """
name = "benchmark"
[[group]]
name = "rays"
points = 8
rungs = ["pixel-corner", "pixel-centre", "off-centre-camera"]
[[group]]
name = "light"
points = 12
rungs = ["phong-10", "attenuation-inverse-square", "shadow-hard"]
[[group]]
name = "branches"
points = 20
rungs = ["mirror-imperfect", "facing-mirrors-3", "glass-sphere"]
[hidden]
points = 10
scenes = 4
"""


def main() -> None:
    """Run all parts."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--members", type=int, default=60)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seeds", type=int, default=200)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "rubric.toml").write_text(RUBRIC, "utf-8")
        jail_cost(folder)
        drawn_scenes(folder, options.seeds)
        the_class = folder / "class"
        everyone = members(options.members)
        for member in everyone:
            write(member, the_class)
        one, two = (graded(folder, f"jobs-{jobs}", "--jobs", str(jobs)) for jobs in (1, 2))
        for jobs, seconds in ((1, one), (2, two)):
            print(f"{len(everyone)} submissions, {jobs} job(s): {seconds:.0f} s, {seconds / len(everyone):.2f} s each")
        cluster(folder, len(everyone))
        same(folder, "jobs-1", "jobs-2", "cluster")
        kills(folder, options.kills)


def jail_cost(folder: Path) -> None:
    """Starting and ending one program that does nothing."""
    for name, room in (("no sandbox", OPEN), ("sandbox", Jail())):
        times = []
        for _ in range(50):
            with room.hold(read=(), write=(folder,)) as hold:
                times.append(process.run(["true"], folder, 10.0, 2**20, hold=hold).seconds)
        print(f"one run of `true`, {name}: median {1000 * statistics.median(times):.1f} ms")


def drawn_scenes(folder: Path, count: int) -> None:
    """The float32 C++ example over drawn scenes."""
    source = shutil.copytree(examples() / "cpp_lecture", folder / "cpp", ignore=shutil.ignore_patterns("tracer"))
    subprocess.run(["make", "-s"], cwd=source, check=True)
    passed = 0
    for seed in range(count):
        scene = generate(seed)
        (folder / "scene.txt").write_text(to_text(scene), "utf-8")
        subprocess.run([source / "tracer", folder / "scene.txt", folder / "image.pfm"], check=True)
        picture = read(folder / "image.pfm", scene.image.width, scene.image.height)
        passed += compare(picture, truth(scene, "float32", best_lanes())).word == "pass"
    print(f"drawn scenes: the float32 C++ example passes {passed} of {count}")


def words(folder: Path, out: str) -> list[str]:
    """The call that grades the class into a folder."""
    rubric = str(folder / "rubric.toml")
    return [*CALL, "grade", str(folder / "class"), "--rubric", rubric, "--seed", "5", "--out", str(folder / out)]


def graded(folder: Path, out: str, *more: str) -> float:
    """Seconds that it took."""
    begin = time.monotonic()
    subprocess.run([*words(folder, out), *more], env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def same(folder: Path, *outs: str) -> None:
    """Are the grades the same, byte for byte."""
    tables = {(folder / out / "grades.csv").read_bytes() for out in outs}
    print(f"grades.csv of {', '.join(outs)}: {'the same bytes' if len(tables) == 1 else 'DIFFERENT'}")


def cluster(folder: Path, count: int) -> None:
    """Two workers, one of them killed midway."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    python = [sys.executable, "-P", "-m"]
    worker = ["--nthreads", "1", "--no-dashboard", "--no-nanny", "--local-directory", str(folder / "workers")]
    calls = [
        [*python, "distributed.cli.dask_scheduler", "--host", address, "--no-dashboard"],
        *[[*python, "distributed.cli.dask_worker", address, *worker] for _ in range(2)],
    ]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    started = [subprocess.Popen(call, env=ENVIRONMENT, **quiet) for call in calls]
    try:
        begin = time.monotonic()
        run = subprocess.Popen(
            [*words(folder, "cluster"), "--cluster", address], env=ENVIRONMENT, stdout=subprocess.DEVNULL
        )
        while run.poll() is None and len(list((folder / "cluster").glob("records/*.json"))) < count // 2:
            time.sleep(0.1)
        started[1].kill()
        run.wait()
        print(f"cluster of two, one killed midway: {time.monotonic() - begin:.0f} s, exit {run.returncode}")
    finally:
        for child in started:
            child.kill()
            child.wait()


def kills(folder: Path, count: int) -> None:
    """Kill -9 at random moments, then to the end."""
    draw = random.Random(11)  # noqa: S311
    struck = 0
    for _ in range(count):
        run = subprocess.Popen([*words(folder, "killed"), "--jobs", "2"], env=ENVIRONMENT, stdout=subprocess.DEVNULL)
        time.sleep(draw.uniform(0.5, 12.0))
        struck += run.poll() is None
        run.send_signal(signal.SIGKILL)
        run.wait()
    graded(folder, "killed", "--jobs", "2")
    print(f"kill -9: {struck} of {count} runs struck before their end")
    same(folder, "jobs-1", "killed")


if __name__ == "__main__":
    main()
