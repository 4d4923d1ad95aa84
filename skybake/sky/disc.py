"""The disc of a source: its size, its darkening toward the limb, and what is in front of it."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.scattering.transmittance import fill_sun_column
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source
from skybake.transport.geometry import distance_to_entry, radius_at

RINGS = 24
SPOKES = 96


class Disc:
    """The disc of a source, as seen by an observer.

    Parameters
    ----------
    skylight : Skylight
        The observer, and the atmosphere that the source shines through.
    source : Source
        The source.

    Attributes
    ----------
    source : Source
        As given.
    angular_radius : float
        [rad]
    """

    def __init__(self, skylight: Skylight, source: Source) -> None:
        self._skylight = skylight
        self.source = source
        self.angular_radius = source.angular_radius

    def radiance_per_irradiance(
        self, zenith: Array, distance: Array, azimuth: Array | None = None
    ) -> Array:
        """Radiance of points of the disc per unit irradiance above the atmosphere.

        Parameters
        ----------
        zenith : ndarray of float64, shape (n,)
            Zenith angles. [rad]
        distance : ndarray of float64, shape (n,)
            Angles from the disc's centre; beyond its edge the radiance is 0. [rad]
        azimuth : ndarray of float64, shape (n,), optional
            Compass bearings; only where the source has an occluder are they needed. [rad]

        Returns
        -------
        ndarray of float64, shape (n, wavelength)
            [sr⁻¹]

        Raises
        ------
        ValueError
            If the source has an occluder and no azimuths are given.
        """
        radiance: Array = self.bare_radiance(distance) * self.transmittance(zenith)
        occluder = self.source.occluder
        if occluder is None:
            return radiance
        if azimuth is None:
            raise ValueError("azimuth: must be given for a source with an occluder")
        return radiance * occluder.visible_share(azimuth, zenith)[:, None]

    def bare_radiance(self, distance: Array) -> Array:
        """Radiance with nothing in front; its integral over the disc is 1. [sr⁻¹]"""
        sine = np.sin(distance) / math.sin(self.angular_radius)
        mu = np.sqrt(np.maximum(1.0 - sine**2, 0.0))[:, None]
        u, v = self.source.limb_darkening
        profile = 1.0 - u * (1.0 - mu) - v * (1.0 - mu * mu)
        mean = 1.0 - u / 3.0 - v / 2.0
        area = math.pi * math.sin(self.angular_radius) ** 2
        return np.where((sine < 1.0)[:, None], profile / (mean * area), 0.0)

    def transmittance(self, zenith: Array) -> Array:
        """Transmittance from the observer to space, 0 where the planet blocks the ray.

        Parameters
        ----------
        zenith : ndarray of float64, shape (n,)
            Zenith angles. [rad]

        Returns
        -------
        ndarray of float64, shape (n, wavelength)
        """
        atmosphere, radius = self._skylight.atmosphere, self._skylight.radius
        medium = atmosphere.medium
        columns = np.empty((zenith.size, medium.extinction.shape[0]))
        visible = np.empty(zenith.size, np.bool_)
        fill_sight_columns(medium, atmosphere.columns, radius, np.cos(zenith), columns, visible)
        transmittance: Array = np.exp(-columns @ medium.extinction)
        return np.where(visible[:, None], transmittance, 0.0)

    def irradiance_per_irradiance(self) -> tuple[Array, Array]:
        """Direct irradiance per unit irradiance above the atmosphere.

        Returns
        -------
        normal, horizontal : ndarray of float64, shape (wavelength,)
            On a plane that faces the source's centre and on a horizontal one, by
            quadrature over the part of the disc that nothing hides.
        """
        radius = (np.arange(RINGS) + 0.5) / RINGS * self.angular_radius
        spoke = 2.0 * math.pi * (np.arange(SPOKES) + 0.5) / SPOKES
        distance, spoke = (grid.ravel() for grid in np.meshgrid(radius, spoke, indexing="ij"))
        # Spokes are counted from the one that points away from the zenith.
        mu, sine = math.cos(self.source.zenith), math.sin(self.source.zenith)
        cosine = np.cos(distance) * mu - np.sin(distance) * sine * np.cos(spoke)
        zenith = np.arccos(np.clip(cosine, -1.0, 1.0))
        weight = np.sin(distance)[:, None] * self.bare_radiance(distance)
        weight /= weight.sum(axis=0)
        light = weight * self.transmittance(zenith)
        occluder = self.source.occluder
        if occluder is not None:
            away = np.cos(distance) * sine + np.sin(distance) * mu * np.cos(spoke)
            beside = np.arctan2(np.sin(distance) * np.sin(spoke), away)
            share = occluder.visible_share(self.source.azimuth + beside, zenith)[:, None]
            passed = (weight * share).sum(axis=0)
            # Points are too few for the light of a thin crescent, but not for its colour.
            light *= share * occluder.uncovered / np.where(passed > 0.0, passed, 1.0)
        horizontal = (light * np.maximum(cosine, 0.0)[:, None]).sum(axis=0)
        return light.sum(axis=0), horizontal


@kernel
def fill_sight_columns(medium, columns, r, mu, out, visible):
    """Write the columns of rays to space, and whether they miss the ground."""
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
