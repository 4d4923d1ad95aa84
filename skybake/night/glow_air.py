"""The air between and around clouds in the glow of a night."""

from __future__ import annotations

import math
from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np

from skybake.clouds.air import GROUNDED, ClearAir, Light, Spans
from skybake.night.air import lines_xyz
from skybake.night.airglow import Layer, airglow_layers, path_through
from skybake.night.city import over_two_grounds
from skybake.night.dome import NightDome
from skybake.optics.medium import Array
from skybake.scattering.ray import trace_rays
from skybake.scattering.segments import trace_segments
from skybake.scattering.tables import Atmosphere
from skybake.sky.extended import (
    STEPS,
    ExtendedSky,
    at_angles,
    overhead,
    transmittance_to_space,
)
from skybake.sky.sky import Sky

NODES = 24
"""Zenith angles at which the glow of lamps is summed to what falls on the ground."""


class _Scattered(NamedTuple):
    """A part of what air and ground scatter of the glow.

    Attributes
    ----------
    atmosphere : Atmosphere
        Whose diffuse light it is.
    weights : ndarray of float64, shape (wavelength, 3)
        By which that becomes XYZ. [cd m⁻²]
    """

    atmosphere: Atmosphere
    weights: Array


class _Above(NamedTuple):
    """A light above the air.

    Attributes
    ----------
    rings : ndarray of float64, shape (STEPS, wavelength)
        Its means around the vertical, as `ExtendedSky.scattered` takes them.
    weights : ndarray of float64, shape (wavelength, 3)
        By which these become XYZ. [cd m⁻²]
    layer : Layer or None
        Where the upper air emits it, unless it comes from infinity.
    """

    rings: Array
    weights: Array
    layer: Layer | None


