"""The sun's disc on a chart: flux that is exact at any size of pixels."""

from __future__ import annotations

import numpy as np

from skybake.image.layers import Pixels
from skybake.image.scene import Scene
from skybake.projection.chart import Chart


class Splat:
    """Pixel values of the disc of a scene's sun: the rows that it touches, dense.

    Parameters
    ----------
    scene : Scene
        Whose sun it is.
    chart : Chart
        Where the pixels look.

    Attributes
    ----------
    peak : float
        Largest value of a pixel.
    """

    def __init__(self, scene: Scene, chart: Chart) -> None:
        width = chart.width
        self._first, self._pixels = 0, np.zeros((0, width, 3), np.float32)
        self.peak = 0.0
        if "sun" not in scene.layer_names:
            return
        cells = chart.disc_cells(scene.sun_zenith, scene.sun_bearing, scene.sun.angular_radius)
        if cells.distance.size == 0:
            return
        used = cells.texel[cells.weight > 0.0] // width
        self._first = int(used.min())
        rows = int(used.max()) + 1 - self._first
        flux = scene.disc_flux(cells)
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
