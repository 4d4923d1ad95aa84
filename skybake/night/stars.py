"""The stars and planets that an observer sees through the air."""

from __future__ import annotations

import math

import numpy as np

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.ephemeris.celestial import CelestialFrame
from skybake.ephemeris.horizon import Horizon
from skybake.night.catalogue import FAINTEST, load_catalogue
from skybake.night.planets import planet_points
from skybake.night.star_light import star_irradiance
from skybake.optics.medium import Array
from skybake.sky.disc import Disc
from skybake.sky.sky import Sky

FARTHEST_BELOW = math.radians(2.0)
"""How far below the horizon what is seen can be: more than the 68 arcmin from space. [rad]"""

LIFT_NODES = 400
"""Elevations at which refraction is found, crowded toward the horizon."""


class Stars:
    """Where stars and planets are seen, and their light that arrives.

    Parameters
    ----------
    sky : Sky
        The observer and the air.
    frame : CelestialFrame
        How the stars stand.
    faintest : float, optional
        Magnitude V of the faintest ones, at most `FAINTEST`.
    is_refracted : bool, optional
        Whether the air of Earth raises them.

    Attributes
    ----------
    vectors : ndarray of float64, shape (n, 3)
        Unit vectors toward those that the planet does not hide: +Y up, -Z north, +X east.
    transmittance : ndarray of float64, shape (n, wavelength)
        Of the air on the way to them.
    irradiance : ndarray of float64, shape (n, wavelength)
        On a plane that faces each, below the air. [W m⁻² nm⁻¹]
    """

    def __init__(
        self,
        sky: Sky,
        frame: CelestialFrame,
        faintest: float = FAINTEST,
        *,
        is_refracted: bool = False,
    ) -> None:
        stars = load_catalogue().brighter_than(faintest)
        planets = planet_points(frame, sky.altitude, faintest)
        vectors = np.concatenate([frame.directions(stars.places, stars.motions), planets.vectors])
        v, b_v = np.concatenate([stars.v, planets.v]), np.concatenate([stars.b_v, planets.b_v])
        if is_refracted:
            vectors = _raised(vectors, Horizon(frame.planet, sky.altitude))
        zenith, _ = zenith_azimuth(vectors)
        passing = Disc(sky.skylight, sky.source).transmittance(zenith)
        is_seen = np.any(passing > 0.0, axis=1)
        self.vectors = vectors[is_seen]
        self._v, self._b_v = v[is_seen], b_v[is_seen]
        self.transmittance = passing[is_seen]
        self.irradiance = self.above_air(sky.wavelengths) * self.transmittance

    def above_air(self, wavelengths: Array) -> Array:
        """Irradiance above the air, as of `star_irradiance`."""
        return star_irradiance(self._v, self._b_v, wavelengths)


def _raised(vectors: Array, horizon: Horizon) -> Array:
    """Directions as refraction shows them, within 0.5 arcsec of `Horizon.lift`."""
    zenith, azimuth = zenith_azimuth(vectors)
    elevation = np.pi / 2.0 - zenith
    # Inverting the bending takes too long for each star. Lower ones are hidden.
    lowest = -horizon.dip - FARTHEST_BELOW
    nodes = lowest + (np.pi / 2.0 - lowest) * np.linspace(0.0, 1.0, LIFT_NODES) ** 3
    lifts = [horizon.lift(each) for each in nodes.tolist()]
    return direction_from_angles(azimuth, elevation + np.interp(elevation, nodes, lifts))
