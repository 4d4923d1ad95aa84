"""The light of a picture with the air before it."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

import numpy as np
import numpy.typing as npt

from skybake.aerial.air import Air
from skybake.aerial.depth import Depths
from skybake.image.layers import Pixels
from skybake.image.raster import CHANNELS, Raster, sky_pixels
from skybake.image.scene import Scene
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.projection.camera import Camera
from skybake.projection.chart import whole
from skybake.projection.gnomonic import GnomonicChart

BAND = 128
ROWS_AT_ONCE = 32


def through_air(
    beauty: Pixels,
    alpha: npt.NDArray[np.float32] | None,
    air: Air,
    depths: Depths,
    sky: Pixels | None,
    behind: Pixels | None,
    workers: Workers = ALL_CPUS,
) -> Pixels:
    """Return light with the air before it.

    Parameters
    ----------
    beauty : ndarray of float32, shape (row, column, 3)
        Light, multiplied by `alpha`.
    alpha : ndarray of float32, shape (row, column), or None
        Coverage, 1 if None.
    air : Air
        Light up to finite distances, and what passes up to all distances.
    depths : Depths
        How far what is seen is.
    sky : ndarray of float32, shape (row, column, 3), or None
        Light of all the air and the ground, without the sun's disc, for infinite depths.
    behind : ndarray of float32, shape (row, column, 3), or None
        What is behind where coverage is less than 1.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float32, shape (row, column, 3)
        The very values of `beauty` where the distance is 0 and nothing is behind.
    """
    out = np.empty_like(beauty)

    def work(first: int, last: int) -> None:
        rows = slice(first, last)
        light, passing = air.light[rows], air.passing[rows]
        depth = depths.values[rows]
        is_far = np.isinf(depth)
        if sky is not None and is_far.any():
            light = np.where(is_far[..., None], sky[rows], light)
        covered = np.float32(1.0) if alpha is None else alpha[rows, :, None]
        found = beauty[rows] * passing + covered * light
        is_here = depth == 0.0
        if is_here.any():
            found[is_here] = beauty[rows][is_here]
        if behind is not None and alpha is not None:
            missing = np.clip(1.0 - covered, 0.0, 1.0)
            if missing.any():
                found = np.where(missing > 0.0, found + missing * behind[rows], found)
        out[rows] = found

    workers.run_rows(len(beauty), work, chunk=ROWS_AT_ONCE)
    return out


class Behind:
    """What a camera sees behind all.

    Parameters
    ----------
    scene : Scene
        The sky.
    camera : Camera
        What sees it.
    size : tuple of int
        Width and height of the picture. [pixel]
    window : tuple of int
        Where the picture is in what the camera shows, as of `ExrPart`.
    rows : tuple of int, optional
        First row that is looked at, and the one after the last; others stay black.
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        size: tuple[int, int],
        window: tuple[int, int, int, int],
        rows: tuple[int, int] | None = None,
    ) -> None:
        column, row, full_width, full_height = window
        width, height = size
        # Of a pixel, on the plane before the camera.
        across = 2.0 * camera.half_width / full_width
        along = 2.0 * camera.half_height / full_height
        shift = (
            camera.shift[0] + across * (column + 0.5 * (width - full_width)),
            camera.shift[1] - along * (row + 0.5 * (height - full_height)),
        )
        half_width, half_height = 0.5 * across * width, 0.5 * along * height
        chart = GnomonicChart(camera.axes, half_width, half_height, width, height, shift=shift)
        self._scene, self._chart = scene, chart
        self._raster = Raster(scene, whole(chart))
        self._first, self._last = (0, height) if rows is None else rows

    def whole_sky(self) -> Pixels:
        """Sky, ground and, if the scene has it, the sun's disc, shape (row, column, 3)."""
        pixels = self.sky.copy()
        for name in self._scene.layer_names:
            if name != "sky":
                pixels += self._of_bands(partial(self._raster.band, name))
        if self._scene.settings.encoding.clamp_negative:
            np.maximum(pixels, 0.0, out=pixels)
        return pixels

    @cached_property
    def sky(self) -> Pixels:
        """Sky and ground, shape (row, column, 3)."""
        return self._of_bands(partial(sky_pixels, self._scene, self._chart))

    def hidden(self) -> Pixels:
        """Share of what is behind clouds that they hide, shape (row, column)."""
        bands = self._of_bands(partial(self._raster.band, "apart"), len(CHANNELS["apart"]))
        return bands[..., CHANNELS["apart"].index("A")]

    def _of_bands(self, rows: Callable[[int, int], Pixels], channels: int = 3) -> Pixels:
        pixels = np.zeros((self._chart.height, self._chart.width, channels), np.float32)
        for first in range(self._first, self._last, BAND):
            last = min(first + BAND, self._last)
            pixels[first:last] = rows(first, last)
        return pixels
