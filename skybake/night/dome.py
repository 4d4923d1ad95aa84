"""The sky of a night without a moon, as a table of directions."""

from __future__ import annotations

import math

import numpy as np

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import TO_ECLIPTIC, CelestialFrame
from skybake.night.air import ABOVE, NightAir
from skybake.night.milky_way import TO_GALAXY, starlight, starlight_spectrum
from skybake.night.zodiacal import FALL, REFERENCE, far_share, zodiacal_colours, zodiacal_light
from skybake.optics.medium import Array
from skybake.optics.spectrum import star_irradiance
from skybake.sky.extended import STEPS
from skybake.sky.sky import Sky

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
    air : NightAir, optional
        What the same observer's night had before.
    airglow, zodiacal, starlight : float
        Factors of airglow at a mean solar flux, of zodiacal light, and of the light of faint
        stars; 0 leaves them out.

    Attributes
    ----------
    zenith_horizon : float
        Zenith angle of the true horizon. [rad]
    xyz : ndarray of float64, shape (row, bearing, 3)
        At `NightAir.vectors`. [cd m⁻²]
    """

    def __init__(
        self,
        sky: Sky,
        frame: CelestialFrame,
        air: NightAir | None = None,
        *,
        airglow: float = 1.0,
        zodiacal: float = 1.0,
        starlight: float = 1.0,
    ) -> None:
        self._sky = sky
        self._air = air or NightAir(sky, has_airglow=airglow > 0.0)
        self.zenith_horizon = self._air.zenith_horizon
        lights = []
        if starlight > 0.0:
            lights.append(self._starlight(frame, starlight))
        if zodiacal > 0.0:
            lights += self._zodiacal(frame, zodiacal)
        self.xyz = self._seen(lights)
        self.xyz += (airglow * MEAN_AIRGLOW * self._air.airglow)[:, None]

    @property
    def zenith_luminance(self) -> float:
        """Of the zenith. [cd m⁻²]"""
        return float(self.xyz[0, :, 1].mean())

    @property
    def illuminance(self) -> float:
        """Of a horizontal plane. [lx]"""
        zenith = self._air.zenith[:ABOVE]
        ring = self.xyz[:ABOVE, :, 1].mean(axis=1) * np.sin(zenith)
        return float(2.0 * math.pi * np.trapezoid(ring * np.maximum(np.cos(zenith), 0.0), zenith))

    def _seen(self, lights: list[tuple[Array, Array]]) -> Array:
        """XYZ of sources at infinity, each a table (row, bearing) and a spectrum."""
        air = self._air
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        rings = np.zeros((STEPS, self._sky.wavelengths.size))
        xyz = np.zeros((*air.vectors.shape[:2], 3))
        for light, spectrum in lights:
            mean = np.interp(theta, air.zenith[:ABOVE], light[:ABOVE].mean(axis=1))
            rings += mean[:, None] * spectrum
            direct = (air.passing * spectrum) @ air.weights
            for channel in range(3):
                xyz[..., channel] += light * direct[:, channel, None]
        if lights:
            xyz += (air.scattered(rings, self._sky.workers) @ air.weights)[:, None]
        return xyz

    def _starlight(self, frame: CelestialFrame, factor: float) -> tuple[Array, Array]:
        to_galaxy = TO_GALAXY @ frame.rotation.T
        light = factor * starlight(self._air.vectors @ to_galaxy.T)
        return light, starlight_spectrum(self._sky.wavelengths)

    def _zodiacal(self, frame: CelestialFrame, factor: float) -> list[tuple[Array, Array]]:
        to_ecliptic = TO_ECLIPTIC @ frame.rotation.T
        x, y, z = np.moveaxis(self._air.vectors @ to_ecliptic.T, -1, 0)
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
        return [(light * (1.0 - share), near), (light * share, far)]
