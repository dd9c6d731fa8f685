"""A tracer to begin with: an example tracer with its formulas taken out.

What is taken out is marked in the example itself, so that nothing is written twice:

    // [open] what belongs here: what stands here meanwhile
    ... the formula ...
    // [close]
"""

from __future__ import annotations

import re
from pathlib import Path

from raycheck.errors import UsageError
from raycheck.examples import examples

LANGUAGES = {
    "cpp": "C++",
    "python": "Python",
    "rust": "Rust",
    "go": "Go",
    "java": "Java",
    "javascript": "JavaScript",
}
"""Languages by the word of the command line."""

_OPENED = re.compile(
    r"^(?P<indent>[ \t]*)(?P<mark>//|#) \[open\] (?P<what>[^:\n]+): (?P<meanwhile>[^\n]+)\n"
    r"(?:.*\n)*?[ \t]*(?://|#) \[close\]\n",
    re.MULTILINE,
)


def skeleton(language: str, folder: Path) -> list[Path]:
    """Write the skeleton's files into an empty or new folder; return their paths."""
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise UsageError(f"{folder} is there and not an empty folder", "a new folder, so that nothing is overwritten")
    source = examples() / f"{language}_lecture"
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for path in sorted(source.iterdir()):
        if path.suffix in (".toml", ".cpp", ".py", ".rs", ".go", ".java", ".js") or path.name == "Makefile":
            text = blanked(path.read_text("utf-8")).replace(f"{LANGUAGES[language]} from the lecture", "My tracer")
            written.append(folder / path.name)
            written[-1].write_text(text, "utf-8")
    return written


def blanked(text: str) -> str:
    """The text with each marked formula replaced by what stands there meanwhile."""
    return _OPENED.sub(_meanwhile, text)


def _meanwhile(found: re.Match[str]) -> str:
    indent, mark = found["indent"], found["mark"]
    return f"{indent}{mark} YOURS: {found['what']}\n{indent}{found['meanwhile']}\n"
