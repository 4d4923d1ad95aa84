"""Lights of the sky, each evaluated apart in given directions."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from skybake.angles import cosine_between, direction_from_angles
from skybake.image.luminous import luminous_weights
from skybake.image.moonlit import Moonlit
from skybake.image.night import Night
from skybake.night.air import NightAir, lines_xyz
from skybake.night.airglow import airglow_layers
from skybake.night.city import ground_response, lamp_channels, toward_city
from skybake.night.dome import MEAN_AIRGLOW
from skybake.night.glows import Glow, faint_stars, zodiacal_glow
from skybake.optics.medium import Array
from skybake.sky.extended import STEPS
from skybake.sky.sky import Sky


class Component(NamedTuple):
    """Light of one origin.

    Attributes
    ----------
    radiance : ndarray of float64, shape (direction, wavelength)
        [W m⁻² sr⁻¹ nm⁻¹]
    xyz : ndarray of float64, shape (direction, 3)
        [cd m⁻²]
    """

    radiance: Array
    xyz: Array


class Probed(NamedTuple):
    """What is looked at.

    Attributes
    ----------
    sky : Sky
        The observer, the air and the sun.
    night : Night
        Which lights of the night there are.
    air : NightAir or None
        How the air passes them; None without a night.
    moonlit : Moonlit or None
        The Moon as a light.
    zenith, azimuth : ndarray of float64, shape (direction,)
        Zenith angles and compass bearings. [rad]
    """

    sky: Sky
    night: Night
    air: NightAir | None
    moonlit: Moonlit | None
    zenith: Array
    azimuth: Array

    @property
    def vectors(self) -> Array:
        """Unit vectors in the axes of maps, shape (direction, 3)."""
        return direction_from_angles(self.azimuth, 0.5 * math.pi - self.zenith)


Evaluator = Callable[[Probed], Component | None]
"""Returns a component, or None where there is no such light."""


def sunlight(probed: Probed) -> Component | None:
    """Light of the sun that the air and the ground scatter: by night, twilight."""
    sky = probed.sky
    light = _scattered(sky, probed)
    return Component(light * sky.irradiance, light @ luminous_weights(sky))


def moonlight(probed: Probed) -> Component | None:
    """Light of the Moon that the air and the ground scatter."""
    moonlit = probed.moonlit
    if moonlit is None:
        return None
    light = _scattered(moonlit.sky, probed)
    return Component(light * moonlit.irradiance, light @ moonlit.air_weights)


def airglow(probed: Probed) -> Component | None:
    """Light of the upper air of Earth; radiances are means of its lines between wavelengths."""
    night, air, sky = probed.night, probed.air, probed.sky
    frame = night.frame
    if air is None or frame is None or frame.planet != "earth" or night.airglow == 0.0:
        return None
    mu, theta = np.cos(probed.zenith), np.linspace(0.0, 0.5 * math.pi, STEPS)
    factor, passing = MEAN_AIRGLOW * night.airglow, air.sources.passing(mu)
    radiance, xyz = np.zeros((mu.size, sky.wavelengths.size)), np.zeros((mu.size, 3))
    for layer in airglow_layers():
        seen = air.layer_directly(layer, probed.zenith, passing)
        seen += air.sources.scattered(mu, air.layer_from_ground(layer, theta), sky.workers)
        xyz += factor * lines_xyz(layer, air.channels, seen)
        per_nanometre = _spread(layer.wavelengths, layer.radiance, sky.wavelengths)
        radiance += factor * seen * per_nanometre
    return Component(radiance, xyz)


def zodiacal(probed: Probed) -> Component | None:
    """Sunlight that dust between the planets scatters."""
    night = probed.night
    if night.frame is None or probed.air is None or night.zodiacal == 0.0:
        return None
    glow = zodiacal_glow(night.frame, probed.sky, probed.air.channels)
    return _of_glow(probed, probed.air, glow, night.zodiacal)


def starlight(probed: Probed) -> Component | None:
    """Light of stars that are not drawn singly."""
    if probed.night.frame is None or probed.air is None:
        return None
    glow = faint_stars(probed.night.frame, probed.air.channels)
    return _of_glow(probed, probed.air, glow, 1.0)


def city(probed: Probed) -> Component | None:
    """Light of lamps that the air scatters; none below the horizon."""
    night, air, sky = probed.night, probed.air, probed.sky
    if air is None or night.city == 0.0:
        return None
    zenith = np.concatenate([[0.0], probed.zenith])
    glow = ground_response(sky, zenith, sky.workers)
    glow = glow * lamp_channels(air.channels)
    glow = glow / (glow[0] @ air.weights[:, 1])
    around = toward_city(probed.vectors, night.city_azimuth)
    around = np.where(probed.zenith <= air.zenith_horizon, around, 0.0)
    radiance = night.city * glow[1:] * around[:, None]
    return Component(radiance, radiance @ air.weights)


COMPONENTS: dict[str, Evaluator] = {
    "sun": sunlight,
    "moon": moonlight,
    "airglow": airglow,
    "zodiacal": zodiacal,
    "stars": starlight,
    "city": city,
}
"""Lights that a sky may have, by name."""


def _scattered(sky: Sky, probed: Probed) -> Array:
    """Radiance per unit irradiance of the source of a sky, (direction, wavelength). [sr⁻¹]"""
    source = sky.source
    mu, sine = np.cos(probed.zenith), np.sin(probed.zenith)
    relative = probed.azimuth - sky.sun_azimuth
    nu = cosine_between(mu, sine, source.mu, math.sin(source.zenith), relative)
    light: Array = np.maximum(sky.radiance_per_irradiance(mu, nu), 0.0)
    return light


def _of_glow(probed: Probed, air: NightAir, glow: Glow, factor: float) -> Component:
    mu = np.cos(probed.zenith)
    here = np.einsum("pd,pw->dw", glow.brightness(probed.vectors), glow.spectra)
    rings = air.rings(glow.brightness(air.vectors), glow.spectra)
    around = air.sources.scattered(mu, rings, probed.sky.workers)
    radiance = factor * (here * air.sources.passing(mu) + around)
    return Component(radiance, radiance @ air.weights)


def _spread(lines: Array, radiance: Array, wavelengths: Array) -> Array:
    """Radiance of lines per nanometre, shared between the wavelengths beside each."""
    sums = np.zeros_like(wavelengths)
    at = np.clip(np.searchsorted(wavelengths, lines, side="right") - 1, 0, len(wavelengths) - 2)
    share = (lines - wavelengths[at]) / (wavelengths[at + 1] - wavelengths[at])
    is_inside = (share >= 0.0) & (share <= 1.0)
    np.add.at(sums, at, np.where(is_inside, (1.0 - share) * radiance, 0.0))
    np.add.at(sums, at + 1, np.where(is_inside, share * radiance, 0.0))
    spread: Array = sums / np.gradient(wavelengths)
    return spread
