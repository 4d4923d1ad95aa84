"""Clear air around clouds: its light at any point, and what passes through it."""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from skybake.jit.kept import Kept
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Array, Medium
from skybake.optics.phase import eval_phase
from skybake.scattering.atmosphere import atmosphere_key, dark_atmosphere, load_atmosphere
from skybake.scattering.closure import close_field
from skybake.scattering.ray import trace_rays
from skybake.scattering.segments import trace_segments
from skybake.scattering.tables import Atmosphere
from skybake.sky.disc import fill_sight_columns

GROUNDED = 1e-6
"""Least altitude of a place, so that it sees the sky above itself. [km]"""

DISC_POINTS = 9

KEPT = 2
"""Atmospheres over a bright ground that are kept in memory."""

BRIGHT = 0.8
"""Albedo of the ground from which, with the true one, the light over any ground is derived."""


class Light(NamedTuple):
    """Radiance per unit irradiance of the sun above the atmosphere. [sr⁻¹]

    Attributes
    ----------
    single : ndarray of float64, shape (..., wavelength)
        Sunlight that the air scattered once.
    diffuse : ndarray of float64, shape (..., wavelength)
        The rest, with the ground's.
    """

    single: Array
    diffuse: Array


class Spans(NamedTuple):
    """Light along rays up to several distances, and then all of it.

    Attributes
    ----------
    single, diffuse : ndarray of float64, shape (ray, distance + 1, wavelength)
        As of `Light`, gathered up to each distance and to the end. [sr⁻¹]
    transmittance : ndarray of float64, shape (ray, distance, wavelength)
        Of the light behind.
    """

    single: Array
    diffuse: Array
    transmittance: Array


