"""Light of sources that fill the sky, such as airglow, scattered in all orders."""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array
from skybake.scattering.aureole import no_aureole
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import build_grid, coarsen_grid
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


class ExtendedSky:
    """Lights that fill the sky, as an observer sees them through the air and scattered by it.

    Parameters
    ----------
    atmosphere : Atmosphere
        What scatters.
    radius : float
        Distance of the observer from the planet's centre. [km]

    Notes
    -----
    Each ring of a source is a sun, whose diffuse field is known; the unscattered source joins
    them, and rays gather what is scattered of the sum, see docs/night.md.
    """

    def __init__(self, atmosphere: Atmosphere, radius: float) -> None:
        self._radius = radius
        self._lit = atmosphere._replace(
            columns=atmosphere.columns * OPAQUE,
            aureole=no_aureole(atmosphere.scaled),
            horizon_peaks=no_horizon_peaks(atmosphere.scaled),
        )
        self._atmosphere = atmosphere
        self._wavelengths = atmosphere.medium.ground_albedo.size

    def scattered(self, mu: Array, source: Array, workers: Workers = ALL_CPUS) -> Array:
        """Radiance of what air and ground scatter of a source toward the observer.

        Parameters
        ----------
        mu : ndarray of float64, shape (ray,)
            Cosines of the zenith angles of rays.
        source : ndarray of float64, shape (STEPS,) or (STEPS, wavelength)
            Mean radiance of the source around the vertical, above the air, at even steps of
            zenith angle from 0 to pi/2; it is the same at every place of the planet.
        workers : Workers, optional
            Threads that do the work.

        Returns
        -------
        ndarray of float64, shape (ray, wavelength)
            What passes of the source itself, with `passing`, is to be added.
        """
        lit = self.lit_by(source)
        mu_s, nu = overhead(self._atmosphere.medium.r_bottom, self._radius, mu)
        start = np.full(mu.shape, self._radius)
        diffuse = trace_rays(lit, start, mu, mu_s, nu, workers=workers).diffuse
        return diffuse[:, : self._wavelengths].astype(np.float64)

    def lit_by(self, source: Array) -> Atmosphere:
        """Atmosphere whose diffuse light is that of a source, as of `scattered`, for every sun.

        Rays that begin with `overhead` gather what is scattered of it, from anywhere.
        """
        return self._lit._replace(field=self._field_of(source))

    def ground_radiance(self, source: Array) -> Array:
        """Radiance of the ground below a source, as of `scattered`, shape (wavelength,)."""
        albedo = self._atmosphere.medium.ground_albedo
        irradiance = self._field_of(source).ground[0, : self._wavelengths]
        radiance: Array = albedo * irradiance / math.pi
        return radiance

    def passing(self, mu: Array) -> Array:
        """Share of a wide source's light that comes straight, or by forward peaks alone.

        Returns
        -------
        ndarray of float64, shape (ray, wavelength)
            0 where the ground is in the way.
        """
        return transmittance_to_space(self._atmosphere, self._radius, mu)[:, : self._wavelengths]

    @cached_property
    def _straight(self) -> Straight:
        """What the unscattered source sends through each altitude of the field."""
        atmosphere, harmonics = self._atmosphere, self._atmosphere.field.harmonics
        bottom = atmosphere.medium.r_bottom
        grid, altitude = build_grid(atmosphere.scaled), atmosphere.field.altitude
        if not np.array_equal(altitude, grid.altitude):
            # A closure's field has nodes of its own.
            grid = coarsen_grid(grid._replace(altitude=altitude), bottom, harmonics.order)
        passing, moments = [], []
        for altitude, mu, weight in zip(grid.altitude, grid.mu, grid.weight, strict=True):
            radius = bottom + max(altitude, LOWEST_EYE)
            passing.append(transmittance_to_space(atmosphere, radius, mu))
            moments.append(harmonics_at(harmonics, mu) * (2.0 * math.pi * weight)[:, None])
        # Just below the horizontal the source is as at the horizon.
        zenith = np.arccos(np.clip(grid.mu, 0.0, 1.0))
        even = harmonics.azimuthal == 0
        downward = 2.0 * math.pi * grid.weight[0] * np.maximum(grid.mu[0], 0.0)
        return Straight(zenith, np.stack(passing), np.stack(moments)[..., even], downward)

    def _field_of(self, source: Array) -> DiffuseField:
        """Diffuse field of a source, the unscattered source included, the same for every sun."""
        field, straight = self._atmosphere.field, self._straight
        # Kernels take wavelengths in whole vectors, the last of which stand for none.
        count = field.ground.shape[1]
        spectral = np.broadcast_to(np.atleast_2d(source.T).T, (STEPS, self._wavelengths))
        spectral = np.pad(spectral, ((0, 0), (0, count - self._wavelengths)), mode="edge")
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        weights = _sun_shares(field.sun_angle, theta, spectral)
        plain = field.harmonics.degree.size
        even = np.zeros(field.radiance.shape[2], np.bool_)
        even[:plain] = field.harmonics.azimuthal == 0
        # Of the moments of polarised light the first is the even one.
        even[plain : plain + 1] = True
        radiance = np.zeros((len(field.altitude), *field.radiance.shape[2:]))
        radiance[:, even] = np.einsum("sk,aslk->alk", weights, field.radiance[:, :, even])
        seen = at_angles(theta, spectral, straight.zenith) * straight.passing
        radiance[:, :plain][:, even[:plain]] += np.einsum("aml,amk->alk", straight.moments, seen)
        ground = np.einsum("sk,sk->k", weights, field.ground) + straight.downward @ seen[0]
        suns = len(field.sun_angle)
        return field._replace(
            radiance=np.repeat(radiance[:, None].astype(np.float32), suns, axis=1),
            ground=np.repeat(ground[None], suns, axis=0),
        )


