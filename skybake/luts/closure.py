"""Builds Hillaire's multiple scattering: second order, then a geometric series."""

from __future__ import annotations

import math

import numpy as np

from skybake.luts.multiscatter import MultiScatter, mu_s_from_unit
from skybake.luts.ray import trace_rays
from skybake.optics.medium import Array, Medium
from skybake.transport.shells import altitude_shells

ALTITUDES = 16
SUN_ANGLES = 48
POLAR = 8
AZIMUTHS = 8
SHELLS = 13


def build_multiscatter(medium: Medium, columns: Array) -> MultiScatter:
    """Build the table of Hillaire's method from 64 directions at each node.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    columns : ndarray
        Its table of `build_columns`.

    Returns
    -------
    MultiScatter
        Good to some percent by day; in twilight a closure at the point itself
        loses the light that comes from far away.
    """
    shells = altitude_shells(medium, SHELLS)
    mu_s_min = -math.sin(min(math.pi / 2.0, 3.0 * math.acos(medium.r_bottom / medium.r_top)))
    mu_s = np.array([mu_s_from_unit(mu_s_min, x) for x in np.linspace(0.0, 1.0, SUN_ANGLES)])
    second = np.empty((ALTITUDES, SUN_ANGLES, medium.extinction.shape[1]))
    returned = np.empty((ALTITUDES, 1, medium.extinction.shape[1]))
    constant = _constant(mu_s_min, second.shape, 1.0)
    nothing = _constant(mu_s_min, second.shape, 0.0)
    albedo_free = medium._replace(ground_albedo=np.zeros_like(medium.ground_albedo))
    for i in range(ALTITUDES):
        h = (i / (ALTITUDES - 1)) ** 2 * (medium.r_top - medium.r_bottom)
        # A ray that starts on the ground itself must still see the sky above it.
        r = medium.r_bottom + max(h, 1e-6)
        mu, share = _split_directions(-math.sqrt(1.0 - (medium.r_bottom / r) ** 2))
        radiance = _mean_radiance(medium, shells, columns, nothing, r, mu, mu_s)
        second[i] = np.tensordot(share, radiance, axes=1)
        same = np.full_like(mu, r), mu, np.ones_like(mu), mu
        # A source of 1 in all the air yields the share of light that scatters again.
        returned[i] = share @ trace_rays(albedo_free, shells, columns, constant, *same).diffuse
    transfer = second / (1.0 - np.minimum(returned, 0.999))
    table = MultiScatter(mu_s_min, transfer, nothing.ground)
    r = medium.r_bottom + 1e-6
    mu, share = _split_directions(0.0)
    upward = mu > 0.0
    flux = 4.0 * math.pi * share[upward] * mu[upward]
    radiance = _mean_radiance(medium, shells, columns, table, r, mu[upward], mu_s)
    return table._replace(ground=np.tensordot(flux, radiance, axes=1))


def _constant(mu_s_min: float, shape: tuple[int, int, int], value: float) -> MultiScatter:
    return MultiScatter(mu_s_min, np.full(shape, value), np.zeros(shape[1:]))


def _split_directions(mu_horizon: float) -> tuple[Array, Array]:
    """Zenith cosines and shares of the sphere, apart above and below the horizon."""
    x, weight = np.polynomial.legendre.leggauss(POLAR // 2)
    x, weight = 0.5 * (x + 1.0), 0.5 * weight
    up, down = 1.0 - mu_horizon, 1.0 + mu_horizon
    mu = np.concatenate([mu_horizon + up * x**2, mu_horizon - down * x**2])
    return mu, np.concatenate([up * x * weight, down * x * weight])


def _mean_radiance(
    medium: Medium,
    shells: Array,
    columns: Array,
    multiple: MultiScatter,
    r: float,
    mu: Array,
    mu_s: Array,
) -> Array:
    """Mean over azimuth with isotropic phase functions, shape (mu, mu_s, wavelength)."""
    azimuth = math.pi * (np.arange(AZIMUTHS) + 0.5) / AZIMUTHS
    mu, mu_s, azimuth = np.meshgrid(mu, mu_s, azimuth, indexing="ij")
    nu = mu * mu_s + np.sqrt((1.0 - mu**2) * (1.0 - mu_s**2)) * np.cos(azimuth)
    rays = np.full(mu.size, r), mu.ravel(), mu_s.ravel(), nu.ravel()
    light = trace_rays(medium, shells, columns, multiple, *rays)
    radiance = light.single.sum(axis=1) / (4.0 * math.pi) + light.diffuse
    return radiance.reshape(*mu.shape, -1).mean(axis=2)
