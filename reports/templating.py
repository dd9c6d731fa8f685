"""What every page is made with: templates that escape all and miss nothing, and a policy that admits only their own."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Mapping
from hashlib import sha256

from jinja2 import Environment, PackageLoader, StrictUndefined


def templates(filters: Mapping[str, Callable[..., object]]) -> Environment:
    """An environment with these filters."""
    environment = Environment(
        loader=PackageLoader("reports"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=False,
    )
    environment.filters |= filters
    return environment


def policy(environment: Environment, styles: tuple[str, ...], script: str | None = None) -> str:
    """A page's Content-Security-Policy: its own styles and script by their hashes, embedded pictures, nothing else."""
    style = " ".join(_source(environment, name) for name in styles)
    own = f"style-src {style}" if script is None else f"style-src {style}; script-src {_source(environment, script)}"
    return f"default-src 'none'; img-src data:; {own}; base-uri 'none'; form-action 'none'"


def _source(environment: Environment, name: str) -> str:
    """The source expression for a file that the page includes as it stands."""
    body = environment.get_template(name).render()
    return f"'sha256-{b64encode(sha256(body.encode()).digest()).decode()}'"
