"""Pixels of a file, with where they look."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles
from skybake.projection.cells import Array
from skybake.projection.chart import Chart
from skybake.projection.of_file import file_canvas

FLIPS = {
    None: (slice(None), slice(None)),
    "rows": (slice(None, None, -1), slice(None)),
    "columns": (slice(None), slice(None, None, -1)),
    "both": (slice(None, None, -1), slice(None, None, -1)),
}


class Seen(NamedTuple):
    """A chart and its pixels.

    Attributes
    ----------
    chart : Chart
        Where pixels look.
    rgb : ndarray of float32, shape (row, column, 3)
        The right way round for the chart.
    """

    chart: Chart
    rgb: npt.NDArray[np.float32]

    def vectors(self) -> Array:
        """Return unit vectors of the pixels, shape (row, column, 3)."""
        zenith, bearing = self.chart.angles(0, self.chart.height)
        return direction_from_angles(bearing, math.pi / 2.0 - zenith)

    def sizes(self) -> Array:
        """Return solid angles of the pixels, shape (row, column). [sr]"""
        sizes = self.chart.solid_angles(0, self.chart.height)
        return np.broadcast_to(sizes, (self.chart.height, self.chart.width))


def seen_in(rgb: npt.NDArray[np.float32], attributes: Mapping[str, Any], name: str) -> list[Seen]:
    """Return the charts of a picture, none if it is not known where its pixels look.

    Parameters
    ----------
    rgb : ndarray of float32, shape (row, column, 3)
        The picture.
    attributes : mapping
        Of its file.
    name : str
        Of the file, without its suffix.
    """
    height, width = rgb.shape[:2]
    canvas = file_canvas(attributes, name, width, height)
    if canvas is None:
        return []
    found = []
    for part in canvas.parts:
        chart = part.chart
        rows = slice(part.row, part.row + chart.height)
        here = rgb[rows, part.column : part.column + chart.width]
        found.append(Seen(chart, here[FLIPS[part.flip]]))
    return found
