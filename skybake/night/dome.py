"""The sky of a night without a moon, as a table of directions."""

from __future__ import annotations

import math

import numpy as np

from skybake.angles import direction_from_angles
from skybake.colour.observer import LUMINOUS_EFFICACY, load_observer, xyz_weights
from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import TO_ECLIPTIC, CelestialFrame
from skybake.night.airglow import Layer, airglow_layers, path_through
from skybake.night.milky_way import TO_GALAXY, starlight, starlight_spectrum
from skybake.night.zodiacal import FALL, REFERENCE, far_share, zodiacal_colours, zodiacal_light
from skybake.optics.medium import Array
from skybake.optics.spectrum import star_irradiance
from skybake.sky.extended import STEPS, scattered_light, truncated_transmittance
from skybake.sky.sky import Sky

ABOVE, BELOW = 256, 32
"""Rows of the table above the true horizon and below it, crowded toward it."""

BEARINGS = 720
"""Columns of the table."""

_EVERYWHERE = np.array([300.0, 900.0])


MEAN_AIRGLOW = 0.8
"""Level of airglow at a solar flux of 130 sfu, the mean of a cycle, over that of the table, 180."""


class NightDome:
    """Light of airglow, zodiacal light and faint stars, after the air has scattered it.

    Parameters
    ----------
    sky : Sky
        The observer, the air, and the sun about which the zodiacal light is.
    frame : CelestialFrame
        How the stars stand.
    airglow, zodiacal : float
        Factors of airglow at a mean solar flux and of zodiacal light; 0 leaves them out.

    Attributes
    ----------
    zenith_horizon : float
        Zenith angle of the true horizon. [rad]
    xyz : ndarray of float64, shape (ABOVE + BELOW, BEARINGS, 3)
        At `row_zeniths` and at even bearings from north, clockwise. [cd m⁻²]
    """

    def __init__(
        self, sky: Sky, frame: CelestialFrame, *, airglow: float = 1.0, zodiacal: float = 1.0
    ) -> None:
        self._sky, self._skylight = sky, sky.skylight
        medium = self._skylight.atmosphere.medium
        self._radius, self._bottom = self._skylight.radius, medium.r_bottom
        self.zenith_horizon = math.pi - math.asin(min(self._bottom / self._radius, 1.0))
        self._zenith = row_zeniths(self.zenith_horizon)
        self._mu = np.cos(self._zenith)
        self._passing = truncated_transmittance(self._skylight.atmosphere, self._radius, self._mu)
        flat = np.ones_like(_EVERYWHERE)
        self._weights = xyz_weights(sky.wavelengths, _EVERYWHERE, flat)
        bearing = 2.0 * math.pi * np.arange(BEARINGS) / BEARINGS
        elevation = 0.5 * math.pi - self._zenith
        self._vectors = direction_from_angles(bearing, elevation[:, None])
        self.xyz = np.zeros((ABOVE + BELOW, BEARINGS, 3))
        if airglow > 0.0:
            for layer in airglow_layers():
                self.xyz += airglow * MEAN_AIRGLOW * self._airglow(layer)[:, None]
        self._add_starlight(frame)
        if zodiacal > 0.0:
            self._add_zodiacal(frame, zodiacal)

    def _airglow(self, layer: Layer) -> Array:
        """XYZ of a layer's light, shape (row, 3)."""
        near, far = path_through(layer, self._bottom, self._radius, self._mu)
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        below = path_through(layer, self._bottom, self._bottom, np.cos(theta))[1]
        seen = near[:, None] + far[:, None] * self._passing + self._scattered(below)
        # Each line has its own colour, and of the air only what it does at its wavelength.
        nodes, bars = load_observer()
        colours = np.stack(
            [np.interp(layer.wavelengths, nodes, bar, left=0.0, right=0.0) for bar in bars.T],
            axis=1,
        )
        at_lines = np.stack(
            [np.interp(layer.wavelengths, self._sky.wavelengths, row) for row in seen]
        )
        xyz: Array = LUMINOUS_EFFICACY * (at_lines * layer.radiance) @ colours
        return xyz

    def _add_starlight(self, frame: CelestialFrame) -> None:
        to_galaxy = TO_GALAXY @ frame.rotation.T
        light = starlight(self._vectors @ to_galaxy.T)
        self._add(light, starlight_spectrum(self._sky.wavelengths))

    def _add_zodiacal(self, frame: CelestialFrame, factor: float) -> None:
        to_ecliptic = TO_ECLIPTIC @ frame.rotation.T
        x, y, z = np.moveaxis(self._vectors @ to_ecliptic.T, -1, 0)
        sun = to_ecliptic @ self._sky.sun_direction
        longitude = np.arctan2(y, x) - math.atan2(sun[1], sun[0])
        latitude = np.arcsin(np.clip(z, -1.0, 1.0))
        star = self._sky.planet.star
        distance = self._sky.star.distance / ASTRONOMICAL_UNIT
        light = factor * zodiacal_light(longitude, latitude) * distance ** (-FALL)
        wavelengths = self._sky.wavelengths
        sunlight = star_irradiance(star, wavelengths)
        sunlight = sunlight / np.interp(REFERENCE, wavelengths, sunlight)
        near, far = zodiacal_colours(wavelengths) * sunlight
        share = far_share(longitude, latitude)
        self._add(light * (1.0 - share), near)
        self._add(light * share, far)

    def _add(self, light: Array, spectrum: Array) -> None:
        """Add a source at infinity, shape (row, bearing), of one spectrum."""
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        rings = np.interp(theta, self._zenith[:ABOVE], light[:ABOVE].mean(axis=1))
        direct = (self._passing * spectrum) @ self._weights
        around = (self._scattered(rings) * spectrum) @ self._weights
        self.xyz += light[..., None] * direct[:, None] + around[:, None]

    def _scattered(self, rings: Array) -> Array:
        return scattered_light(
            self._skylight.atmosphere, self._radius, self._mu, rings, self._sky.workers
        )


def row_zeniths(zenith_horizon: float) -> Array:
    """Zenith angles of the rows of a dome: those above the horizon, then those below it. [rad]"""
    above = 1.0 - np.arange(ABOVE) / (ABOVE - 1.0)
    below = np.arange(BELOW) / (BELOW - 1.0)
    # On either side of the horizon itself, where a ray would graze the ground.
    gap = 1e-7
    first = zenith_horizon * (1.0 - above**2) - gap * (above == 0.0)
    second = zenith_horizon + (math.pi - zenith_horizon) * below**2 + gap * (below == 0.0)
    return np.concatenate([np.maximum(first, 0.0), np.minimum(second, math.pi)])
