"""A Gradescope autograder: a zip of setup.sh, run_autograder and the rubric.

Source: Gradescope, "Autograder Specifications".
"""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

from raycheck import VERSION
from scenes.disk import write_whole

SETUP = """#!/bin/sh
# Runs once, when Gradescope builds the image.
set -e
apt-get update
apt-get install -y --no-install-recommends python3 python3-venv bubblewrap util-linux g++ make
python3 -m venv /autograder/raycheck
/autograder/raycheck/bin/pip install raycheck=={version}
"""

RUN = """#!/bin/sh
# Runs for each submission; whatever happens, results.json says so.
root=${{AUTOGRADER_ROOT:-/autograder}}
raycheck=${{RAYCHECK:-$root/raycheck/bin/raycheck}}
rm -rf "$root/class" "$root/grades"
mkdir -p "$root/class" "$root/results"
cp -R "$root/submission" "$root/class/submission"
if "$raycheck" grade "$root/class" --rubric "$root/source/rubric.toml" --out "$root/grades"{trust} > "$root/told" 2>&1
then
    cp "$root/grades/students/submission/gradescope.json" "$root/results/results.json"
else
    cat "$root/told"
    echo '{{"score": 0, "output": "The grader could not run; tell your instructor.", "visibility": "visible"}}' \\
        > "$root/results/results.json"
fi
"""

_EXECUTABLE, _PLAIN = 0o100755, 0o100644
_THEN = (1980, 1, 1, 0, 0, 0)
"""The same bundle, the same bytes."""


def write(path: Path, rubric: str, trusted: bool) -> None:
    """Write the bundle for this rubric; trusted: grade also where the container has no sandbox."""
    made = io.BytesIO()
    files = {
        "setup.sh": (SETUP.format(version=VERSION), _EXECUTABLE),
        "run_autograder": (RUN.format(trust=" --i-trust-this-code" if trusted else ""), _EXECUTABLE),
        "rubric.toml": (rubric, _PLAIN),
    }
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as bundle:
        for name, (text, mode) in files.items():
            entry = zipfile.ZipInfo(name, _THEN)
            entry.external_attr = mode << 16
            bundle.writestr(entry, text)
    write_whole(path, made.getvalue())