class Straight(NamedTuple):
    """Directions at the altitudes of a field, from which a source shines.

    Attributes
    ----------
    zenith : ndarray of float64, shape (altitude, direction)
        [rad]
    passing : ndarray of float64, shape (altitude, direction, wavelength)
        Transmittance from there to space.
    moments : ndarray of float64, shape (altitude, direction, degree)
        Harmonics that are even about the vertical, times solid angles. [sr]
    downward : ndarray of float64, shape (direction,)
        Solid angles times cosines at the ground. [sr]
    """

    zenith: Array
    passing: Array
    moments: Array
    downward: Array


def transmittance_to_space(atmosphere: Atmosphere, radius: float, mu: Array) -> Array:
    """Share of a wide source's light that arrives as of `ExtendedSky.passing`, (ray, wavelength).

    At a distance from the planet's centre [km], from the zenith angles with cosines `mu`.
    """
    medium = atmosphere.scaled.medium
    columns, visible = np.empty((mu.size, len(medium.extinction))), np.empty(mu.size, np.bool_)
    fill_sight_columns(medium, atmosphere.columns, radius, mu, columns, visible)
    passing: Array = np.exp(-columns @ medium.extinction)
    return np.where(visible[:, None], passing, 0.0)


def at_angles(theta: Array, source: Array, zenith: Array) -> Array:
    """Return a source at zenith angles [rad] of any shape, linear between even steps.

    `theta` are the steps, and `source` is of shape (STEPS, wavelength); beyond the last it is
    as there.
    """
    x = np.clip(zenith / (theta[1] - theta[0]), 0.0, STEPS - 1.0)
    below = np.minimum(x.astype(np.int64), STEPS - 2)
    share = (x - below)[..., None]
    light: Array = (1.0 - share) * source[below] + share * source[below + 1]
    return light


def _sun_shares(sun_angle: Array, theta: Array, source: Array) -> Array:
    """Irradiance, on planes that face it, of the ring of a source that each sun stands for.

    Parameters
    ----------
    sun_angle, theta : ndarray of float64, shapes (sun,) and (STEPS,)
        Zenith angles of the suns and of the source. [rad]
    source : ndarray of float64, shape (STEPS, wavelength)
        Its radiance.

    Returns
    -------
    ndarray of float64, shape (sun, wavelength)
    """
    ring = (2.0 * math.pi * np.sin(theta) * np.gradient(theta))[:, None] * source
    # Half a step at either end.
    ring[[0, -1]] *= 0.5
    below = np.clip(np.searchsorted(sun_angle, theta, side="right") - 1, 0, len(sun_angle) - 2)
    share = (theta - sun_angle[below]) / (sun_angle[below + 1] - sun_angle[below])
    hat = np.zeros((len(sun_angle), len(theta)))
    steps = np.arange(len(theta))
    hat[below, steps], hat[below + 1, steps] = 1.0 - share, share
    shares: Array = hat @ ring
    return shares


def overhead(r_bottom: float, radius: float, mu: Array) -> tuple[Array, Array]:
    """Cosines mu_s and nu of a sun that is high wherever a ray passes the air.

    Parameters
    ----------
    r_bottom, radius : float
        Distances of the ground and of the ray's start from the planet's centre. [km]
    mu : ndarray of float64, shape (ray,)
        Cosines of zenith angles.

    Notes
    -----
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
