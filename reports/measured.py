"""What the pages of measurements share: the environment, numbers, the page's own policy."""

from __future__ import annotations

import math
from functools import cache

from jinja2 import Environment

from reports import format, templating

_POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def number(x: float | None) -> str:
    """Two significant digits, powers of ten written out; a dash for none."""
    if x is None:
        return "–"
    if x == 0 or not math.isfinite(x):
        return f"{x:g}"
    if 1e-3 <= abs(x) < 1e5:
        return f"{float(f'{x:.2g}'):,g}"
    mantissa, exponent = f"{x:.1e}".split("e")
    power = f"10{str(int(exponent)).translate(_POWERS)}"
    return power if mantissa == "1.0" else f"{mantissa.removesuffix('.0')}·{power}"


def power_of_ten(x: float) -> str:
    """The nearest power of ten, as an exponent."""
    return f"10{str(round(math.log10(x))).translate(_POWERS)}"


def rate(x: float | None) -> str:
    """A share in per cent: none, under a tenth, or a number."""
    if x is None:
        return "–"
    if x == 0:
        return "0"
    if x < 0.001:
        return "< 0.1 %"
    return f"{100 * x:.0f} %" if x >= 0.0995 else f"{100 * x:.2g} %"


def duration(seconds: float) -> str:
    """A short time: nanoseconds to seconds."""
    for size, unit in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs")):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def page(template: str, **values: object) -> str:
    """A page of this look with these values."""
    return _environment().get_template(template).render(policy=_policy(), **values)


@cache
def _environment() -> Environment:
    filters = {"number": number, "rate": rate, "duration": duration, "measure": format.measure}
    return templating.templates(filters | {"seconds": format.seconds, "slide": format.slide})


@cache
def _policy() -> str:
    """Nothing but this page's own style and its empty icon: no script, no picture from elsewhere."""
    return templating.policy(_environment(), ("measured.css",))
