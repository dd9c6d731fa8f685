"""raycheck scenes: the catalogue, or one scene in a notation."""

from __future__ import annotations

from argparse import Namespace

from oracles.peers.cannot import CannotSayError
from oracles.peers.mitsuba_xml import to_mitsuba
from oracles.peers.povray_scene import to_povray
from raycheck.commands.options import scene_of
from raycheck.errors import CONFORMS, UsageError
from scenes.catalogue import ladder
from scenes.json_form import to_json
from scenes.text import to_text

NOTATIONS = {"json": to_json, "text": to_text, "mitsuba": to_mitsuba, "povray": to_povray}


def run(options: Namespace) -> int:
    """Print to stdout."""
    if options.name is None:
        width = max(len(rung.name) for rung in ladder())
        for rung in ladder():
            print(f"{rung.name:<{width}}  {rung.teaches}  [L11: {rung.slide}]")
        return CONFORMS
    scene = scene_of(options.name)
    try:
        print(NOTATIONS[options.form](scene), end="")
    except CannotSayError as error:
        raise UsageError(f"{scene.name} --as {options.form}: it has no words for {error}", "docs/peers.md") from None
    return CONFORMS
