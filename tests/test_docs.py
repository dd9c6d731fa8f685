"""What the documents say, held to the code."""

from __future__ import annotations

import argparse
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from oracles.images import ENDINGS
from raycheck.cli import parser
from raycheck.commands.options import subject_of
from raycheck.manifest import FEATURES, Manifest
from reference_tracer.dialects import SCENE_MODEL
from scenes.catalogue import ladder

ROOT = Path(__file__).resolve().parents[1]
README = ROOT / "README.md"
GUIDES = [README, *sorted((ROOT / "docs").glob("*.md"))]
PAGES = [path for path in (*GUIDES, ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md") if path.exists() or path == README]


def name_of(path: Path) -> str:
    return str(path.relative_to(ROOT))


def code(path: Path) -> Iterator[str]:
    """Inline code and the lines of code blocks."""
    text = path.read_text("utf-8")
    for block in re.findall(r"^```[a-z]*\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        yield from block.splitlines()
    yield from re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL))


def commands() -> list[tuple[str, str]]:
    """(page, command) of every quoted call of raycheck, comments and pipes cut off."""
    found = []
    for path in GUIDES:
        if path.exists():
            for line in code(path):
                # `raycheck 1 NAME` is the first line of a scene or of a probe's answer
                call = re.sub(r"\s+#.*$|\s*[|&;>].*$", "", line.strip().removeprefix("$ "))
                if re.match(r"raycheck( (?!1 )|$)", call):
                    found.append((name_of(path), call))
    return found


def subcommands() -> dict[str, argparse.ArgumentParser]:
    (action,) = (a for a in parser()._actions if isinstance(a, argparse._SubParsersAction))
    return dict(action.choices)


def test_there_is_a_readme_with_commands() -> None:
    assert README.is_file()
    assert [call for page, call in commands() if page == "README.md"]


@pytest.mark.parametrize(("page", "call"), commands())
def test_every_quoted_command_is_understood(page: str, call: str) -> None:
    words = shlex.split(call)[1:]
    given = words[: words.index("--")] if "--" in words else words
    if not given or any("…" in word or word == "..." for word in given):
        pytest.skip("not a whole call")
    if len(given) == 1 and given[0] in subcommands():
        return  # the command's bare name, in running text
    assert understood(given), f"{page}: {call}"


def understood(words: list[str]) -> bool:
    """Does the parser take these words; --help and --version leave it with 0."""
    try:
        parser().parse_args(words)
    except SystemExit as end:
        return not end.code
    return True


def test_a_command_that_does_not_exist_is_not_understood() -> None:
    assert not understood(["fly"])
    assert not understood(["check", "--no-such-option"])
    assert understood(["--version"])


@pytest.mark.parametrize("command", sorted(subcommands()))
def test_every_command_is_documented(command: str) -> None:
    text = "\n".join(path.read_text("utf-8") for path in GUIDES)
    assert re.search(rf"raycheck {command}\b|make {command}\b", text)


@pytest.mark.parametrize("path", PAGES, ids=name_of)
def test_relative_links_lead_somewhere(path: Path) -> None:
    text = path.read_text("utf-8")
    links = [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if not re.match(r"[a-z]+:|#", link)]
    missing = [link for link in links if not (path.parent / link.split("#")[0]).exists()]
    assert missing == []


def default(command: str, option: str) -> object:
    for action in subcommands()[command]._actions:
        if option in action.option_strings:
            return action.default
    raise AssertionError(f"raycheck {command} has no {option}")


def test_the_folders_that_the_readme_names_are_the_defaults() -> None:
    text = README.read_text("utf-8")
    assert f"{default('check', '--out')}/index.html" in text
    assert f"{default('demo', '--out')}/" in text


def test_the_readmes_defaults_of_a_command_are_the_parsers() -> None:
    text = README.read_text("utf-8")
    options = parser().parse_args(["check"])
    options.tracer = ["./tracer", "{scene}", "{image}"]
    subject = subject_of(options)
    assert (subject.scene_form, subject.image_form, subject.precision) == ("text", "pfm", "float32")
    assert "a PFM" in text
    assert re.search(r"taken to compute in float32|computes? in float32", text)


def test_the_number_of_scenes_in_the_documents_is_that_of_the_catalogue() -> None:
    for path in GUIDES:
        for number in re.findall(r"\b(\d+) scenes\b", path.read_text("utf-8")):
            assert int(number) == len(ladder()), name_of(path)


def test_the_readmes_manifest_is_a_manifest() -> None:
    blocks = re.findall(r"^```toml\n(.*?)^```", README.read_text("utf-8"), re.MULTILINE | re.DOTALL)
    tables = [tomllib.loads(block) for block in blocks]
    manifests = [table["tracer"] for table in tables if "tracer" in table]
    assert manifests
    for table in manifests:
        Manifest.model_validate(table)


def test_the_table_of_manifest_keys_is_complete_and_its_defaults_are_right() -> None:
    text = (ROOT / "docs" / "attaching.md").read_text("utf-8").partition("## Dialects")[0]
    rows = dict(re.findall(r"^\| `(\w+)` \|.*\| ([^|]+) \|$", text, re.MULTILINE))
    assert set(rows) == set(Manifest.model_fields)
    for name, told in rows.items():
        field = Manifest.model_fields[name]
        if field.is_required():
            assert told == "needed"
        elif name == "dialect":
            assert (told, field.default.choices()) == ("the scene model's", SCENE_MODEL)
        elif name == "features":
            assert (told, set(FEATURES) - set(field.default)) == ("all but `fresnel`", {"fresnel"})
        elif field.default is None:
            assert told in ("none", "all")
        else:
            assert told.strip("`") == f"{field.default:g}" if isinstance(field.default, float) else str(field.default)


def test_features_and_endings_are_documented() -> None:
    text = (ROOT / "docs" / "attaching.md").read_text("utf-8")
    assert {word for word in FEATURES if f"`{word}`" not in text} == set()
    assert {ending for ending in ENDINGS if f"`{ending}`" not in text and f".{ending}" not in text} == set()


def test_every_exit_code_is_documented() -> None:
    text = README.read_text("utf-8")
    for code_ in ("0 conforms", "1 does not", "2 the call", "3 the tracer", "4 the suite", "130 interrupted"):
        assert code_ in text


def test_every_make_target_in_the_documents_exists() -> None:
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE))
    quoted = {call.split()[1] for path in PAGES for call in code(path) if re.match(r"make [a-z]+\b", call.strip())}
    assert quoted
    assert quoted <= targets
