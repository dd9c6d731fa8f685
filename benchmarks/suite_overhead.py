"""A whole check of the C++ example: wall time, the tracer's own time, and what the suite adds."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

from raycheck.machine import machine
from reports import results

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "cpp_lecture"
ROUNDS = 3


def main() -> None:
    """Print each round; the first may compile kernels."""
    here = machine()
    print(f"{here.processor}, {here.cores} cores, Python {here.python}, {here.packages}, lanes: {here.lanes}")
    code = "from raycheck.cli import entry; entry()"
    for turn in range(ROUNDS):
        with tempfile.TemporaryDirectory() as folder:
            begin = time.perf_counter()
            command = [sys.executable, "-P", "-c", code, "check", str(EXAMPLE), "--out", folder]
            done = subprocess.run(command, check=False, stdout=subprocess.DEVNULL)
            wall = time.perf_counter() - begin
            tracer = sum(verdict.seconds for verdict in results.read(Path(folder)).verdicts)
        shares = f"wall {wall:.2f} s, tracer {tracer:.2f} s, suite {wall - tracer:.2f} s"
        print(f"round {turn}: exit {done.returncode}, {shares}")


if __name__ == "__main__":
    main()
