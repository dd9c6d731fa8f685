"""The command line. Imports nothing heavy until a command runs, so that --help is immediate."""

from __future__ import annotations

import argparse
import importlib
import io
import os
import signal
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

from raycheck import VERSION
from raycheck.errors import BROKEN, CONFORMS, INTERRUPTED, MISUSE, RaycheckError, UsageError

EXIT_CODES = """exit codes: 0 conforms, 1 does not conform, 2 the call, scene or manifest is wrong,
3 the tracer could not be started, 4 the suite itself failed, 130 interrupted"""

SUBJECT = """SUBJECT is a folder with raycheck.toml, builtin:reference[/plain|numpy|drjit[/32|64]],
builtin:mitsuba[/scalar_rgb|llvm_ad_rgb[/stock|/path]], builtin:povray, builtin:fault/NAME[/32|64],
images:DIR (one image a scene), python:module:attr (trusted code), or nothing and the tracer's command after --:
  raycheck check -- ./tracer {scene} {image}"""

ARRAYS = """SUBJECT is a folder whose raycheck.toml has a probe, or python:module:attr with sphere(o, v, c, r) or
refract(v, n, index) on arrays (trusted code); without it our own methods are measured."""

TRACERS = (
    """SUBJECT is a folder with raycheck.toml, builtin:reference[/plain|numpy|drjit[/32|64]] or python:module:attr."""
)


