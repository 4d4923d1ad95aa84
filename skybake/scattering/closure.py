"""Hillaire's multiple scattering: isotropic, and closed at the point itself.

S. Hillaire, "A Scalable and Production Ready Sky and Atmosphere Rendering
Technique", Computer Graphics Forum 39(4), 2020, section 5.5.
"""

from __future__ import annotations

import math

import numpy as np

from skybake.angles import cosine_between
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import empty_field, sun_angles
from skybake.scattering.ray import trace_rays
from skybake.scattering.tables import Atmosphere
from skybake.transport.shells import altitude_shells

ALTITUDES = 16
POLAR = 8
AZIMUTHS = 8
SHELLS = 13
LAST_SUN_ANGLE = math.radians(120.0)


def close_field(atmosphere: Atmosphere, workers: Workers = ALL_CPUS) -> DiffuseField:
    """Build the table of Hillaire's method from 64 directions at each node.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns; Hillaire's method truncates no peaks.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    DiffuseField
        Of order 0. Good to some percent by day; in twilight a closure at the
        point itself loses the light that comes from far away.
    """
    scaled = atmosphere.scaled
    medium = scaled.medium
    nodes = altitude_shells(medium, ALTITUDES)
    field = empty_field(scaled, nodes, sun_angles(LAST_SUN_ANGLE), 0)
    coarse = atmosphere._replace(shells=altitude_shells(medium, SHELLS))
    black_ground = medium._replace(ground_albedo=np.zeros_like(medium.ground_albedo))
    dark = coarse._replace(field=field._replace(radiance=np.zeros_like(field.radiance)))
    one = coarse._replace(
        scaled=scaled._replace(medium=black_ground),
        field=field._replace(radiance=np.full_like(field.radiance, math.sqrt(4.0 * math.pi))),
    )
    mu_s = np.cos(field.sun_angle)
    for i, h in enumerate(field.altitude):
        # A ray that starts on the ground itself must still see the sky above it.
        r = medium.r_bottom + max(h, 1e-6)
        mu, share = _split_directions(-math.sqrt(1.0 - (medium.r_bottom / r) ** 2))
        second = np.tensordot(share, _mean_radiance(dark, r, mu, mu_s, workers), axes=1)
        same = np.full_like(mu, r), mu, np.ones_like(mu), mu
        # A field of 1 in all the atmosphere yields the share of light that scatters again.
        returned = share @ trace_rays(one, *same, workers=workers).diffuse
        transfer = second / (1.0 - np.minimum(returned, 0.999))
        field.radiance[i, :, 0] = math.sqrt(4.0 * math.pi) * transfer
    r = medium.r_bottom + 1e-6
    mu, share = _split_directions(0.0)
    upward = mu > 0.0
    flux = 4.0 * math.pi * share[upward] * mu[upward]
    closed = coarse._replace(field=field)
    radiance = _mean_radiance(closed, r, mu[upward], mu_s, workers)
    return field._replace(ground=np.tensordot(flux, radiance, axes=1))


def _split_directions(mu_horizon: float) -> tuple[Array, Array]:
    """Zenith cosines and shares of the sphere, apart above and below the horizon."""
    x, weight = np.polynomial.legendre.leggauss(POLAR // 2)
    x, weight = 0.5 * (x + 1.0), 0.5 * weight
    up, down = 1.0 - mu_horizon, 1.0 + mu_horizon
    mu = np.concatenate([mu_horizon + up * x**2, mu_horizon - down * x**2])
    return mu, np.concatenate([up * x * weight, down * x * weight])


def _mean_radiance(
    atmosphere: Atmosphere, r: float, mu: Array, mu_s: Array, workers: Workers
) -> Array:
    """Mean over azimuth with isotropic phase functions, shape (mu, mu_s, wavelength)."""
    azimuth = math.pi * (np.arange(AZIMUTHS) + 0.5) / AZIMUTHS
    mu, mu_s, azimuth = np.meshgrid(mu, mu_s, azimuth, indexing="ij")
    nu = cosine_between(mu, np.sqrt(1.0 - mu**2), mu_s, np.sqrt(1.0 - mu_s**2), azimuth)
    rays = np.full(mu.size, r), mu.ravel(), mu_s.ravel(), nu.ravel()
    light = trace_rays(atmosphere, *rays, workers=workers)
    radiance = light.single.sum(axis=1) / (4.0 * math.pi) + light.diffuse
    mean: Array = radiance.reshape(*mu.shape, -1).mean(axis=2)
    return mean
