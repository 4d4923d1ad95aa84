"""Discs on a chart: flux that is exact at any size of pixels."""

from __future__ import annotations

import numpy as np

from skybake.image.discs import ShownDisc
from skybake.image.layers import Pixels
from skybake.projection.chart import Chart


class Splat:
    """Pixel values of a disc: the rows that it touches, dense.

    Parameters
    ----------
    disc : ShownDisc or None
        The disc, if there is one.
    chart : Chart
        Where the pixels look.

    Attributes
    ----------
    peak : float
        Largest value of a pixel.
    """

    def __init__(self, disc: ShownDisc | None, chart: Chart) -> None:
        width = chart.width
        self._first, self._pixels = 0, np.zeros((0, width, 3), np.float32)
        self.peak = 0.0
        if disc is None:
            return
        cells = chart.disc_cells(disc.zenith, disc.bearing, disc.angular_radius)
        if cells.distance.size == 0:
            return
        used = cells.texel[cells.weight > 0.0] // width
        self._first = int(used.min())
        rows = int(used.max()) + 1 - self._first
        flux = disc.flux(cells)
        pixels = np.zeros((rows * width, 3))
        for corner in range(cells.texel.shape[1]):
            weight = cells.weight[:, corner]
            lit = weight > 0.0
            texel = cells.texel[lit, corner] - self._first * width
            for channel in range(3):
                pixels[:, channel] += np.bincount(
                    texel, weight[lit] * flux[lit, channel], minlength=rows * width
                )
        self._pixels = pixels.reshape(rows, width, 3).astype(np.float32)
        self.peak = float(np.abs(pixels).max())

    def rows(self, first: int, last: int) -> tuple[int, Pixels]:
        """Return where in the rows first..last the disc begins, and its pixels in them."""
        begin = max(first, self._first)
        end = min(last, self._first + len(self._pixels))
        if begin >= end:
            return 0, self._pixels[:0]
        return begin - first, self._pixels[begin - self._first : end - self._first]
