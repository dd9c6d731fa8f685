"""A folder of pictures, one a scene, named by the scene: nothing is executed."""

from __future__ import annotations

from pathlib import Path

from oracles.images import ENDINGS, ImageError, read
from raycheck.errors import UsageError
from raycheck.subjects.subject import Attempt
from reference_tracer.dialects import Dialect
from scenes.model import Scene


class ImagesSubject:
    """Pictures that somebody rendered before."""

    in_process = False
    scene_form = ""
    features: tuple[str, ...] | None = None
    spp: int | None = None

    def __init__(self, folder: Path, precision: str, dialect: Dialect) -> None:
        if not folder.is_dir():
            raise UsageError(f"images:{folder}: no such folder", "a folder with one image a scene, named by the scene")
        self.folder = folder
        self.name = f"images in {folder.resolve().name or folder}"
        self.spec = f"images:{folder}"
        self.precision = precision
        self.dialect = dialect
        self.image_form = "any of " + ", ".join(ENDINGS)

    def prepare(self) -> None:
        """Nothing to build."""

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Read the picture of that name, in the first format found."""
        for ending in ENDINGS:
            path = self.folder / f"{scene.name}.{ending}"
            if path.exists() or path.is_symlink():
                try:
                    return Attempt(read(path, scene.image.width, scene.image.height))
                except ImageError as error:
                    return Attempt(None, "invalid", f"{path.name}: {error}")
        names = ", ".join(f"{scene.name}.{ending}" for ending in ENDINGS)
        return Attempt(None, "invalid", f"no picture of this scene; expected one of {names}")
