"""The text form: one statement a line, for a reader of `cin >> word`.

The statements come in the fixed order of the format; lines that start with `#` are comments, of
which `# source ...` carries the scene's source so that JSON → text → JSON is the identity.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

from scenes.errors import SceneError
from scenes.json_form import from_data
from scenes.model import DirectionalLight, Material, Object, PointLight, Scene, Sphere

_SOURCE = "# source "
_HEADER = {
    # statement: number of words after it
    "image": 4,
    "eye": 3,
    "forward": 3,
    "right": 3,
    "up": 3,
    "background": 3,
    "depth": 1,
    "shadows": 1,
    "fresnel": 1,
    "display": 1,
}


def to_text(scene: Scene) -> str:
    """Write the text form; numbers in %.17g, so nothing is lost."""
    return "\n".join(_lines(scene)) + "\n"


def _numbers(*values: float) -> str:
    return " ".join(f"{value:.17g}" for value in values)


def _lines(scene: Scene) -> Iterator[str]:
    image, camera = scene.image, scene.camera
    yield f"raycheck {scene.raycheck} {scene.name}"
    yield _SOURCE + scene.source
    yield f"image {image.width} {image.height} {_numbers(*image.sample)}"
    for name in ("eye", "forward", "right", "up"):
        yield f"{name} {_numbers(*getattr(camera, name))}"
    yield f"background {_numbers(*scene.background)}"
    yield f"depth {scene.depth}"
    yield f"shadows {int(scene.shadows)}"
    yield f"fresnel {int(scene.fresnel)}"
    yield f"display {scene.display}"
    for name, material in scene.materials.items():
        yield f"material {name} {_material(material)}"
    yield from map(_object, scene.objects)
    yield from map(_light, scene.lights)
    yield "end"


def _material(m: Material) -> str:
    surface = _numbers(*m.ambient, *m.diffuse, *m.specular)
    return f"{surface} {m.shininess} {_numbers(*m.reflect, *m.transmit, m.index)}"


def _object(thing: Object) -> str:
    if isinstance(thing, Sphere):
        return f"sphere {_numbers(*thing.center, thing.radius)} {thing.material}"
    return f"plane {_numbers(*thing.normal, thing.offset)} {thing.material}"


def _light(light: PointLight | DirectionalLight) -> str:
    if isinstance(light, PointLight):
        return f"point {_numbers(*light.position, *light.color)} {light.attenuation}"
    return f"directional {_numbers(*light.toward, *light.color)}"


def from_text(text: str, origin: str = "scene") -> Scene:
    """Parse the text form; raise SceneError naming the line."""
    reader = _Reader(text, origin)
    data = reader.scene()
    try:
        return from_data(data, origin)
    except SceneError as error:
        raise reader.with_line(error) from None


class _Reader:
    """Statements in order; remembers the line of each entry for the error messages."""

    def __init__(self, text: str, origin: str) -> None:
        self.origin = origin
        self.source = ""
        self.lines: dict[str, int] = {}
        self.statements: list[tuple[int, list[str]]] = []
        for number, line in enumerate(text.replace("\r\n", "\n").split("\n"), start=1):
            if line.startswith(_SOURCE) and not self.source:
                self.source = line.removeprefix(_SOURCE)
            if line.strip() and not line.lstrip().startswith("#"):
                self.statements.append((number, line.split()))

    def fail(self, line: int, message: str, got: str, expected: str) -> SceneError:
        return SceneError(message, f"{self.origin}: line {line}", got, expected)

    def with_line(self, error: SceneError) -> SceneError:
        """The same error with the line of the statement it came from."""
        path = error.place.removeprefix(f"{self.origin}: ")
        parts = path.split(".")
        for length in range(len(parts), 0, -1):
            line = self.lines.get(".".join(parts[:length]))
            if line:
                return self.fail(line, f"{path}: {error.message}", error.got, error.hint)
        return error

    def scene(self) -> dict[str, Any]:
        data = self._head()
        count = 1 + len(_HEADER)
        data |= {"source": self.source, "materials": {}, "objects": [], "lights": []}
        for line, (word, *rest) in self.statements[count:]:
            if word == "end":
                self._nothing_after(line, rest)
                return data
            parse = _BODY.get(word)
            if parse is None:
                raise self.fail(line, "unknown statement", repr(word), ", ".join([*_BODY, "end"]))
            self._entry(data, line, parse, word, rest)
        last = self.statements[-1][0] if self.statements else 1
        raise self.fail(last, "file ends early", "no `end`", "a last line `end`")

    def _nothing_after(self, line: int, rest: list[str]) -> None:
        last, words = self.statements[-1]
        if rest or last != line:
            raise self.fail(last, "words after `end`", repr(" ".join(rest or words)[:60]), "`end` as the last word")

    def _head(self) -> dict[str, Any]:
        names = ["raycheck", *_HEADER]
        words: dict[str, list[str]] = {}
        for index, name in enumerate(names):
            if index >= len(self.statements):
                last = self.statements[-1][0] if self.statements else 1
                raise self.fail(last, "file ends early", "", f"statement `{name}`")
            line, (word, *rest) = self.statements[index]
            size = _HEADER.get(name, 2)
            if word != name or len(rest) != size:
                shown = " ".join([word, *rest])
                raise self.fail(line, "statement out of place", repr(shown[:60]), f"`{name}` with {size} word(s)")
            words[name] = rest
            self.lines[name] = self.lines[_PATHS.get(name, name)] = line
        width, height, *sample = words["image"]
        return {
            "raycheck": _number(words["raycheck"][0]),
            "name": words["raycheck"][1],
            "image": {"width": _number(width), "height": _number(height), "sample": [_number(w) for w in sample]},
            "camera": {name: [_number(w) for w in words[name]] for name in ("eye", "forward", "right", "up")},
            "background": [_number(w) for w in words["background"]],
            "depth": _number(words["depth"][0]),
            "shadows": _flag(words["shadows"][0]),
            "fresnel": _flag(words["fresnel"][0]),
            "display": words["display"][0],
        }

    def _entry(
        self, data: dict[str, Any], line: int, parse: Callable[[list[str]], dict[str, Any]], word: str, rest: list[str]
    ) -> None:
        size = _SIZES[word]
        if len(rest) != size:
            raise self.fail(line, f"`{word}` with {len(rest)} word(s)", repr(" ".join(rest)[:60]), f"{size} words")
        entry = parse(rest)
        if word == "material":
            name = rest[0]
            if name in data["materials"]:
                raise self.fail(line, "material defined twice", repr(name), "each name once")
            data["materials"][name] = entry
            self.lines[f"materials.{name}"] = line
            return
        key = "objects" if word in ("sphere", "plane") else "lights"
        if key == "objects" and entry["material"] not in data["materials"]:
            raise self.fail(line, "unknown material", repr(entry["material"]), "a material defined above")
        self.lines[f"{key}.{len(data[key])}"] = line
        data[key].append(entry)


_PATHS = {name: f"camera.{name}" for name in ("eye", "forward", "right", "up")} | {"raycheck": "name"}
_SIZES = {"material": 18, "sphere": 5, "plane": 5, "point": 7, "directional": 6}


_INTEGER = re.compile(r"0|-?[1-9][0-9]{0,18}")  # not -0, whose sign only a float keeps


def _number(word: str) -> Any:
    """The number a JSON file would hold; a word that is none stays a string and fails validation."""
    if _INTEGER.fullmatch(word):
        return int(word)
    try:
        return float(word) if word.isascii() and "_" not in word else word
    except ValueError:
        return word


def _flag(word: str) -> Any:
    return {"0": False, "1": True}.get(word, word)


def _vector(words: list[str]) -> list[Any]:
    return [_number(word) for word in words]


def _parse_material(w: list[str]) -> dict[str, Any]:
    return {
        "ambient": _vector(w[1:4]),
        "diffuse": _vector(w[4:7]),
        "specular": _vector(w[7:10]),
        "shininess": _number(w[10]),
        "reflect": _vector(w[11:14]),
        "transmit": _vector(w[14:17]),
        "index": _number(w[17]),
    }


_BODY: dict[str, Callable[[list[str]], dict[str, Any]]] = {
    "material": _parse_material,
    "sphere": lambda w: {"shape": "sphere", "center": _vector(w[:3]), "radius": _number(w[3]), "material": w[4]},
    "plane": lambda w: {"shape": "plane", "normal": _vector(w[:3]), "offset": _number(w[3]), "material": w[4]},
    "point": lambda w: {"kind": "point", "position": _vector(w[:3]), "color": _vector(w[3:6]), "attenuation": w[6]},
    "directional": lambda w: {"kind": "directional", "toward": _vector(w[:3]), "color": _vector(w[3:])},
}