class GlowAir(ClearAir):
    """Air that airglow, zodiacal light, faint stars and cities light from all around.

    Its channels are XYZ rather than wavelengths, its light is absolute, and there is no sun. As
    light that is scattered once counts that of lamps which goes up, of which clouds take nothing
    before it reaches them; the rest is diffuse. Light is alike in all bearings.

    Parameters
    ----------
    sky : Sky
        The air and the observer.
    dome : NightDome
        Its glow.

    Attributes
    ----------
    colours : ndarray of float64, shape (wavelength, 3)
        What each wavelength has of XYZ, relative to others.
    """

    def __init__(self, sky: Sky, dome: NightDome) -> None:
        own = sky.skylight.atmosphere
        super().__init__(own, sky.source.angular_radius, sky.workers, sky.table_method)
        self._lights = _lights_above(dome)
        self._natural = self._scattered_over(own)
        parts = [each.rings.mean(axis=0)[:, None] * each.weights for each in self._lights]
        self.colours: Array = np.sum(parts, axis=0)
        self._lamps: list[_Scattered] = []
        if dome.city > 0.0:
            lamps = dome.city * dome.air.lamps[:, None] * dome.air.weights
            self._lamps = _light_of_lamps(sky, lamps)
            self.colours = self.colours + lamps
        albedo = own.medium.ground_albedo
        reflected = _sum_on_ground(self._natural, albedo)
        self.albedo = reflected / _sum_on_ground(self._natural)
        # Of the ground's light under a city, what is not that of lamps.
        self._reflected = np.zeros(3)
        if self._lamps:
            node, weight = np.polynomial.legendre.leggauss(NODES)
            mu = 0.5 * (node + 1.0)
            glow = math.pi * (weight * mu) @ self._seen(self._lamps, self.radius + GROUNDED, mu)
            self._reflected = self.albedo * glow / (math.pi * lamps.sum(axis=0))

    @property
    def from_above(self) -> GlowAir:
        """The same air without lamps."""
        dark = copy(self)
        dark._lamps, dark._reflected = [], np.zeros(3)
        return dark

    def light_at(self, altitude: float, directions: Array, sun: Array) -> Light:
        """Light that arrives at a place above the feet, from unit vectors, shape (n, 3)."""
        mu, back = np.unique(directions[:, 2], return_inverse=True)
        radius = self.radius + max(altitude, GROUNDED)
        light = self._seen(self._natural, radius, mu) + sum(self._directly(radius, mu))
        lamps = self._seen(self._lamps, radius, mu)
        straight = np.where(mu[:, None] < 0.0, lamps * (1.0 - self._reflected), 0.0)
        return Light(straight[back], (light + lamps - straight)[back])

    def spans(self, altitude: float, directions: Array, distances: Array, sun: Array) -> Spans:
        """Light along rays from the observer up to distances, shape (ray, distance). [km]"""
        radius = self.radius + max(altitude, GROUNDED)
        rays, back = np.unique(
            np.column_stack([directions[:, 2], distances]), axis=0, return_inverse=True
        )
        mu = rays[:, 0].copy()
        light, transmittance = self._gathered(self._natural, radius, rays)
        before, behind = self._directly(radius, mu)
        light += before[:, None]
        light[:, -1] += behind
        lamps, _ = self._gathered(self._lamps, radius, rays)
        # Lamps on the ground are not seen, but what it reflects of their light.
        hits = (mu < 0.0) & (radius * np.sqrt(np.maximum(1.0 - mu * mu, 0.0)) < self.radius)
        lamps[hits, -1] -= (lamps[hits, -1] - lamps[hits, -2]) * (1.0 - self._reflected)
        diffuse = (light + lamps)[back]
        return Spans(np.zeros_like(diffuse), diffuse, transmittance[back])

    def sunlight(self, altitudes: Array, mu_s: float) -> Array:
        """Return that there is none, shape (altitude, 3)."""
        return np.zeros((altitudes.size, 3))

    def over_bright(self, altitude: float, directions: Array, sun: Array) -> Array:
        """Light that a ground of albedo `BRIGHT` would add, shape (n, 3)."""
        mu, back = np.unique(directions[:, 2], return_inverse=True)
        radius = self.radius + max(altitude, GROUNDED)
        more = self._seen(self._bright, radius, mu) - self._seen(self._natural, radius, mu)
        return more[back]

    def over_bright_spans(
        self, altitude: float, directions: Array, distances: Array, sun: Array
    ) -> Array:
        """Return the same up to distances and to the end, shape (ray, distance + 1, 3)."""
        radius = self.radius + max(altitude, GROUNDED)
        rays, back = np.unique(
            np.column_stack([directions[:, 2], distances]), axis=0, return_inverse=True
        )
        bright, own = (
            self._gathered(each, radius, rays)[0] for each in (self._bright, self._natural)
        )
        return (bright - own)[back]

    @cached_property
    def _bright(self) -> list[_Scattered]:
        return self._scattered_over(self._grounds[1])

    @cached_property
    def _irradiances(self) -> tuple[Array, Array]:
        return _sum_on_ground(self._natural), _sum_on_ground(self._bright)

    def _scattered_over(self, atmosphere: Atmosphere) -> list[_Scattered]:
        """Return what an atmosphere scatters of the lights above it."""
        sources = ExtendedSky(atmosphere, self.radius)
        return [_Scattered(sources.lit_by(each.rings), each.weights) for each in self._lights]

    def _seen(self, light: list[_Scattered], radius: float, mu: Array) -> Array:
        """XYZ of scattered light along whole rays, shape (ray, 3)."""
        total = np.zeros((mu.size, 3))
        start = np.full(mu.shape, radius), mu, *overhead(self.radius, radius, mu)
        for each in light:
            seen = trace_rays(each.atmosphere, *start, workers=self.workers).diffuse
            total += seen[:, : len(each.weights)] @ each.weights
        return total

    def _gathered(self, light: list[_Scattered], radius: float, rays: Array) -> tuple[Array, Array]:
        """XYZ of scattered light up to distances, and what passes from there.

        Rays are of shape (ray, 1 + distance), the cosine of the zenith angle first.
        """
        mu = rays[:, 0].copy()
        ends = np.concatenate([rays[:, 1:], np.full((len(rays), 1), np.inf)], axis=1)
        total = np.zeros((*ends.shape, 3))
        passing = np.ones((len(rays), ends.shape[1] - 1, 3))
        start = np.full(mu.shape, radius), mu, *overhead(self.radius, radius, mu)
        for each in light:
            count = len(each.weights)
            traced = trace_segments(each.atmosphere, *start, ends, workers=self.workers)
            total += traced.diffuse[..., :count] @ each.weights
            passing = traced.transmittance[:, :-1, :count] @ self.colours
            passing /= self.colours.sum(axis=0)
        return total, passing

    def _directly(self, radius: float, mu: Array) -> tuple[Array, Array]:
        """XYZ of what comes straight from before the air, and from behind it, shape (ray, 3)."""
        before, behind = np.zeros((2, mu.size, 3))
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        for light in self._lights:
            passing = transmittance_to_space(self.atmosphere, radius, mu)[:, : len(light.weights)]
            if light.layer is None:
                light_there = at_angles(theta, light.rings, np.arccos(mu))
                behind += (light_there * passing) @ light.weights
                continue
            near, far = path_through(light.layer, self.radius, radius, mu)
            before += near[:, None] * light.weights.sum(axis=0)
            behind += (far[:, None] * passing) @ light.weights
        return before, behind


def _lights_above(dome: NightDome) -> list[_Above]:
    air = dome.air
    lights = [_Above(dome.rings, air.weights, None)]
    if dome.airglow > 0.0:
        theta = np.linspace(0.0, 0.5 * math.pi, STEPS)
        count = dome.rings.shape[1]
        for layer in airglow_layers():
            path: Array = air.layer_from_ground(layer, theta)
            rings: Array = np.outer(path, np.ones(count))
            lines = lines_xyz(layer, air.channels, np.eye(count))
            lights.append(_Above(rings, dome.airglow * lines, layer))
    return lights


def _light_of_lamps(sky: Sky, lamps: Array) -> list[_Scattered]:
    """Return what is seen of a ground that glows everywhere with a radiance (wavelength, 3).

    As of `ground_response`.
    """
    uniform = np.ones(STEPS)
    lit, black = (
        ExtendedSky(each, sky.skylight.radius) for each in over_two_grounds(sky, sky.workers)
    )
    weights = lamps / lit.ground_radiance(uniform)[:, None]
    return [_Scattered(lit.lit_by(uniform), weights), _Scattered(black.lit_by(uniform), -weights)]


def _sum_on_ground(light: list[_Scattered], share: Array | float = 1.0) -> Array:
    """XYZ of a share of what falls on the ground, the unscattered source included, shape (3,)."""
    total = np.zeros(3)
    for each in light:
        irradiance = each.atmosphere.field.ground[0, : len(each.weights)]
        total += (share * irradiance) @ each.weights
    return total
