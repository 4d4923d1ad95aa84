"""The glow of cities: light of lamps that the air scatters."""

from __future__ import annotations

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.night.channels import Channels
from skybake.optics.medium import Array
from skybake.scattering.atmosphere import load_atmosphere
from skybake.scattering.tables import Atmosphere
from skybake.sky.extended import STEPS, ExtendedSky
from skybake.sky.sky import Sky

LEAST_ALBEDO = 0.02
"""Of a ground that shows how the air answers to its light."""

USUAL_ALBEDO = 0.3
"""In place of darker grounds."""

ONE_SIDED = 0.9
"""How much brighter it is at the horizon toward a city than beside it, over the latter."""

# Middle [nm], full width at half maximum [nm] and height of bands, see docs/night.md.
_SODIUM = (
    (450.0, 30.0, 0.1),
    (498.0, 24.0, 0.12),
    (568.0, 24.0, 0.4),
    (590.0, 40.0, 1.0),
    (616.0, 28.0, 0.7),
    (670.0, 60.0, 0.15),
)
_LED = ((450.0, 24.0, 1.2), (545.0, 90.0, 0.45), (600.0, 120.0, 0.95))


def lamp_channels(channels: Channels) -> Array:
    """Spectral radiance of a ground that lamps light, of 1 cd/m2, shape (channel,).

    Half of its luminance is that of high-pressure sodium lamps and half of white LED of 4000 K, in
    bands as wide as wavelengths are apart, see docs/night.md.
    """
    wavelengths = channels.wavelengths
    luminous = channels.weights[:, 1]
    sodium, led = (channels.hold(_bands(wavelengths, each)) for each in (_SODIUM, _LED))
    lamps: Array = 0.5 * sodium / (sodium @ luminous) + 0.5 * led / (led @ luminous)
    return lamps


def ground_response(sky: Sky, zenith: Array, workers: Workers = ALL_CPUS) -> Array:
    """Radiance over that of a ground that glows everywhere, shape (direction, wavelength).

    Parameters
    ----------
    sky : Sky
        The observer and the air.
    zenith : ndarray of float64, shape (direction,)
        Zenith angles; below the horizon the ground itself is seen. [rad]
    workers : Workers, optional
        Threads that do the work.

    Notes
    -----
    Under a sky that is alike all around, what a bright ground adds to a black one, over the
    radiance of that ground. It does not depend on how bright the ground is.
    """
    mu, uniform = np.cos(zenith), np.ones(STEPS)
    radius = sky.skylight.radius
    lit, black = (ExtendedSky(each, radius) for each in over_two_grounds(sky, workers))
    seen = [each.scattered(mu, uniform, workers) for each in (lit, black)]
    response: Array = (seen[0] - seen[1]) / lit.ground_radiance(uniform)
    return response


def over_two_grounds(sky: Sky, workers: Workers = ALL_CPUS) -> tuple[Atmosphere, Atmosphere]:
    """Return the air of a sky over a ground that reflects, its own if it does, and a black one."""
    own = sky.skylight.atmosphere.medium
    lit = own
    if own.ground_albedo.min() < LEAST_ALBEDO:
        lit = own._replace(ground_albedo=np.full_like(own.ground_albedo, USUAL_ALBEDO))
    black = own._replace(ground_albedo=np.zeros_like(own.ground_albedo))
    method = sky.table_method
    return load_atmosphere(lit, method, workers), load_atmosphere(black, method, workers)


def toward_city(vectors: Array, azimuth: float | None) -> Array:
    """Factor of the glow in directions, 1 in the zenith, shape (...,).

    Parameters
    ----------
    vectors : ndarray of float64, shape (..., 3)
        Unit vectors in the axes of maps.
    azimuth : float or None
        Compass bearing of the city. [rad]
    """
    if azimuth is None:
        return np.ones(vectors.shape[:-1])
    toward = np.array([np.sin(azimuth), 0.0, -np.cos(azimuth)])
    factor: Array = 1.0 + ONE_SIDED * (vectors @ toward)
    return factor


def _bands(wavelengths: Array, bands: tuple[tuple[float, float, float], ...]) -> Array:
    total = np.zeros_like(wavelengths)
    for middle, width, height in bands:
        total += height * np.exp2(-((2.0 * (wavelengths - middle) / width) ** 2))
    return total
