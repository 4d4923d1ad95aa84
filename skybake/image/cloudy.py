"""Clouds in front of a clear sky's pixels."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from skybake.clouds.cloudscape import Cloudscape
from skybake.clouds.directions import unit_vectors
from skybake.clouds.rows import see_rows
from skybake.colour.space import ColourSpace, rgb_from_xyz
from skybake.optics.medium import Array

RESOLVED = 0.5
"""Share of a pixel below which the details of clouds are left out."""

ALIKE = 1.05
"""Ratio of the sizes of pixels that are not told apart."""

WHOLE = 1e-3
"""Share of a pixel on the other side of the horizon that is neglected."""


class CloudsOver:
    """Puts clouds into pixels.

    Parameters
    ----------
    cloudscape : Cloudscape
        The clouds; its channels are XYZ. [cd m⁻²]
    clear : callable
        The clear sky's pixels at zenith angles and azimuths, with their footprints.
    sun_azimuth : float
        Compass bearing from which azimuths count. [rad]
    space : ColourSpace
        Of the pixels.
    white_luminance : float
        Of pixels of 1. [cd m⁻²]
    """

    def __init__(
        self,
        cloudscape: Cloudscape,
        clear: Callable[[Array, Array, Array], np.ndarray],
        sun_azimuth: float,
        space: ColourSpace,
        white_luminance: float,
    ) -> None:
        self._cloudscape = cloudscape
        self._clear = clear
        self._sun_azimuth = sun_azimuth
        to_rgb = rgb_from_xyz(space) / white_luminance
        # In XYZ no light is negative, as ratios need.
        self._to_rgb = to_rgb.T.astype(np.float32)
        self._to_xyz = np.linalg.inv(to_rgb).T.astype(np.float32)

    def __call__(
        self, pixels: np.ndarray, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> np.ndarray:
        """Return pixels with clouds; parameters are those of `fill_directions` and its result."""
        return self.apart(pixels, zenith, azimuth, footprint)[0]

    def apart(
        self, pixels: np.ndarray, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return pixels with clouds, and the share of the clear sky that clouds hide in each.

        Parameters are those of `fill_directions` and its result; the share has the shape
        (row, column).
        """
        shape = pixels.shape[:2]
        if not pixels.size:
            return pixels, np.zeros(shape, np.float32)
        out, opacity = self._put(pixels, zenith, azimuth, footprint)
        places = (np.broadcast_to(each, shape) for each in (zenith, azimuth, footprint))
        angle, around, extent = (each.ravel() for each in places)
        above = (self._cloudscape.horizon - angle) / extent + 0.5
        is_both = (above > WHOLE) & (above < 1.0 - WHOLE)
        if is_both.any():
            out[is_both], opacity[is_both] = self._at_horizon(
                angle[is_both], around[is_both], extent[is_both]
            )
        return out.reshape(pixels.shape), opacity.reshape(shape)

    def _at_horizon(
        self, zenith: Array, azimuth: Array, footprint: Array
    ) -> tuple[np.ndarray, np.ndarray]:
        """Pixels that hold sky and ground: each part has its own clouds."""
        low, high = zenith - 0.5 * footprint, zenith + 0.5 * footprint
        horizon = self._cloudscape.horizon
        total: np.ndarray | float = 0.0
        hidden = np.zeros(zenith.size, np.float32)
        for begin, end in ((low, np.full_like(low, horizon)), (np.full_like(low, horizon), high)):
            middle, extent = 0.5 * (begin + end), end - begin
            clear = self._clear(middle[:, None], azimuth[:, None], extent[:, None])[:, 0]
            share = (extent / footprint).astype(np.float32)
            alone = (each[:, None] for each in (middle, azimuth, footprint))
            light, opacity = self._put(clear[:, None], *alone)
            total = total + share[:, None] * light
            hidden += share * opacity
        return np.asarray(total), hidden

    def _put(
        self, pixels: np.ndarray, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return pixels (pixel, 3) of rows (row, column, 3) with clouds, and what these hide."""
        xyz = pixels @ self._to_xyz
        looks = self._look(xyz, zenith, azimuth, footprint)
        light, opacity = self._cloudscape.put_into(xyz.reshape(-1, 3), *looks)
        return light @ self._to_rgb, opacity

    def _look(
        self, xyz: np.ndarray, zenith: Array, azimuth: Array, footprint: Array | float
    ) -> tuple[Array, Array, np.ndarray, np.ndarray]:
        """Return directions of pixels and what is seen of clouds there, for `put_into`."""
        clouds, shape = self._cloudscape, xyz.shape[:2]
        # Each pixel by its own size: which others are in its band must not matter.
        sizes = np.rint(np.log(footprint) / math.log(ALIKE)).astype(int)
        bearing = azimuth + self._sun_azimuth
        # Of maps whose rows have one zenith angle these are few.
        directions = np.broadcast_to(unit_vectors(zenith, bearing), (*shape, 3))
        flat = directions.reshape(-1, 3)
        angle, bearing, extent, classes = (
            np.ascontiguousarray(np.broadcast_to(each, shape)).ravel()
            for each in (zenith, bearing, np.asarray(footprint, float), sizes)
        )
        apart = np.unique(sizes).tolist()

        def see(pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            if len(apart) == 1:
                return clouds.see(flat[pixels], RESOLVED * ALIKE ** apart[0])
            return _see(clouds, flat[pixels], classes[pixels])

        given = directions, extent.reshape(shape), xyz
        seen, passing = see_rows(see, *given, clouds.alike, clouds.workers)
        return angle, bearing, seen, passing


def _see(
    clouds: Cloudscape, directions: Array, classes: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """See pixels whose sizes are powers of `ALIKE`."""
    seen = np.empty((len(clouds.layers), len(directions), 3), np.float32)
    passing = np.empty_like(seen)
    for each in np.unique(classes).tolist():
        at = np.flatnonzero(classes == each)
        seen[:, at], passing[:, at] = clouds.see(directions[at], RESOLVED * ALIKE**each)
    return seen, passing
