"""Light of sources that fill the sky, such as airglow, scattered in all orders."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.scattering.aureole import no_aureole
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import build_grid
from skybake.scattering.harmonics import harmonics_at
from skybake.scattering.horizon_peaks import no_horizon_peaks
from skybake.scattering.ray import trace_rays
from skybake.scattering.tables import Atmosphere
from skybake.sky.disc import fill_sight_columns
from skybake.sky.observer import LOWEST_EYE

STEPS = 721
"""Zenith angles at which a source is integrated, to a quarter of a degree."""

OPAQUE = 1e4
"""Factor of columns through which no sun shines."""


def scattered_light(
    atmosphere: Atmosphere,
    radius: float,
    mu: Array,
    source: Array,
    workers: Workers = ALL_CPUS,
) -> Array:
    """Radiance that reaches an observer of what air and ground scatter of an extended source.

    Parameters
    ----------
    atmosphere : Atmosphere
        What scatters.
    radius : float
        Distance of the observer from the planet's centre. [km]
    mu : ndarray of float64, shape (ray,)
        Cosines of the zenith angles of rays.
    source : ndarray of float64, shape (STEPS,)
        Mean radiance of the source around the vertical, above the air, at even steps of zenith
        angle from 0 to pi/2; it is the same at every place of the planet.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float64, shape (ray, wavelength)
        Per unit of the source's own spectrum. What passes of the source itself, with
        `truncated_transmittance`, is to be added.

    Notes
    -----
    Each ring of the source is a sun, whose diffuse field is known; the unscattered source joins
    them, and rays gather what is scattered of the sum, see docs/night.md.
    """
    lit = atmosphere._replace(
        field=_field_of(atmosphere, source),
        columns=atmosphere.columns * OPAQUE,
        aureole=no_aureole(atmosphere.scaled),
        horizon_peaks=no_horizon_peaks(atmosphere.scaled),
    )
    start = np.full(mu.shape, radius)
    mu_s, nu = _overhead(atmosphere.medium.r_bottom, radius, mu)
    count = atmosphere.medium.ground_albedo.size
    light = trace_rays(lit, start, mu, mu_s, nu, workers=workers).diffuse[:, :count]
    return light.astype(np.float64)


def truncated_transmittance(atmosphere: Atmosphere, radius: float, mu: Array) -> Array:
    """Share of a wide source's light that comes straight, or by forward peaks alone.

    Returns
    -------
    ndarray of float64, shape (ray, wavelength)
        0 where the ground is in the way.
    """
    count = atmosphere.medium.ground_albedo.size
    return _transmittance(atmosphere, radius, mu)[:, :count]


def _transmittance(atmosphere: Atmosphere, radius: float, mu: Array) -> Array:
    medium = atmosphere.scaled.medium
    columns, visible = np.empty((mu.size, len(medium.extinction))), np.empty(mu.size, np.bool_)
    fill_sight_columns(medium, atmosphere.columns, radius, mu, columns, visible)
    passing: Array = np.exp(-columns @ medium.extinction)
    return np.where(visible[:, None], passing, 0.0)


def _field_of(atmosphere: Atmosphere, source: Array) -> DiffuseField:
    """Diffuse field of a source, the unscattered source included, the same for every sun."""
    field, grid = atmosphere.field, build_grid(atmosphere.scaled)
    theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
    weights = _sun_shares(field.sun_angle, theta, source)
    plain = field.harmonics.degree.size
    even = np.zeros(field.radiance.shape[2], np.bool_)
    even[:plain] = field.harmonics.azimuthal == 0
    # Of the moments of polarised light the first is the even one.
    even[plain : plain + 1] = True
    radiance = np.zeros((len(field.altitude), *field.radiance.shape[2:]))
    radiance[:, even] = np.einsum("s,aslk->alk", weights, field.radiance[:, :, even])
    ground = weights @ field.ground
    bottom = atmosphere.medium.r_bottom
    for i, altitude in enumerate(field.altitude):
        mu, weight = grid.mu[i], 2.0 * math.pi * grid.weight[i]
        passing = _transmittance(atmosphere, bottom + max(altitude, LOWEST_EYE), mu)
        # Just below the horizontal the source is as at the horizon.
        seen = np.interp(np.arccos(np.clip(mu, 0.0, 1.0)), theta, source)[:, None] * passing
        moments = (harmonics_at(field.harmonics, mu) * weight[:, None]).T @ seen
        radiance[i, :plain][even[:plain]] += moments[even[:plain]]
        if i == 0:
            ground = ground + (weight * np.maximum(mu, 0.0)) @ seen
    suns = len(field.sun_angle)
    return field._replace(
        radiance=np.repeat(radiance[:, None].astype(np.float32), suns, axis=1),
        ground=np.repeat(ground[None], suns, axis=0),
    )


def _sun_shares(sun_angle: Array, theta: Array, source: Array) -> Array:
    """Irradiance, on planes that face it, of the ring of a source that each sun stands for."""
    ring = 2.0 * math.pi * np.sin(theta) * source * np.gradient(theta)
    # Half a step at either end.
    ring[[0, -1]] *= 0.5
    below = np.clip(np.searchsorted(sun_angle, theta, side="right") - 1, 0, len(sun_angle) - 2)
    share = (theta - sun_angle[below]) / (sun_angle[below + 1] - sun_angle[below])
    shares = np.zeros_like(sun_angle)
    np.add.at(shares, below, (1.0 - share) * ring)
    np.add.at(shares, below + 1, share * ring)
    return shares


def _overhead(r_bottom: float, radius: float, mu: Array) -> tuple[Array, Array]:
    """Cosines mu_s and nu of a sun that is high wherever a ray passes the air.

    All suns have the same field, but lookups between them are exact only by day. It is overhead
    where the ray hits the ground, or where it is closest to it.
    """
    closest = radius * radius * (1.0 - mu * mu)
    hits = (mu < 0.0) & (closest < r_bottom * r_bottom)
    length = -radius * mu - np.sqrt(np.maximum(r_bottom * r_bottom - closest, 0.0))
    passes = (mu < 0.0) & ~hits
    mu_s = np.where(
        hits, (radius + length * mu) / r_bottom, np.where(passes, np.sqrt(1 - mu**2), 1.0)
    )
    nu = np.where(hits, (radius * mu + length) / r_bottom, np.where(passes, 0.0, mu))
    return np.clip(mu_s, -1.0, 1.0), np.clip(nu, -1.0, 1.0)
