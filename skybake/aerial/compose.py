"""The light of a picture with the air before it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import numpy.typing as npt

from skybake.aerial.air import Air, Depths
from skybake.image.layers import Pixels
from skybake.image.raster import Raster, sky_pixels
from skybake.image.scene import Scene
from skybake.projection.camera import Camera
from skybake.projection.chart import whole
from skybake.projection.gnomonic import GnomonicChart

BAND = 128


def through_air(
    beauty: Pixels,
    alpha: npt.NDArray[np.float32] | None,
    air: Air,
    depths: Depths,
    sky: Air | None,
    behind: Pixels | None,
) -> Pixels:
    """Return light with the air before it.

    Parameters
    ----------
    beauty : ndarray of float32, shape (row, column, 3)
        Light, multiplied by `alpha`.
    alpha : ndarray of float32, shape (row, column), or None
        Coverage, 1 if None.
    air : Air
        Up to finite distances.
    depths : Depths
        How far what is seen is.
    sky : Air or None
        Of all the air and the ground, without the sun's disc, for infinite depths.
    behind : ndarray of float32, shape (row, column, 3), or None
        What is behind where coverage is less than 1.

    Returns
    -------
    ndarray of float32, shape (row, column, 3)
        The very values of `beauty` where the distance is 0 and nothing is behind.
    """
    covered = np.float32(1.0) if alpha is None else alpha[..., None]
    out = beauty * air.passing + covered * air.light
    if sky is not None:
        is_far = np.isinf(depths.values)
        share = 1.0 if alpha is None else alpha[is_far, None]
        out[is_far] = beauty[is_far] * sky.passing[is_far] + share * sky.light[is_far]
    is_here = depths.values == 0.0
    out[is_here] = beauty[is_here]
    if behind is not None and alpha is not None:
        missing = np.clip(1.0 - alpha, 0.0, 1.0)[..., None]
        out = np.where(missing > 0.0, out + missing * behind, out)
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
    """

    def __init__(
        self,
        scene: Scene,
        camera: Camera,
        size: tuple[int, int],
        window: tuple[int, int, int, int],
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

    def whole_sky(self) -> Pixels:
        """Sky, ground and, if the scene has it, the sun's disc, shape (row, column, 3)."""
        return self._of_bands(self._raster.rows)

    def sky(self) -> Pixels:
        """Sky and ground, shape (row, column, 3)."""
        return self._of_bands(partial(sky_pixels, self._scene, self._chart))

    def passing(self) -> Pixels:
        """Share of light from space that passes the air, shape (row, column, 3)."""
        return self._of_bands(partial(self._raster.band, "transmittance"))

    def _of_bands(self, rows: Callable[[int, int], Pixels]) -> Pixels:
        height = self._chart.height
        bands = [rows(first, min(first + BAND, height)) for first in range(0, height, BAND)]
        return np.concatenate(bands)
