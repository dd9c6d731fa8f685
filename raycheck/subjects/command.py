"""A tracer that is a program: one process a scene."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, replace
from pathlib import Path

from oracles.images import ImageError, read
from oracles.verdict import Process
from raycheck import process
from raycheck.errors import StartError, UsageError
from raycheck.manifest import Manifest
from raycheck.sandbox.room import OPEN, Room
from raycheck.subjects.subject import Attempt, Problem
from raycheck.workspace import workspace
from scenes.json_form import to_json
from scenes.model import Scene
from scenes.text import to_text

BUILD_TIMEOUT = 600.0
BUILD_FILES = 2**31


@dataclass
class CommandSubject:
    """A manifest and the folder it is in; commands run there, in the room that they are given."""

    folder: Path
    manifest: Manifest
    spec: str
    room: Room = OPEN
    build_timeout: float = BUILD_TIMEOUT
    probe_budget: float = math.inf
    in_process: bool = False

    def __post_init__(self) -> None:
        self.name = self.manifest.name
        self.precision: str = self.manifest.precision
        self.scene_form: str = self.manifest.scene
        self.image_form: str = self.manifest.image
        self.dialect = self.manifest.dialect.choices()
        self.features: tuple[str, ...] | None = self.manifest.features
        self.spp: int | None = self.manifest.spp if self.manifest.stochastic else None
        command = " ".join(self.manifest.render)
        for word in ("{scene}", "{image}", "{seed}") if self.spp else ("{scene}", "{image}"):
            if word not in command:
                raise UsageError(f"render command {command!r} lacks {word}", "for example ./tracer {scene} {image}")

    def prepare(self) -> None:
        """Run the build command, if the manifest has one."""
        if self.manifest.build is None:
            return
        command = " ".join(self.manifest.build)
        try:
            with self.room.hold(read=(), write=(self.folder,)) as hold:
                ended = process.run(self.manifest.build, self.folder, self.build_timeout, BUILD_FILES, hold=hold)
        except OSError as error:
            raise StartError(f"build command {command!r} cannot run: {error.strerror}", "install it") from None
        if (ended.how, ended.code) != ("exited", 0):
            raise StartError(f"build command {command!r} failed ({ended.status}):\n{ended.tail}")

    def render(self, scene: Scene, seed: int) -> Attempt:
        """Write the scene, run the program, read the image; the files live in a folder of their own."""
        with workspace() as folder:
            scene_file = folder / f"{scene.name}.{'txt' if self.scene_form == 'text' else 'json'}"
            image_file = folder / "out" / f"{scene.name}.{self.image_form}"
            image_file.parent.mkdir()
            scene_file.write_text(to_text(scene) if self.scene_form == "text" else to_json(scene), "utf-8")
            with self.room.hold(read=(self.folder, scene_file), write=(image_file.parent,)) as hold:
                return self._run(scene, self.arguments(scene, scene_file, image_file, seed), image_file, hold)

    def arguments(self, scene: Scene, scene_file: Path, image_file: Path, seed: int) -> list[str]:
        """The command's words with the placeholders filled in."""
        values = {
            "{scene}": str(scene_file),
            "{image}": str(image_file),
            "{width}": str(scene.image.width),
            "{height}": str(scene.image.height),
            "{seed}": str(seed),
            "{spp}": str(self.manifest.spp),
        }
        words = []
        for word in self.manifest.render:
            for placeholder, value in values.items():
                word = word.replace(placeholder, value)
            words.append(word)
        return words

    def _run(self, scene: Scene, words: list[str], image_file: Path, hold: process.Hold) -> Attempt:
        width, height = scene.image.width, scene.image.height
        try:
            limit = 2**24 + 64 * width * height
            ended = process.run(words, self.folder, self.manifest.timeout, limit, hold=hold)
        except OSError as error:
            raise StartError(
                f"{words[0]!r} cannot be started: {error.strerror}", "check the path, and that it is executable"
            ) from None
        # The folder has another name each time: without it, equal runs tell equal stories
        for folder in (image_file.parent, image_file.parent.parent):
            ended = replace(ended, tail=ended.tail.replace(f"{folder}{os.sep}", ""))
        evidence = Process(
            command=self.manifest.render, status=ended.status, seconds=ended.seconds, output_tail=ended.tail
        )
        word, message = self._judge(ended)
        if word is None:
            try:
                return Attempt(read(image_file, width, height), process=evidence, seconds=ended.seconds)
            except ImageError as error:
                word, message = "invalid", str(error)
        return Attempt(None, word, message, evidence, ended.seconds)

    def _judge(self, ended: process.Ended) -> tuple[Problem | None, str]:
        match ended.how:
            case "timeout":
                return "timeout", f"no picture within {self.manifest.timeout:g} s"
            case "flood":
                return "invalid", f"printed more than {process.OUTPUT_LIMIT // 2**20} MiB and was stopped"
            case "memory" | "processes" | "disk":
                return "invalid", f"used more than its limit of {ended.how} and was stopped"
            case "signal":
                return "crash", f"the program was killed by {process.signal_name(ended.code)}"
            case _ if ended.code != 0:
                last = ended.tail.splitlines()[-1] if ended.tail else "it printed nothing"
                return "error", f"exit status {ended.code}: {last[:200]}"
        return None, ""
