"""Faults of writing the picture: every pixel was computed right."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from oracles.faults.fault import Fault
from oracles.images import Picture
from reference_tracer.formulas.display import lecture_codes, srgb_codes
from scenes.model import Scene

Reals = NDArray[Any]


def linear(pixels: Reals, roundoff: float = 2.0**-24) -> Picture:
    """A picture of floats."""
    return Picture(np.asarray(pixels, dtype=np.float64), roundoff=roundoff)


def _floats(change: Callable[[Reals], Reals]) -> Callable[[Reals, Scene], Picture]:
    return lambda pixels, scene: linear(change(pixels.astype(np.float64)))


def _bytes(change: Callable[[Reals], Reals]) -> Callable[[Reals, Scene], Picture]:
    return lambda pixels, scene: Picture(change(pixels.astype(np.float64)).astype(np.float64), 255)


def _encoded(pixels: Reals) -> Reals:
    c = np.clip(pixels, 0.0, 1.0)
    return np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1.0 / 2.4) - 0.055)


def _cut_above(pixels: Reals, scene: Scene) -> Reals:
    """Codes of which only those above 255 are cut: a negative one loses its fraction and wraps around."""
    if scene.display == "srgb":
        negative = 255.0 * 12.92 * pixels + 0.5
        return np.where(pixels < 0.0, np.mod(np.trunc(negative), 256.0), srgb_codes(pixels))
    return np.mod(np.trunc(np.minimum(255.0 * pixels, 255.0)), 256.0)


def _slanted(pixels: Reals) -> Reals:
    """Rows that begin one pixel later each, as with a padded row length."""
    return np.stack([np.roll(row, j, axis=0) for j, row in enumerate(pixels)])


def _without_last_row(pixels: Reals) -> Reals:
    return np.concatenate([pixels[:-1], np.zeros_like(pixels[-1:])])


def _by_columns(pixels: Reals) -> Reals:
    return np.ascontiguousarray(pixels.swapaxes(0, 1)).reshape(pixels.shape)


def _by_channels(pixels: Reals) -> Reals:
    return np.ascontiguousarray(np.moveaxis(pixels, -1, 0)).reshape(pixels.shape)


def _power_codes(pixels: Reals, scene: Scene) -> Picture:
    if scene.display == "lecture":
        return Picture(lecture_codes(pixels).astype(np.float64), 255)
    c = np.clip(pixels.astype(np.float64), 0.0, 1.0)
    return Picture(np.floor(255.0 * c ** (1.0 / 2.2) + 0.5), 255)


def _grey(pixels: Reals) -> Reals:
    return np.repeat(pixels @ np.array([[0.2126], [0.7152], [0.0722]]), 3, axis=-1)


def _fault(name: str, source: str, wrong: str, right: str, seen: str, mend: str, picture: Any) -> Fault:
    said = source if "," in source else f'L11 "{source}"'
    return Fault(name, "picture", said, wrong, right, seen, mend, picture=picture)


_BUFFER, _BAD = "Basic Buffering", "Ex) Bad and Good Case"
_RGB, _FILE, _BYTE = "write(r, g, b);", "write linear values to a float file;", "code = floor(255*clamp(c, 0, 1));"
_ROWS = "for (j = 0; j < h; j++) row(j);  // as the format has it"

FAULTS = (
    _fault(
        "blue-for-red",
        _BUFFER,
        "write(b, g, r);",
        _RGB,
        "red and blue are exchanged",
        "BGR2RGB: files hold R, G, B",
        _floats(lambda p: p[..., ::-1]),
    ),
    _fault(
        "upside-down",
        _BUFFER,
        "rows bottom first",
        _ROWS,
        "the picture is upside down",
        "PFM stores the bottom row first, the others the top row",
        _floats(lambda p: p[::-1]),
    ),
    _fault(
        "columns-backwards",
        _BUFFER,
        "pixel(w - 1 - i, j)",
        "pixel(i, j)",
        "left and right are exchanged",
        "the order of the columns",
        _floats(lambda p: p[:, ::-1]),
    ),
    _fault(
        "rows-padded",
        _BUFFER,
        "stride = w + 1;",
        "stride = w;",
        "the picture is slanted",
        "the length of a row in memory is not that in the file",
        _floats(_slanted),
    ),
    _fault(
        "column-by-column",
        _BUFFER,
        "data[i*h + j] = c;",
        "data[j*w + i] = c;",
        "stripes",
        "rows one after another, each of w pixels",
        _floats(_by_columns),
    ),
    _fault(
        "channel-by-channel",
        _BUFFER,
        "data[k*w*h + j*w + i] = c[k];",
        "data[(j*w + i)*3 + k] = c[k];",
        "three small grey pictures",
        "the three channels of a pixel stand together",
        _floats(_by_channels),
    ),
    _fault(
        "one-pixel-late",
        _BUFFER,
        "data[k + 1] = c;",
        "data[k] = c;",
        "everything is one pixel to the right",
        "count from 0",
        _floats(lambda p: np.roll(p.reshape(-1, 3), 1, axis=0).reshape(p.shape)),
    ),
    _fault(
        "last-row-left-out",
        _BUFFER,
        "for (j = 0; j < h - 1; j++)",
        "for (j = 0; j < h; j++)",
        "the last row is black",
        "h rows",
        _floats(_without_last_row),
    ),
    _fault(
        "one-channel-for-all", _BUFFER, "write(y, y, y);", _RGB, "the picture is grey", "three channels", _floats(_grey)
    ),
    _fault(
        "gamma-in-a-linear-file",
        _BAD,
        "write(pow(c, 1/2.2));",
        _FILE,
        "everything is too bright",
        "a float file holds linear values",
        _floats(lambda p: np.maximum(p, 0.0) ** (1.0 / 2.2)),
    ),
    _fault(
        "srgb-in-a-linear-file",
        _BAD,
        "write(srgb(c));",
        _FILE,
        "everything is too bright",
        "a float file holds linear values",
        _floats(_encoded),
    ),
    _fault(
        "clamped-in-a-linear-file",
        _BAD,
        "write(clamp(c, 0, 1));",
        _FILE,
        "what is brighter than 1 is cut",
        "clamp when a byte is made",
        _floats(lambda p: np.clip(p, 0.0, 1.0)),
    ),
    _fault(
        "tone-mapped",
        "Reinhard et al., Photographic Tone Reproduction for Digital Images, 2002",
        "write(c/(1 + c));",
        _FILE,
        "everything is too dark, bright things most",
        "a float file holds linear values",
        _floats(lambda p: p / (1.0 + np.maximum(p, 0.0))),
    ),
    _fault(
        "scaled-to-the-brightest",
        _BAD,
        "write(c/max);",
        _FILE,
        "pictures are darker or brighter as a whole",
        "1 is white, whatever else is in the picture",
        _floats(lambda p: p / np.maximum(p.max(), 1e-30)),
    ),
    _fault(
        "bytes-in-a-linear-file",
        _BAD,
        "write(floor(255*c)/255.0);",
        _FILE,
        "steps in smooth shading",
        "write the float",
        _floats(lambda p: np.floor(255.0 * p) / 255.0),
    ),
    _fault(
        "values-up-to-255",
        _BAD,
        "write(255*c);",
        _FILE,
        "everything is white",
        "1 is white in a float file",
        _floats(lambda p: 255.0 * p),
    ),
    _fault(
        "byte-wraps",
        _BAD,
        "code = (unsigned char)(255*c);",
        _BYTE,
        "bright spots turn dark, dark ones bright",
        "clamp both ways before the cast",
        _bytes(lambda p: np.mod(np.floor(255.0 * p), 256.0)),
    ),
    Fault(
        "byte-clamped-above-only",
        "picture",
        f'L11 "{_BAD}"',
        "code = (unsigned char)(int)min(255*c, 255);",
        _BYTE,
        "what is darker than black turns bright",
        "clamp both ways before the cast; and a cosine before it is used",
        picture=lambda pixels, scene: Picture(_cut_above(pixels.astype(np.float64), scene), 255),
        fate="equivalent",
        reason="Right formulas give no negative colour: it shows only beside another mistake, as cosine-not-clamped.",
    ),
    _fault(
        "byte-rounded",
        _BAD,
        "code = round(255*clamp(c, 0, 1));",
        _BYTE,
        "codes are one too high half of the time",
        "the lecture's cast cuts off",
        _bytes(lambda p: np.floor(255.0 * np.clip(p, 0.0, 1.0) + 0.5)),
    ),
    _fault(
        "byte-times-256",
        _BAD,
        "code = min(256*c, 255);",
        _BYTE,
        "codes are one too high in bright parts",
        "white is 255",
        _bytes(lambda p: np.minimum(np.floor(256.0 * np.clip(p, 0.0, 1.0)), 255.0)),
    ),
    _fault(
        "byte-never-srgb",
        _BAD,
        "code = floor(255*c);  // srgb asked for",
        "code = round(255*srgb(c));",
        "too dark where the scene asks for sRGB",
        "the scene's `display` says how to encode",
        lambda pixels, scene: Picture(lecture_codes(pixels).astype(np.float64), 255),
    ),
    _fault(
        "byte-gamma-for-srgb",
        _BAD,
        "code = round(255*pow(c, 1/2.2));  // srgb asked for",
        "code = round(255*srgb(c));",
        "dark parts are off by some codes where the scene asks for sRGB",
        "sRGB has a straight piece and the exponent 1/2.4",
        _power_codes,
    ),
    _fault(
        "byte-always-srgb",
        _BAD,
        "code = round(255*srgb(c));",
        _BYTE,
        "too bright in most scenes",
        "the scene's `display` says how to encode",
        lambda pixels, scene: Picture(srgb_codes(pixels).astype(np.float64), 255),
    ),
)
