"""The JSON form: parsing with clear errors, writing as people write it, and its schema."""

from __future__ import annotations

import json
from typing import Any

from pydantic import ValidationError

from scenes.errors import SceneError
from scenes.model import Scene


def from_json(text: str, origin: str = "scene") -> Scene:
    """Parse the JSON form; `origin` names the source in errors."""
    try:
        data = json.loads(text, object_pairs_hook=_unique_keys)
    except json.JSONDecodeError as error:
        place = f"{origin}: line {error.lineno} column {error.colno}"
        raise SceneError(f"not JSON: {error.msg}", place, hint="the JSON scene form") from None
    except RecursionError:
        raise SceneError("nested too deeply", origin, hint="the JSON scene form") from None
    except _DuplicateKeyError as error:
        raise SceneError("key given twice", origin, repr(str(error)), "each key once") from None
    except ValueError:  # Python refuses to convert integers of thousands of digits
        raise SceneError("an integer of too many digits", origin, hint="numbers in the range of float64") from None
    return from_data(data, origin)


def from_data(data: Any, origin: str = "scene") -> Scene:
    """Validate plain JSON data (dicts, lists, numbers, strings)."""
    try:
        return Scene.model_validate_json(json.dumps(data))
    except ValidationError as error:
        raise _explain(error, origin) from None


class _DuplicateKeyError(ValueError):
    pass


def _unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise _DuplicateKeyError(key)
        found[key] = value
    return found


_WORDS = {
    "extra_forbidden": "unknown key",
    "missing": "missing",
    "finite_number": "not a finite number",
    "greater_than": "too small",
    "greater_than_equal": "too small",
    "less_than_equal": "too large",
    "literal_error": "unknown word",
    "union_tag_invalid": "unknown word",
    "union_tag_not_found": "missing kind",
    "string_pattern_mismatch": "not a usable name",
    "too_long": "wrong number of entries",
    "too_short": "wrong number of entries",
}


def _explain(error: ValidationError, origin: str) -> SceneError:
    """The first problem as file: path: what (got value); expected ..."""
    problems = error.errors(include_url=False)
    # A misspelt key is both unknown and missing: the unknown one is what its author can see
    first = next((problem for problem in problems if problem["type"] == "extra_forbidden"), problems[0])
    kind = first["type"]
    path = _path(first["loc"]) or "scene"
    context = first.get("ctx") or {}
    got = "" if kind == "missing" else _short(first["input"])
    match kind:
        case "value_error":
            message, hint = "cannot be used", str(context.get("error", ""))
            if path == "scene" and ": " in hint:
                path, hint = hint.split(": ", 1)
                got = ""
        case "json_invalid":
            message, got, hint = f"not JSON: {context.get('error', '')}", "", "the JSON scene form"
        case "extra_forbidden":
            message, hint = "unknown key", "only the keys of the scene format, version 1"
        case "missing":
            message, hint = "missing key", "every key to be given"
        case "union_tag_invalid":
            message, hint = "unknown word", str(context.get("expected_tags", ""))
            got = repr(context.get("tag"))
        case "literal_error":
            message, hint = "unknown value", str(context.get("expected", ""))
        case _:
            message = _WORDS.get(kind, "wrong value")
            hint = first["msg"][:1].lower() + first["msg"][1:]
            hint = hint.removeprefix("input should be ")
    return SceneError(message, f"{origin}: {path}", got, hint)


def _path(loc: tuple[int | str, ...]) -> str:
    """Where in the file, without the shape or kind that pydantic puts after the number of an entry."""
    parts = [*loc[:2], *loc[3:]] if loc[:1] in (("objects",), ("lights",)) else loc
    return ".".join(str(part) for part in parts)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def to_json(scene: Scene) -> str:
    """The JSON form as people write it: one line an object, a light, a material."""
    data = json.loads(scene.model_dump_json(exclude_defaults=True))
    lines = []
    for key, value in data.items():
        if key == "materials":
            inner = ",\n".join(f"    {json.dumps(name)}: {json.dumps(m)}" for name, m in value.items())
            lines.append(f'  "materials": {{\n{inner}\n  }}')
        elif key in ("objects", "lights") and value:
            inner = ",\n".join("    " + json.dumps(entry) for entry in value)
            lines.append(f'  "{key}": [\n{inner}\n  ]')
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def schema() -> str:
    """The published JSON Schema of the scene format, as committed in scenes/schema/."""
    return json.dumps(Scene.model_json_schema(), indent=2) + "\n"
