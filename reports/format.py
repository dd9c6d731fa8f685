"""Numbers as people read them."""

from __future__ import annotations

import math
import shlex
from collections.abc import Mapping

from oracles.verdict import Judged, Pixel
from reports import plain

UNITS = {"linear": "linear light", "code": "display code"}


def value(x: float) -> str:
    """A value of a pixel: nine significant digits tell any two float32 apart."""
    return f"{x:.9g}"


def triple(values: tuple[float, float, float]) -> str:
    """Red, green and blue."""
    return ", ".join(map(value, values))


def measure(x: float) -> str:
    """An error, a bound, a ratio: three significant digits."""
    return f"{x:.3g}"


def count(n: int) -> str:
    """A number of things, thousands set apart."""
    return f"{n:,}"


def points(x: float) -> str:
    """Points of a grade: as many digits as they have."""
    return f"{x:g}"


def times(x: float) -> str:
    """A multiple, to two digits: 0.5×, 12×, 770×."""
    return f"{float(f'{x:.2g}'):g}×"


def signed(x: float) -> str:
    """Points added or taken."""
    return f"{x:+g}"


def share(part: int, whole: int) -> str:
    """Part of whole in per cent; a dash where there is no whole."""
    return f"{100 * part / whole:.3g} %" if whole else "–"


def seconds(s: float) -> str:
    """A duration: milliseconds, seconds, or minutes and seconds."""
    if not math.isfinite(s):
        return measure(s)
    if s < 0.9995:
        return f"{1000 * s:.3g} ms"
    if s < 99.95:
        return f"{s:.3g} s"
    minutes, rest = divmod(round(s), 60)
    return f"{minutes} min {rest} s"


def excess(pixel: Pixel) -> str:
    """The pixel's distance from its truth, in tolerances."""
    if pixel.excess == math.inf and pixel.tolerance == 0:
        return "no tolerance: must be exact"
    return f"{measure(pixel.excess)} {'tolerance' if pixel.excess == 1 else 'tolerances'}"


def off(pixel: Pixel) -> str:
    """Got - expected, signed."""
    return f"{pixel.got - pixel.expected:+.3g}"


def unit(pixel: Pixel) -> str:
    """What the pixel's numbers count."""
    return UNITS[pixel.unit]


def doubtful(judged: Judged) -> str:
    """Share of pixels on which a decision cannot be made."""
    return share(judged.pixels - judged.decided, judged.pixels)


def kinds(doubtful: Mapping[str, int]) -> str:
    """Doubtful pixels by kind of decision, most frequent first."""
    most = sorted(doubtful.items(), key=lambda entry: (-entry[1], entry[0]))
    return ", ".join(f"{kind} {count(n)}" for kind, n in most) or "none"


def shell(arguments: tuple[str, ...]) -> str:
    """The arguments as one would type them."""
    return plain.command(shlex.join(arguments))


def slide(name: str) -> str:
    """The slide with its lecture: L11 unless it names its own."""
    return name if name.startswith("L11") else f"L11: {name}"
