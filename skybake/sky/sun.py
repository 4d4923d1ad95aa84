"""The sun's disc: its size, its darkening toward the limb, and the air in front of it."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.optics.spectrum import limb_darkening
from skybake.scattering.transmittance import fill_sun_column
from skybake.sky.sky import Sky
from skybake.transport.geometry import distance_to_entry, radius_at

RINGS = 24
SPOKES = 96


class SunDisc:
    """The disc of a sky's sun, as seen by its observer.

    Parameters
    ----------
    sky : Sky
        The sky that the sun shines through.

    Attributes
    ----------
    angular_radius : float
        [rad]
    """

    def __init__(self, sky: Sky) -> None:
        self._sky = sky
        self._zenith = math.pi / 2.0 - sky.sun_elevation
        self.angular_radius = sky.planet.star.angular_radius
        self._darkening = limb_darkening(sky.planet.star, sky.wavelengths)

    def radiance_per_irradiance(self, zenith: Array, distance: Array) -> Array:
        """Radiance of points of the disc per unit irradiance above the air.

        Parameters
        ----------
        zenith : ndarray of float64, shape (n,)
            Zenith angles. [rad]
        distance : ndarray of float64, shape (n,)
            Angles from the disc's centre; beyond its edge the radiance is 0. [rad]

        Returns
        -------
        ndarray of float64, shape (n, wavelength)
            [sr⁻¹]
        """
        return self.bare_radiance(distance) * self.transmittance(zenith)

    def bare_radiance(self, distance: Array) -> Array:
        """Radiance without air in front of it; its integral over the disc is 1. [sr⁻¹]"""
        sine = np.sin(distance) / math.sin(self.angular_radius)
        mu = np.sqrt(np.maximum(1.0 - sine**2, 0.0))[:, None]
        u, v = self._darkening
        profile = 1.0 - u * (1.0 - mu) - v * (1.0 - mu * mu)
        mean = 1.0 - u / 3.0 - v / 2.0
        area = math.pi * math.sin(self.angular_radius) ** 2
        return np.where((sine < 1.0)[:, None], profile / (mean * area), 0.0)

    def transmittance(self, zenith: Array) -> Array:
        """Transmittance from the observer to space, 0 where the planet is in the way.

        Parameters
        ----------
        zenith : ndarray of float64, shape (n,)
            Zenith angles. [rad]

        Returns
        -------
        ndarray of float64, shape (n, wavelength)
        """
        sky = self._sky
        columns = np.empty((zenith.size, sky.medium.extinction.shape[0]))
        visible = np.empty(zenith.size, np.bool_)
        fill_sight_columns(
            sky.medium, sky.atmosphere.columns, sky.r, np.cos(zenith), columns, visible
        )
        transmittance: Array = np.exp(-columns @ sky.medium.extinction)
        return np.where(visible[:, None], transmittance, 0.0)

    def irradiance_per_irradiance(self) -> tuple[Array, Array]:
        """Direct irradiance per unit irradiance above the air.

        Returns
        -------
        normal, horizontal : ndarray of float64, shape (wavelength,)
            On a plane that faces the sun's centre and on a horizontal one, by
            quadrature over the part of the disc that is not behind the planet.
        """
        radius = (np.arange(RINGS) + 0.5) / RINGS * self.angular_radius
        spoke = 2.0 * math.pi * (np.arange(SPOKES) + 0.5) / SPOKES
        distance, spoke = (grid.ravel() for grid in np.meshgrid(radius, spoke, indexing="ij"))
        cosine = np.cos(distance) * math.cos(self._zenith) - np.sin(distance) * math.sin(
            self._zenith
        ) * np.cos(spoke)
        weight = np.sin(distance)[:, None] * self.bare_radiance(distance)
        weight /= weight.sum(axis=0)
        light = weight * self.transmittance(np.arccos(np.clip(cosine, -1.0, 1.0)))
        horizontal = (light * np.maximum(cosine, 0.0)[:, None]).sum(axis=0)
        return light.sum(axis=0), horizontal


@kernel
def fill_sight_columns(medium, columns, r, mu, out, visible):
    """Write the columns of rays to space, and whether no ground is in the way."""
    for i in range(mu.size):
        start, start_mu = r, mu[i]
        visible[i] = True
        out[i] = 0.0
        if r > medium.r_top:
            entry = distance_to_entry(r, mu[i], medium.r_top)
            if entry == math.inf:
                continue
            start = radius_at(r, mu[i], entry)
            start_mu = (r * mu[i] + entry) / start
            start = min(start, medium.r_top)
        visible[i] = fill_sun_column(
            columns, medium.r_bottom, medium.r_top, start, start_mu, out[i]
        )
