"""Tracers inside this process: the reference itself, and trusted Python objects."""

from __future__ import annotations

import contextlib
import importlib
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from oracles.images import ImageError, Picture
from oracles.images.picture import check, check_size
from raycheck.errors import StartError, UsageError
from raycheck.lanes import best_lanes
from raycheck.subjects.subject import Attempt
from reference_tracer import plain
from reference_tracer.dialects import SCENE_MODEL, Dialect
from reference_tracer.lanes import render as lanes
from scenes.json_form import to_json
from scenes.model import Scene

ARITHMETICS = ("plain", "numpy", "drjit")


class ReferenceSubject:
    """builtin:reference[/ARITHMETIC[/32|64]]: our own tracer, as anyone's."""

    in_process = True
    scene_form = ""
    image_form = ""
    features: tuple[str, ...] | None = None
    spp: int | None = None
    dialect = SCENE_MODEL

    def __init__(self, spec: str) -> None:
        self.spec = f"builtin:{spec}"
        _, *options = spec.split("/")
        self.arithmetic = options[0] if options else best_lanes()
        bits = options[1] if len(options) > 1 else "64"
        if self.arithmetic not in ARITHMETICS or bits not in ("32", "64") or len(options) > 2:
            raise UsageError(f"{self.spec}: no such reference", "builtin:reference/plain|numpy|drjit/32|64")
        if (self.arithmetic, bits) == ("plain", "32"):
            raise UsageError(f"{self.spec}: the plain tracer computes in 64 bits", "numpy or drjit for 32")
        self.bits = int(bits)
        self.precision = f"float{bits}"
        self.name = f"reference tracer ({self.arithmetic}, {self.precision})"

    def prepare(self) -> None:
        """Nothing to build."""

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Render with the chosen arithmetic."""
        begin = time.monotonic()
        if self.arithmetic == "plain":
            image = plain.render(scene)
        else:
            image = lanes.render(scene, lanes.backend(self.arithmetic, self.bits))
        picture = Picture(image.pixels.astype(np.float64), roundoff=2.0**-24 if self.bits == 32 else 0.0)
        return Attempt(picture, seconds=time.monotonic() - begin)


class PythonSubject:
    """python:module:attr, an object with `render(path)`, or `scene(path)`, `camera(i, j)` and `trace(o, v)`.

    For trusted code only. Arrays are batches: i, j of shape (n,), o, v and colours of (n, 3).
    """

    in_process = True
    scene_form = "json"
    image_form = "array"
    features: tuple[str, ...] | None = None
    spp: int | None = None

    def __init__(self, module: str, attribute: str, precision: str, dialect: Dialect) -> None:
        self.module, self.attribute = module, attribute
        self.spec = f"python:{module}:{attribute}"
        self.name = self.spec
        self.precision = precision
        self.dialect = dialect
        self.tracer: Any = None

    def prepare(self) -> None:
        """Import the module, from the current folder too, and find the object."""
        here = str(Path.cwd())
        sys.path.insert(0, here)
        try:
            self.tracer = getattr(importlib.import_module(self.module), self.attribute)
        except (Exception, SystemExit) as error:  # whatever a stranger's module does on import
            raise StartError(f"{self.spec}: {type(error).__name__}: {error}") from None
        finally:
            with contextlib.suppress(ValueError):
                sys.path.remove(here)
        if not (hasattr(self.tracer, "render") or hasattr(self.tracer, "trace")):
            raise StartError(f"{self.spec} can neither render nor trace", "see `python:` in docs/attaching.md")

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Call the object with the scene's file."""
        begin = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="raycheck-") as folder:
            path = Path(folder) / f"{scene.name}.json"
            path.write_text(to_json(scene), "utf-8")
            try:
                values = np.asarray(self._pixels(scene, path), dtype=np.float64)
            except ImageError as error:
                return Attempt(None, "invalid", str(error), seconds=time.monotonic() - begin)
            except (Exception, SystemExit) as error:  # a stranger's code: whatever it raises is its answer
                return Attempt(None, "error", f"{type(error).__name__}: {error}")
        seconds = time.monotonic() - begin
        try:
            if values.ndim != 3 or values.shape[2] != 3:
                raise ImageError(f"array of shape {values.shape}", hint="(height, width, 3)")
            check_size(values.shape[1], values.shape[0], (scene.image.width, scene.image.height))
            roundoff = 2.0**-24 if self.precision == "float32" else 0.0
            return Attempt(check(Picture(values, roundoff=roundoff)), seconds=seconds)
        except ImageError as error:
            return Attempt(None, "invalid", str(error), seconds=seconds)

    def _pixels(self, scene: Scene, path: Path) -> Any:
        if hasattr(self.tracer, "render"):
            return self.tracer.render(str(path))
        width, height = scene.image.width, scene.image.height
        self.tracer.scene(str(path))
        j, i = (index.ravel() for index in np.mgrid[0:height, 0:width])
        v = np.asarray(self.tracer.camera(i, j))
        o = np.broadcast_to(np.asarray(scene.camera.eye), v.shape)
        colours = np.asarray(self.tracer.trace(o, v))
        if colours.shape != (width * height, 3):
            raise ImageError(f"trace gives an array of shape {colours.shape}", hint=f"{(width * height, 3)}")
        return colours.reshape(height, width, 3)
