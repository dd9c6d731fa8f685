"""What grading costs, and that nothing changes its outcome: a synthetic class on one process, two, and a cluster.

    python benchmarks/grading.py [--part PART] [--members 60] [--kills 20] [--quick 40] [--seeds 200]

Prints, by part, jail: the cost of the jail itself; scenes: the float32 C++ example over drawn scenes; class: a class of
known faults, whether it scores as its faults imply, time a submission with one job and two, and a Dask cluster of two
workers, one killed midway; kills: kill -9 at random moments of a run of quick submissions.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from oracles.compare import compare
from oracles.images import read
from oracles.truth import truth
from raycheck import manifest, process
from raycheck.examples import examples
from raycheck.grading.expected import Expectation
from raycheck.grading.one import Asked
from raycheck.grading.rubric import load
from raycheck.grading.synthetic import RUBRIC, Member, members, write, write_quick
from raycheck.lanes import best_lanes
from raycheck.sandbox import OPEN, Jail
from reports import grades
from scenes.generator import generate
from scenes.text import to_text

ROOT = Path(__file__).resolve().parents[1]
CALL = [sys.executable, "-P", "-c", "from raycheck.cli import entry; entry()"]
ENVIRONMENT = os.environ | {"PYTHONPATH": str(ROOT)}
HIDDEN = """
[hidden]
points = 10
scenes = 4
"""
SEED = 5
PARTS = ("jail", "scenes", "class", "kills")


def main() -> None:
    """Run all parts."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--part", action="append", choices=PARTS, help="all unless named")
    parser.add_argument("--members", type=int, default=60)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--quick", type=int, default=40)
    parser.add_argument("--seeds", type=int, default=200)
    options = parser.parse_args()
    for part in options.part or PARTS:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            match part:
                case "jail":
                    jail_cost(folder)
                case "scenes":
                    drawn_scenes(folder, options.seeds)
                case "class":
                    known_faults(folder, options.members)
                case "kills":
                    kills(folder, options.kills, options.quick)


def known_faults(folder: Path, count: int) -> None:
    """The synthetic class on one process, two, and a cluster."""
    (folder / "rubric.toml").write_text(RUBRIC + HIDDEN, "utf-8")
    everyone = members(count)
    for member in everyone:
        write(member, folder / "class")
    for jobs in (1, 2):
        seconds = graded(folder, f"jobs-{jobs}", "--jobs", str(jobs))
        print(f"{len(everyone)} submissions, {jobs} job(s): {seconds:.0f} s, {seconds / len(everyone):.2f} s each")
    as_implied(folder, everyone)
    cluster(folder, len(everyone))
    print(f"grades.csv of one job, two, and the cluster: {same(folder, 'jobs-1', 'jobs-2', 'cluster')}")


def as_implied(folder: Path, everyone: Sequence[Member]) -> None:
    """Do the scores follow from the faults, as derived without running them."""
    expected = Expectation(Asked(load(folder / "rubric.toml"), SEED, folder, OPEN))
    right = 0
    for member in everyone:
        record = grades.read(folder / "jobs-1" / "records" / f"{member.name}.json")
        points = expected.points(member, manifest.load(folder / "class" / member.name).precision)
        if record is not None and [group.earned for group in record.groups] == points:
            right += 1
        else:
            print(f"{member.name}: {record and [group.earned for group in record.groups]}, implied {points}")
    print(f"scores as the faults imply: {right} of {len(everyone)}")


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
    return [*CALL, "grade", str(folder / "class"), "--rubric", rubric, "--seed", str(SEED), "--out", str(folder / out)]


def graded(folder: Path, out: str, *more: str) -> float:
    """Seconds that it took."""
    begin = time.monotonic()
    subprocess.run([*words(folder, out), *more], env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL)
    return time.monotonic() - begin


def same(folder: Path, *outs: str) -> str:
    """Are the grades the same, byte for byte."""
    return "the same bytes" if len({(folder / out / "grades.csv").read_bytes() for out in outs}) == 1 else "DIFFERENT"


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


def kills(folder: Path, count: int, quick: int) -> None:
    """Kill -9 so many runs midway, each going on where the last was struck; a run that ends by itself is compared."""
    write_quick(folder, quick)
    seconds = graded(folder, "whole", "--jobs", "2")
    draw = random.Random(11)  # noqa: S311
    struck, outs = 0, ["killed-0"]
    while struck < count:
        call = [*words(folder, outs[-1]), "--jobs", "2"]
        run = subprocess.Popen(call, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            run.wait(draw.uniform(0.2, 0.5 * seconds))
        except subprocess.TimeoutExpired:
            run.kill()
            run.wait()
            struck += 1
        else:
            outs.append(f"killed-{len(outs)}")
    graded(folder, outs[-1], "--jobs", "2")
    print(
        f"kill -9: {count} of {count} runs of {quick} submissions struck before their end, {len(outs)} times to the end"
    )
    print(f"grades.csv of all and of an uninterrupted run: {same(folder, 'whole', *outs)}")


if __name__ == "__main__":
    main()
