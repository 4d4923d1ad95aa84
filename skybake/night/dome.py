"""The sky of a night without a moon, as a table of directions."""

from __future__ import annotations

import math

import numpy as np

from skybake.ephemeris.celestial import CelestialFrame
from skybake.night.air import ABOVE, NightAir
from skybake.night.city import toward_city
from skybake.night.glows import Glow, faint_stars, zodiacal_glow
from skybake.optics.medium import Array
from skybake.sky.extended import STEPS
from skybake.sky.sky import Sky

MEAN_AIRGLOW = 0.8
"""Level of airglow at a solar flux of 130 sfu, the mean of a cycle, over that of the table, 180."""


class NightDome:
    """Light of airglow, zodiacal light, faint stars and cities, after the air has scattered it.

    Parameters
    ----------
    sky : Sky
        The observer, the air, and the sun about which the zodiacal light is.
    frame : CelestialFrame
        How the stars stand.
    air : NightAir, optional
        What the same observer's night had before.
    airglow, zodiacal : float
        Factors of airglow at a mean solar flux and of zodiacal light; 0 leaves them out.
    city : float
        Luminance by lamps in the zenith. [cd m⁻²]
    city_azimuth : float or None
        Compass bearing of the city, which is all around by default. [rad]

    Attributes
    ----------
    zenith_horizon : float
        Zenith angle of the true horizon. [rad]
    xyz : ndarray of float64, shape (row, bearing, 3)
        At `NightAir.vectors`. [cd m⁻²]
    air : NightAir
        Through which it is seen.
    rings : ndarray of float64, shape (STEPS, channel)
        Means around the vertical of the lights at infinity, above the air.
    airglow, city : float
        Of airglow over that of its table, and the luminance by lamps in the zenith. [cd m⁻²]
    """

    def __init__(
        self,
        sky: Sky,
        frame: CelestialFrame,
        air: NightAir | None = None,
        *,
        airglow: float = 1.0,
        zodiacal: float = 1.0,
        city: float = 0.0,
        city_azimuth: float | None = None,
    ) -> None:
        self._sky = sky
        self.air = air or NightAir(sky, has_airglow=airglow > 0.0, has_city=city > 0.0)
        self.zenith_horizon = self.air.zenith_horizon
        glows = [(faint_stars(frame, self.air.channels), 1.0)]
        if zodiacal > 0.0:
            glows.append((zodiacal_glow(frame, sky, self.air.channels), zodiacal))
        self.airglow, self.city = airglow * MEAN_AIRGLOW, city
        self.rings: Array = np.zeros((STEPS, sky.wavelengths.size))
        self.xyz = self._seen(glows)
        self.xyz += (self.airglow * self.air.airglow)[:, None]
        if city > 0.0:
            around = toward_city(self.air.vectors, city_azimuth)
            around[ABOVE:] = 1.0
            self.xyz += city * self.air.city[:, None] * around[..., None]

    @property
    def zenith_luminance(self) -> float:
        """Of the zenith. [cd m⁻²]"""
        return float(self.xyz[0, :, 1].mean())

    @property
    def illuminance(self) -> float:
        """Of a horizontal plane. [lx]"""
        zenith = self.air.zenith[:ABOVE]
        ring = self.xyz[:ABOVE, :, 1].mean(axis=1) * np.sin(zenith)
        return float(2.0 * math.pi * np.trapezoid(ring * np.maximum(np.cos(zenith), 0.0), zenith))

    def _seen(self, glows: list[tuple[Glow, float]]) -> Array:
        """XYZ of lights at infinity, each with its factor."""
        air = self.air
        xyz = np.zeros((*air.vectors.shape[:2], 3))
        for glow, factor in glows:
            parts = factor * glow.brightness(air.vectors)
            self.rings += air.rings(parts, glow.spectra)
            for light, spectrum in zip(parts, glow.spectra, strict=True):
                direct = (air.passing * spectrum) @ air.weights
                for channel in range(3):
                    xyz[..., channel] += light * direct[:, channel, None]
        around: Array = air.scattered(self.rings, self._sky.workers) @ air.weights
        return xyz + around[:, None]
