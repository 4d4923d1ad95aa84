"""Radiances by the path tracer, with clouds where a world has any."""

from __future__ import annotations

from skybake.cloud_fields.build import build_field
from skybake.optics.medium import Array
from skybake.optics.phase import build_phase
from skybake.preset import Planet
from skybake.reference import cloudy, stokes
from skybake.reference.estimate import radiance
from skybake.sky.sky import Sky


def traced_radiance(
    planet: Planet, sky: Sky, zenith: Array, azimuth: Array, samples: int, cloud_time: float
) -> tuple[Array, Array]:
    """Radiance per unit irradiance and its standard error.

    Of clear skies it is that of polarised light, with clouds as if light were not polarised.

    Parameters
    ----------
    planet : Planet
        The world.
    sky : Sky
        Its air, and where the sun and the observer are.
    zenith, azimuth : ndarray, shape (direction,)
        Zenith angle of the view, and its bearing less that of the sun. [rad]
    samples : int
        Paths for each direction and wavelength.
    cloud_time : float
        For which clouds have drifted and changed. [s]

    Returns
    -------
    mean, stderr : ndarray of float64, shape (direction, wavelength)
        [sr⁻¹]
    """
    if not planet.clouds:
        place = sky.medium, sky.altitude, sky.sun_elevation
        if not len(sky.medium.matrix):
            # Nothing scatters light, so that none is polarised.
            return radiance(*place, zenith, azimuth, samples=samples)
        mean, error = stokes.stokes(*place, zenith, azimuth, samples=samples)
        return mean[:, 0], error[:, 0]
    return cloudy.radiance(
        sky.medium,
        [build_field(layer, cloud_time) for layer in planet.clouds],
        [build_phase(layer.phase, sky.wavelengths) for layer in planet.clouds],
        sky.altitude,
        sky.sun_elevation,
        sky.sun_azimuth,
        zenith,
        sky.sun_azimuth + azimuth,
        samples=samples,
    )
