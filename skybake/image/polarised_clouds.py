"""Clouds in front of polarised light."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from skybake.clouds.sunlit import seen_share
from skybake.image.cloudy import CloudsOver
from skybake.image.scene import Scene
from skybake.optics.medium import Array


def stokes_behind_clouds(
    scene: Scene,
    clear_stokes: Callable[[Array, Array, Array | float], np.ndarray],
    zenith: Array,
    azimuth: Array,
    footprint: Array | float,
) -> np.ndarray:
    """S1 and S2 of the sky and the ground with clouds, see `skybake.image.polarised`.

    Parameters
    ----------
    scene : Scene
        With clouds.
    clear_stokes : callable
        Returns S1 and S2 without them, shape (row, column, 6).
    zenith, azimuth, footprint
        As of `Scene.evaluate`.
    """

    def clear(zenith: Array, azimuth: Array, footprint: Array | float) -> np.ndarray:
        light = scene.evaluate_clear(zenith, azimuth, footprint)
        return np.concatenate([light, clear_stokes(zenith, azimuth, footprint)], axis=2)

    cloudscape, encoding = scene.cloudscape, scene.settings.encoding
    pixels = clear(zenith, azimuth, footprint)
    if cloudscape is not None:
        sun_azimuth = scene.settings.lighting.sun_azimuth
        given = cloudscape, clear, sun_azimuth, encoding.space, encoding.white_luminance
        pixels = _PolarisedClouds(*given)(pixels, zenith, azimuth, footprint)
    return pixels[..., 3:]


class _PolarisedClouds(CloudsOver):
    """Puts clouds into pixels of the clear sky's light, S1 and S2, shape (row, column, 9).

    What clouds scatter is unpolarised. Of the air's light, S1 and S2 are to what it scatters once
    of the sunlight as in a clear sky: clouds hide what is behind them and shade what is between.
    """

    def _put(
        self, pixels: np.ndarray, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> tuple[np.ndarray, np.ndarray]:
        clouds, light = self._cloudscape, pixels[..., :3] @ self._to_xyz
        angle, bearing, _, passing = self._look(light, zenith, azimuth, footprint)
        flat = pixels.reshape(-1, 9).copy()
        _, through, distance = clouds.nodes
        row, weight = np.empty((len(flat), 4), np.int64), np.empty((len(flat), 4))
        clouds.find_places(angle, bearing, row, weight)
        nodes = clouds.sunlit_air, through, distance
        share = seen_share(nodes, (row, weight), passing)
        for part in (slice(3, 6), slice(6, 9)):
            flat[:, part] = (flat[:, part] @ self._to_xyz * share) @ self._to_rgb
        return flat, 1.0 - passing[..., 0].prod(axis=0)
