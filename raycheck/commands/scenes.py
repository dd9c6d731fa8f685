"""raycheck scenes: the catalogue, or one scene in a notation."""

from __future__ import annotations

from argparse import Namespace

from raycheck.commands.options import scene_of
from raycheck.errors import CONFORMS
from scenes.catalogue import ladder
from scenes.json_form import to_json
from scenes.text import to_text


def run(options: Namespace) -> int:
    """Print to stdout."""
    if options.name is None:
        width = max(len(rung.name) for rung in ladder())
        for rung in ladder():
            print(f"{rung.name:<{width}}  {rung.teaches}  [L11: {rung.slide}]")
        return CONFORMS
    scene = scene_of(options.name)
    print(to_json(scene) if options.form == "json" else to_text(scene), end="")
    return CONFORMS