class ClearAir:
    """The atmosphere between and around clouds.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its tables.
    sun_radius : float
        Half the angle of the sun's disc. [rad]
    workers : Workers, optional
        Threads that do the work.
    method : {"full", "scalar", "hillaire"}, optional
        By which the light over a bright ground is solved for.

    Notes
    -----
    Axes are x east, y north and z up at the observer's feet.
    """

    def __init__(
        self,
        atmosphere: Atmosphere,
        sun_radius: float,
        workers: Workers = ALL_CPUS,
        method: str = "full",
    ) -> None:
        self.method = method
        self.atmosphere = atmosphere
        self.sun_radius = sun_radius
        self.workers = workers
        self.radius = atmosphere.medium.r_bottom
        self.albedo = atmosphere.medium.ground_albedo

    @property
    def from_above(self) -> ClearAir:
        """The same air with the light alone that comes from above it."""
        return self

    def light_at(self, altitude: float, directions: Array, sun: Array) -> Light:
        """Light that arrives at a place above the feet, from unit vectors, shape (n, 3)."""
        mu, nu = directions[:, 2], directions @ sun
        return _trace(self.atmosphere, self._starts(altitude, mu, sun, nu), self.workers)

    def spans(self, altitude: float, directions: Array, distances: Array, sun: Array) -> Spans:
        """Light along rays from the observer up to distances, shape (ray, distance). [km]"""
        mu, nu = directions[:, 2], np.clip(directions @ sun, -1.0, 1.0)
        ends = np.concatenate([distances, np.full((len(distances), 1), np.inf)], axis=1)
        rays = self._starts(altitude, mu, sun, nu)
        light = trace_segments(self.atmosphere, *rays, ends, workers=self.workers)
        count = self.albedo.size
        phase = eval_phase(self.atmosphere.scaled.phase[..., :count], nu)[:, None]
        return Spans(
            (light.single[..., :count] * phase).sum(axis=2),
            light.diffuse[..., :count].astype(float),
            light.transmittance[:, :-1, :count],
        )

    def sunlight(self, altitudes: Array, mu_s: float) -> Array:
        """Transmittance from the sun's disc to altitudes, shape (altitude, wavelength)."""
        medium = self.atmosphere.medium
        share = (np.arange(DISC_POINTS) + 0.5) / DISC_POINTS * 2.0 - 1.0
        weight = np.sqrt(1.0 - share**2)
        zenith = np.arccos(np.clip(mu_s, -1.0, 1.0)) + self.sun_radius * share
        out = np.empty((altitudes.size, self.albedo.size))
        columns = np.empty((DISC_POINTS, medium.extinction.shape[0]))
        visible = np.empty(DISC_POINTS, np.bool_)
        for i, altitude in enumerate(altitudes.tolist()):
            place = self.radius + max(altitude, GROUNDED)
            fill_sight_columns(
                medium, self.atmosphere.columns, place, np.cos(zenith), columns, visible
            )
            through = np.exp(-columns @ medium.extinction) * visible[:, None]
            out[i] = weight @ through / weight.sum()
        return out

    def brightening(self, albedo: Array) -> Array:
        """Factor of the light of `over_bright` by which a ground of another albedo adds to the air.

        Parameters
        ----------
        albedo : ndarray of float64, shape (wavelength,)
            Of what takes the ground's place.

        Notes
        -----
        Light over a ground of albedo A is L0 + c A / (1 - s A), where s is what the air returns
        of light from below; two albedos tell s by the irradiance E0 / (1 - s A) of the ground.
        """
        down, more = self._irradiances
        returned = (more - down) / np.maximum(more * BRIGHT - down * self.albedo, 1e-300)

        def series(value: Array | float) -> Array:
            return np.asarray(value / (1.0 - returned * value), dtype=float)

        base = series(self.albedo)
        change: Array = (series(albedo) - base) / np.maximum(series(BRIGHT) - base, 1e-12)
        return np.where(BRIGHT - self.albedo > 1e-3, change, 0.0)

    @cached_property
    def _irradiances(self) -> tuple[Array, Array]:
        """Of the ground under one light, where it is as it is and where it is bright."""
        dark, bright = self._grounds
        sun = dark.field.sun_angle
        noon = int(np.argmin(np.abs(sun - math.pi / 3.0)))
        count = self.albedo.size
        beam = 0.5 * self.sunlight(np.zeros(1), 0.5)[0]
        down, more = (each.field.ground[noon, :count] + beam for each in (dark, bright))
        return down, more

    def over_bright(self, altitude: float, directions: Array, sun: Array) -> Array:
        """Light that a ground of albedo `BRIGHT` would add, shape (n, wavelength). [sr⁻¹]"""
        rays = self._starts(altitude, directions[:, 2], sun, directions @ sun)
        dark, bright = (_trace(each, rays, self.workers).diffuse for each in self._grounds)
        more: Array = bright - dark
        return more

    def over_bright_spans(
        self, altitude: float, directions: Array, distances: Array, sun: Array
    ) -> Array:
        """Return the same up to distances and to the end, shape (ray, distance + 1, wavelength)."""
        mu, nu = directions[:, 2], np.clip(directions @ sun, -1.0, 1.0)
        rays = self._starts(altitude, mu, sun, nu)
        ends = np.concatenate([distances, np.full((len(distances), 1), np.inf)], axis=1)
        count = self.albedo.size
        dark, bright = (
            trace_segments(each, *rays, ends, workers=self.workers).diffuse[..., :count]
            for each in self._grounds
        )
        more: Array = bright.astype(float) - dark
        return more

    @cached_property
    def _grounds(self) -> tuple[Atmosphere, Atmosphere]:
        """The air over its own ground and over a bright one."""
        medium = self.atmosphere.medium
        if self.method != "hillaire":
            # Hillaire's closure lets no light of the sky come back from the ground: at a low sun
            # two thirds of what a bright one adds.
            ground = np.full_like(medium.ground_albedo, BRIGHT)
            bright = medium._replace(ground_albedo=ground)
            return self.atmosphere, load_atmosphere(bright, self.method, self.workers)
        key = atmosphere_key(medium, "hillaire")
        return _recent.get(key, lambda: _close(medium, self.workers))

    def _starts(
        self, altitude: float, mu: Array, sun: Array, nu: Array
    ) -> tuple[Array, Array, Array, Array]:
        place = self.radius + max(altitude, GROUNDED)
        nu = np.clip(nu, -1.0, 1.0)
        return np.full(mu.shape, place), mu.copy(), np.full(mu.shape, sun[2]), nu


_recent: Kept[str, tuple[Atmosphere, Atmosphere]] = Kept(KEPT)


def _close(medium: Medium, workers: Workers) -> tuple[Atmosphere, Atmosphere]:
    """Build the air over its own ground and over a bright one, by Hillaire's closure.

    It is off by some percent by day, of a difference that is itself some percent of the light.
    """
    dark = dark_atmosphere(medium, "hillaire", workers)
    ground = np.full_like(dark.scaled.medium.ground_albedo, BRIGHT)
    scaled = dark.scaled._replace(medium=dark.scaled.medium._replace(ground_albedo=ground))
    bright = dark._replace(scaled=scaled)
    return (
        dark._replace(field=close_field(dark, workers)),
        bright._replace(field=close_field(bright, workers)),
    )


def _trace(
    atmosphere: Atmosphere, rays: tuple[Array, Array, Array, Array], workers: Workers
) -> Light:
    light = trace_rays(atmosphere, *rays, workers=workers)
    count = atmosphere.medium.ground_albedo.size
    phase = eval_phase(atmosphere.scaled.phase[..., :count], rays[3])
    return Light(
        (light.single[..., :count] * phase).sum(axis=1), light.diffuse[..., :count].astype(float)
    )