class Parser(argparse.ArgumentParser):
    """Errors in one line, exit code 2; options are written out."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        self.exit(MISUSE, f"raycheck: {message} (see {self.prog} --help)\n")


def parser() -> Parser:
    """All commands and their arguments."""
    top = Parser(prog="raycheck", description="Validation and test oracles for ray tracers.", epilog=EXIT_CODES)
    top.add_argument("--version", action="version", version=f"raycheck {VERSION}")
    commands = top.add_subparsers(dest="run", metavar="COMMAND", required=True)

    demo = _add(commands, "demo", "check a good and a deliberately wrong example tracer, and write both reports")
    demo.add_argument("--out", default="raycheck-demo", metavar="DIR", help="where the reports go (%(default)s)")

    check = _add(commands, "check", "run the conformance suite against a tracer", SUBJECT)
    _subject(check)
    check.add_argument(
        "--scenes", metavar="A,B", help="only these scenes (see raycheck scenes) or scene files, and no laws"
    )
    check.add_argument("--laws", metavar="A,B", help="only these laws or groups of laws (see docs/laws.md)")
    check.add_argument(
        "--explore", type=int, default=0, metavar="N", help="N more cases of each law, by chance (%(default)s)"
    )
    check.add_argument("--size", metavar="WxH", help="picture size instead of each scene's own; pixels stay square")
    check.add_argument("--out", default="raycheck-report", metavar="DIR", help="where the report goes (%(default)s)")
    check.add_argument("--seed", type=int, default=0, metavar="N", help="handed to the tracer as {seed} (%(default)s)")
    check.add_argument("--known", metavar="FILE", help="TOML list of known failures: [[known]] check, reason, url")
    check.add_argument("--no-block", action="store_true", help="ask every rung, even where one it builds on failed")
    check.add_argument("--no-shrink", action="store_true", help="do not look for the smallest scenes that fail")
    check.add_argument(
        "--sandbox", action="store_true", help="build and run a copy of the folder where it reaches nothing"
    )

    smoke = _add(
        commands,
        "smoke",
        "show one small scene with everything sent and received, to find out why an adapter fails",
        SUBJECT,
    )
    _subject(smoke)

    render = _add(commands, "render", "render a scene with the reference tracer")
    render.add_argument("scene", metavar="SCENE", help="a scene file (.json, .txt) or a name of the catalogue")
    render.add_argument("image", metavar="IMAGE", help="where to; its ending says how: .exr .pfm .ppm .png .npy")
    render.add_argument(
        "--arithmetic", choices=("plain", "numpy", "drjit", "certified", "exact"), help="default: the fastest there is"
    )
    render.add_argument("--precision", type=int, choices=(32, 64), default=64, help="bits (%(default)s)")
    render.add_argument("--size", metavar="WxH", help="picture size instead of the scene's own; pixels stay square")
    render.add_argument("--depth", type=int, metavar="N", help="generations after the eye ray, 0 to 16")

    golden = _add(commands, "golden", "make golden images with certified bounds, or verify that they still stand")
    golden.add_argument("action", choices=("make", "verify"), help="what to do")
    golden.add_argument("folder", metavar="DIR", help="where the goldens are")
    golden.add_argument("--scenes", metavar="A,B", help="make: only these scenes of the catalogue")
    golden.add_argument("--size", metavar="WxH", help="make: picture size instead of each scene's own")
    _dialect(golden)
    golden.add_argument("--jobs", type=int, default=1, metavar="N", help="make: processes at work (%(default)s)")

    compare = _add(commands, "compare", "compare one image with one golden")
    compare.add_argument("image", metavar="IMAGE", help="any ending a tracer may write")
    compare.add_argument("golden", metavar="GOLDEN", help="a file of the golden, for example goldens/glass-sphere.exr")
    compare.add_argument(
        "--precision",
        choices=("32", "64", "8bit"),
        default="32",
        help="what the image was computed in; 8bit: compare as displayed (%(default)s)",
    )

    scenes = _add(commands, "scenes", "list the catalogue, or print one scene")
    scenes.add_argument("name", nargs="?", metavar="NAME", help="a name of the catalogue, or a scene file")
    scenes.add_argument(
        "--as",
        dest="form",
        choices=("json", "text", "mitsuba", "povray"),
        default="json",
        help="notation (%(default)s)",
    )

    peers = _add(commands, "peers", "render with every peer at hand, and let certified truth say who is wrong")
    peers.add_argument("--scenes", metavar="A,B", help="only these scenes of the catalogue (see raycheck scenes)")
    peers.add_argument("--size", metavar="WxH", help="picture size instead of each scene's own; pixels stay square")
    peers.add_argument("--out", default="raycheck-peers", metavar="DIR", help="where the report goes (%(default)s)")

    stability = _add(commands, "stability", "where methods fail: maps, frontiers, named cases", ARRAYS)
    stability.add_argument("subject", nargs="?", metavar="SUBJECT", help="a tracer to ask as well")
    stability.add_argument("--precision", choices=("float32", "float64"), help="what SUBJECT computes in (float32)")
    stability.add_argument(
        "--out", default="raycheck-stability", metavar="DIR", help="where the report goes (%(default)s)"
    )
    stability.add_argument("--seed", type=int, default=0, metavar="N", help="of the random inputs (%(default)s)")

    chart = _add(commands, "chart", "speed against accuracy: methods, number types, depth, whole tracers", TRACERS)
    chart.add_argument("subjects", nargs="*", metavar="SUBJECT", help="tracers to race against ours")
    chart.add_argument("--precision", choices=("float32", "float64"), help="what a Python object computes in (float32)")
    chart.add_argument("--out", default="raycheck-chart", metavar="DIR", help="where the report goes (%(default)s)")
    chart.add_argument("--seed", type=int, default=0, metavar="N", help="of the random inputs (%(default)s)")

    needs = _add(commands, "needs", "what a scene needs: features, depth, precision, method; what more costs")
    needs.add_argument("scene", metavar="SCENE", help="a scene file (.json, .txt) or a name of the catalogue")
    needs.add_argument("--size", metavar="WxH", help="picture size instead of the scene's own; pixels stay square")

    grade = _add(commands, "grade", "grade a class of submissions by a rubric, in a sandbox")
    grade.add_argument(
        "submissions", nargs="?", metavar="SUBMISSIONS", help="a folder with one folder or archive a submission"
    )
    grade.add_argument("--rubric", metavar="FILE", help="TOML: groups of rungs and their points (one ships)")
    grade.add_argument("--out", default="raycheck-grades", metavar="DIR", help="where all results go (%(default)s)")
    grade.add_argument("--jobs", type=int, default=1, metavar="N", help="submissions at a time (%(default)s)")
    grade.add_argument("--cluster", metavar="ADDRESS", help="grade on a Dask cluster instead, tcp://HOST:PORT")
    grade.add_argument("--seed", type=int, metavar="N", help="of picture size and hidden scenes (drawn once per DIR)")
    grade.add_argument("--adjust", metavar="FILE", help="CSV of points by hand: submission, points, reason")
    grade.add_argument("--only", metavar="A,B", help="only these submissions")
    grade.add_argument("--rerun-failed", action="store_true", help="ask those again that were not graded or too slow")
    grade.add_argument("--explain", metavar="NAME", help="grade nothing; say how this score came about")
    grade.add_argument("--gradescope-bundle", metavar="ZIP", help="grade nothing; write an autograder of this rubric")
    grade.add_argument("--i-trust-this-code", action="store_true", help="run the submissions without a sandbox")

    faults = _add(commands, "faults", "the known mistakes, or one of them explained")
    faults.add_argument("name", nargs="?", metavar="NAME", help="a name of the list")
    faults.add_argument("--explain", metavar="NAME", help="the same as NAME")
    faults.add_argument("--out", metavar="DIR", help="write a page for each, or for NAME, with its pictures")

    power = _add(commands, "power", "which scenes notice which known mistake, and whether any fails a correct tracer")
    power.add_argument("--size", metavar="WxH", help="picture size instead of each scene's own; pixels stay square")
    power.add_argument("--out", default="raycheck-power", metavar="DIR", help="where the report goes (%(default)s)")

    init = _add(commands, "init", "write a tracer to begin with: all but the formulas is done")
    init.add_argument("language", choices=("cpp", "python", "rust", "go", "java", "javascript"), help="its language")
    init.add_argument("folder", metavar="DIR", help="a new or empty folder")

    report = _add(commands, "report", "write a report again from its results")
    report.add_argument("folder", metavar="DIR", help="a folder that holds results.json")

    _add(commands, "doctor", "what is installed, what is missing, and the command that adds it")
    return top


def _add(commands: argparse._SubParsersAction[Parser], name: str, what: str, more: str = "") -> Parser:
    return commands.add_parser(
        name,
        help=what,
        description=f"{what[0].upper()}{what[1:]}.",
        epilog=f"{more}\n\n{EXIT_CODES}".strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )


def _subject(command: Parser) -> None:
    command.add_argument("subject", nargs="?", metavar="SUBJECT", help="the tracer, see below")
    command.add_argument("--scene", choices=("text", "json"), help="scene notation of a -- COMMAND (text)")
    command.add_argument(
        "--image", choices=("pfm", "exr", "npy", "ppm", "png"), help="image ending of a -- COMMAND (pfm)"
    )
    command.add_argument(
        "--precision",
        choices=("float32", "float64"),
        help="what a -- COMMAND, images or a Python object compute in: tolerances follow from it (float32)",
    )
    _dialect(command)


def _dialect(command: Parser) -> None:
    command.add_argument(
        "--dialect",
        action="append",
        metavar="KEY=VALUE",
        help="a lawful convention other than the scene model's, as in [tracer.dialect]; may be repeated",
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    tracer: list[str] | None = None
    if "--" in words:
        at = words.index("--")
        words, tracer = words[:at], words[at + 1 :]
    options = parser().parse_args(words)
    options.tracer = tracer
    options.words = words
    code = CONFORMS
    try:
        _examine(options)
        command = importlib.import_module(f"raycheck.commands.{options.run}")
        code = command.run(options)
    except RaycheckError as error:
        print(f"raycheck: {error}", file=sys.stderr)
        return error.code
    except KeyboardInterrupt:
        print("raycheck: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        pass  # whoever reads our output has read enough
    except Exception as error:
        return _broken(error)
    _flush()
    return code


def _examine(options: argparse.Namespace) -> None:
    """What argparse cannot see: a command after -- that no one asked for, and words that no file can repeat."""
    if options.tracer is not None and not hasattr(options, "subject"):
        raise UsageError(f"raycheck {options.run} takes no command after --", "one for check and smoke")
    for word in (*options.words, *(options.tracer or ())):
        if any("\ud800" <= c <= "\udfff" for c in word):
            raise UsageError(f"{word!r} is not UTF-8", "names that a report can hold")


def _flush() -> None:
    """Send off what stdout holds back; where its reader has gone, to nowhere, also when Python ends."""
    try:
        print(end="", flush=True)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _broken(error: Exception) -> int:
    """An error that no one foresaw is a bug of ours, and said to be one."""
    import errno

    from scenes.errors import SceneError

    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EIO):
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # what is left in the buffer has nowhere to go
        print(f"raycheck: cannot write: {error.strerror}; make room and run it again", file=sys.stderr)
        return MISUSE

    if isinstance(error, SceneError):
        print(f"raycheck: {error}", file=sys.stderr)
        return MISUSE
    import traceback

    traceback.print_exc()
    print(f"raycheck: the suite itself failed ({type(error).__name__}); this is a bug of raycheck", file=sys.stderr)
    return BROKEN


def entry() -> NoReturn:
    """The console script: told to stop it still writes what it has; a letter that stdout lacks stops nothing."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")
    raise SystemExit(main())
