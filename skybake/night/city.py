"""The glow of cities: light of lamps that the air scatters."""

from __future__ import annotations

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.night.channels import Channels
from skybake.optics.medium import Array
from skybake.scattering.atmosphere import load_atmosphere
from skybake.scattering.segments import trace_segments
from skybake.scattering.tables import Atmosphere
from skybake.sky.extended import STEPS, ExtendedSky, overhead
from skybake.sky.sky import Sky

LEAST_ALBEDO = 0.02
"""Of a ground that shows how the air answers to its light."""

USUAL_ALBEDO = 0.3
"""In place of darker grounds."""

CITY_RADIUS = 15.0
"""Of the lit ground around the observer, as that of a large city. [km]"""

_ENDS = np.geomspace(0.2, 400.0, 40)
"""Distances along a ray between which the share of the city in its light is the same. [km]"""

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
    """Radiance over that of the ground of a city, shape (direction, wavelength).

    Parameters
    ----------
    sky : Sky
        The observer in the middle of the city, and the air.
    zenith : ndarray of float64, shape (direction,)
        Zenith angles above the horizon. [rad]
    workers : Workers, optional
        Threads that do the work.

    Notes
    -----
    Under a sky that is alike all around, what a bright ground adds to a black one, over the
    radiance of that ground, is the response to one that glows everywhere. It does not depend on how
    bright the ground is. Of what the air adds along a ray that counts which the city would light,
    as a disc lights a level plane above it.
    """
    mu, uniform = np.cos(zenith), np.ones(STEPS)
    radius, bottom = sky.skylight.radius, sky.skylight.atmosphere.medium.r_bottom
    ends = np.broadcast_to(np.append(_ENDS, np.inf), (mu.size, _ENDS.size + 1))
    rays = np.full(mu.shape, radius), mu, *overhead(bottom, radius, mu)
    lit, black = (ExtendedSky(each, radius) for each in over_two_grounds(sky, workers))
    ground = lit.ground_radiance(uniform)
    bright, dark = (
        trace_segments(each.lit_by(uniform), *rays, ends, workers=workers).diffuse
        for each in (lit, black)
    )
    added = np.diff((bright - dark)[..., : ground.size].astype(float), axis=1, prepend=0.0)
    middle = np.sqrt(np.append(_ENDS[0], _ENDS) * np.append(_ENDS, _ENDS[-1]))
    middle = np.broadcast_to(middle, ends.shape)
    height = np.sqrt(radius**2 + middle**2 + 2.0 * radius * middle * mu[:, None]) - bottom
    share = lit_by_disc(middle * np.sin(zenith)[:, None], height)
    response: Array = (added * share[..., None]).sum(axis=1) / ground
    return response


def lit_by_disc(distance: Array, height: Array) -> Array:
    """Share of the light that a level plane has from a city, of that from an endless one.

    Parameters
    ----------
    distance, height : ndarray of float64
        Of the plane from the city's middle and above it. [km]
    """
    square = height**2 + distance**2
    root = np.sqrt((square + CITY_RADIUS**2) ** 2 - (2.0 * CITY_RADIUS * distance) ** 2)
    share: Array = 0.5 * (1.0 - (square - CITY_RADIUS**2) / root)
    return share


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
