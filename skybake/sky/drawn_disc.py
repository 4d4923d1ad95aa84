"""A disc that is drawn in another size than its own, or softer."""

from __future__ import annotations

import math
from functools import cached_property

import numpy as np

from skybake.optics.medium import Array
from skybake.sky.disc import Disc
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source

SOFT_PEAK = 3.0
"""Radiance in the middle of a soft disc over its mean."""

RINGS = 96
SPOKES = 192


class DrawnDisc(Disc):
    """A disc of another size or profile, which shines as much as the true one.

    All of it that the planet does not hide has the colour that the true disc has in sum, so the
    irradiance at the observer is that of the true disc at any size, also near the horizon.

    Parameters
    ----------
    skylight, source : Skylight, Source
        As of `Disc`.
    angular_radius : float
        [rad]
    is_soft : bool, optional
        Fade from the middle to the edge as (1 - x²)² instead of limb darkening.
    """

    def __init__(
        self,
        skylight: Skylight,
        source: Source,
        *,
        angular_radius: float,
        is_soft: bool = False,
    ) -> None:
        super().__init__(skylight, source)
        self.angular_radius = angular_radius
        self._true = Disc(skylight, source)
        self._is_soft = is_soft

    def radiance_per_irradiance(
        self, zenith: Array, distance: Array, _azimuth: Array | None = None
    ) -> Array:
        """Radiance of points of the disc per unit irradiance above the atmosphere.

        Parameters are those of `Disc.radiance_per_irradiance`; an occluder dims all of the
        disc alike.
        """
        radiance: Array = self.bare_radiance(distance) * self._is_visible(zenith) * self._level
        return radiance

    def bare_radiance(self, distance: Array) -> Array:
        """Radiance with nothing in front; its integral over the disc is 1, nearly. [sr⁻¹]"""
        if not self._is_soft:
            return super().bare_radiance(distance)
        sine = np.sin(distance) / math.sin(self.angular_radius)
        area = math.pi * math.sin(self.angular_radius) ** 2
        profile = SOFT_PEAK / area * np.maximum(1.0 - sine**2, 0.0) ** 2
        return np.repeat(profile[:, None], self.source.irradiance.size, axis=1)

    def irradiance_per_irradiance(self) -> tuple[Array, Array]:
        """Direct irradiance per unit irradiance above the atmosphere, as of `Disc`."""
        share, height = self._visible
        return share * self._level, height * self._level

    @cached_property
    def _level(self) -> Array:
        """Factor of the bare radiance in what is visible, shape (wavelength,)."""
        normal, _ = self._true.irradiance_per_irradiance()
        share, _ = self._visible
        is_visible = share > 0.0
        return np.where(is_visible, normal / np.where(is_visible, share, 1.0), 0.0)

    @cached_property
    def _visible(self) -> tuple[Array, Array]:
        """Integrals of the bare radiance over what is visible, shape (wavelength,).

        The second is weighted by the cosine of the zenith angle.
        """
        ring = (np.arange(RINGS) + 0.5) / RINGS * self.angular_radius
        spoke = 2.0 * math.pi * (np.arange(SPOKES) + 0.5) / SPOKES
        distance, around = (grid.ravel() for grid in np.meshgrid(ring, spoke, indexing="ij"))
        # Spokes are counted from the one that points away from the zenith.
        mu, sine = math.cos(self.source.zenith), math.sin(self.source.zenith)
        cosine = np.cos(distance) * mu - np.sin(distance) * sine * np.cos(around)
        visible = self._is_visible(np.arccos(np.clip(cosine, -1.0, 1.0)))
        size = self.angular_radius / RINGS * 2.0 * math.pi / SPOKES * np.sin(distance)
        light = self.bare_radiance(distance) * visible * size[:, None]
        return light.sum(axis=0), np.maximum(cosine, 0.0) @ light

    def _is_visible(self, zenith: Array) -> Array:
        """Return 1 for points that the planet does not hide, else 0, shape (n, 1)."""
        return np.where(np.any(self.transmittance(zenith) > 0.0, axis=1, keepdims=True), 1.0, 0.0)
