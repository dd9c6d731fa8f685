"""Results read back from their files, of which nothing is believed before it is validated."""

from __future__ import annotations

from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from scenes.disk import read_bounded

MAX_BYTES = 64 * 2**20
Model = TypeVar("Model", bound=BaseModel)


class ResultsError(Exception):
    """A file of results that cannot be used; the message names the file, the place in it and what was expected."""


def stored(model: type[Model], path: Path, command: str, form: str) -> Model:
    """The file as this model.

    Raise ResultsError if there is none that a `command` wrote, or it is no `form`.
    """
    try:
        return model.model_validate_json(read_bounded(path, MAX_BYTES))
    except OSError as error:
        raise ResultsError(f"{path}: {error.strerror}; expected a folder written by `{command}`") from None
    except ValidationError as error:
        raise ResultsError(f"{path}: {_first(error)}; expected {form} of schema version 1") from None


def _first(error: ValidationError) -> str:
    """Where a file first breaks its schema, and how."""
    found = error.errors(include_url=False)[0]
    place = ".".join(str(part) for part in found["loc"]) or "the file"
    return f"{place}: {found['msg']}"
