"""Image files: read with bounds, as hostile input; written for people and tracers."""

from oracles.images.picture import ENDINGS, ImageError, Picture
from oracles.images.reading import read
from oracles.images.writing import write

__all__ = ["ENDINGS", "ImageError", "Picture", "read", "write"]
