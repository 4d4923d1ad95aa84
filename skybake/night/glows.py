"""Lights of the night that stand at infinity and fill the sky."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from skybake.constants import ASTRONOMICAL_UNIT
from skybake.ephemeris.celestial import TO_ECLIPTIC, CelestialFrame
from skybake.night.channels import Channels
from skybake.night.milky_way import TO_GALAXY, starlight, starlight_spectrum
from skybake.night.zodiacal import FALL, REFERENCE, far_share, zodiacal_colours, zodiacal_light
from skybake.optics.medium import Array
from skybake.optics.spectrum import star_irradiance
from skybake.sky.sky import Sky

BESIDE_ECLIPTIC = math.sin(math.radians(4.0))
"""Sine of the greatest latitude of a sun, as seen from Earth and Mars, with which it can stand."""


class Glow(NamedTuple):
    """A light above the air.

    Attributes
    ----------
    spectra : ndarray of float64, shape (part, channel)
        Of its parts, as `Channels` hold them.
    brightness : callable
        Returns how much of each part, (part, ...), comes from unit vectors in the axes of maps,
        (..., 3); the product with its spectrum is a radiance [W m⁻² sr⁻¹ nm⁻¹].
    """

    spectra: Array
    brightness: Callable[[Array], Array]


def faint_stars(frame: CelestialFrame, channels: Channels) -> Glow:
    """Return the light of stars that are not drawn singly."""
    to_galaxy = TO_GALAXY @ frame.rotation.T

    def brightness(vectors: Array) -> Array:
        return starlight(vectors @ to_galaxy.T)[None]

    spectrum = starlight_spectrum(channels.wavelengths)
    return Glow(channels.hold(spectrum[None]), brightness)


def zodiacal_glow(frame: CelestialFrame, sky: Sky, channels: Channels) -> Glow:
    """Return the zodiacal light about the sun of a sky."""
    to_ecliptic = TO_ECLIPTIC @ frame.rotation.T
    sun = to_ecliptic @ sky.sun_direction
    distance = sky.star.distance / ASTRONOMICAL_UNIT
    # A sun that was put beside the ecliptic by hand is elsewhere than its light.
    is_there = abs(float(sun[2])) < BESIDE_ECLIPTIC

    def brightness(vectors: Array) -> Array:
        x, y, z = np.moveaxis(vectors @ to_ecliptic.T, -1, 0)
        longitude = np.arctan2(y, x) - math.atan2(sun[1], sun[0])
        latitude = np.arcsin(np.clip(z, -1.0, 1.0))
        light = zodiacal_light(longitude, latitude, has_corona=is_there) * distance ** (-FALL)
        share = far_share(longitude, latitude)
        return np.stack([light * (1.0 - share), light * share])

    wavelengths = channels.wavelengths
    sunlight = star_irradiance(sky.planet.star, wavelengths)
    sunlight = sunlight / np.interp(REFERENCE, wavelengths, sunlight)
    return Glow(channels.hold(zodiacal_colours(wavelengths) * sunlight), brightness)
