"""The light of one layer of clouds: from what enters it to what the eye's rays look up."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from skybake.clouds.air import ClearAir
from skybake.clouds.beam import LEAST_SLOPE, fill_beam
from skybake.clouds.diffuse import (
    Diffuse,
    Entering,
    Scattering,
    Voxels,
    merge_pairs,
    solve_diffuse,
)
from skybake.clouds.harmonics import degrees
from skybake.clouds.light import LayerLight
from skybake.clouds.particles import Particles
from skybake.clouds.quadrature import Quadrature, cell_samples, double_gauss
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

SKETCH = 2
"""How often voxels are merged by two for a first sight of what a layer reflects."""

SKETCH_LEAST = 8


@dataclass(frozen=True, eq=False)
class Grid:
    """Mean extinction of a layer on the voxels of its light.

    Attributes
    ----------
    extinction : ndarray of float32, shape (z, y, x)
        [km⁻¹]
    spacing : ndarray of float64, shape (3,)
        [km]
    base : float
        Altitude of the lowest face. [km]
    """

    extinction: Floats
    spacing: Array
    base: float

    @property
    def top(self) -> float:
        """Altitude of the highest face. [km]"""
        return self.base + self.extinction.shape[0] * float(self.spacing[0])

    @property
    def levels(self) -> Array:
        """Altitudes of the voxels' middles. [km]"""
        return self.base + (np.arange(self.extinction.shape[0]) + 0.5) * self.spacing[0]


@dataclass(frozen=True, eq=False)
class SolvedLayer:
    """A layer with its light.

    Attributes
    ----------
    light : LayerLight
        For the eye's rays.
    leaving : ndarray of float32, shape (sun, y, x)
        Share of the sun's beam that leaves the layer, without forward peaks.
    mean_radiance : ndarray of float64, shape (sun, z, channel)
        Of the diffuse light, over all directions and the tile, times 4 pi.
    down : ndarray of float64, shape (sun, channel)
        Diffuse irradiance of a horizontal plane at the base.
    down_clear, down_sun : ndarray of float64, shape (sun, channel)
        What the sky and the sun would bring there without clouds.
    reflectance : ndarray of float64, shape (channel,)
        Of layer and ground, seen from above, for the first sun.
    """

    light: LayerLight
    leaving: Floats
    mean_radiance: Array
    down: Array
    down_clear: Array
    down_sun: Array
    reflectance: Array


def solve_layer(
    grid: Grid,
    particles: Particles,
    air: ClearAir,
    weights: Array,
    suns: Array,
    workers: Workers,
) -> SolvedLayer:
    """Solve for the light of a layer under several heights of the sun.

    Parameters
    ----------
    grid : Grid
        The layer.
    particles : Particles
        How it scatters.
    air : ClearAir
        What surrounds it.
    weights : ndarray of float64, shape (wavelength, channel)
        By which radiance per unit irradiance becomes the light of a channel; all channels must be
        positive, as XYZ are.
    suns : ndarray of float64, shape (sun, 3)
        Unit vectors toward the sun, in the order of their z.
    workers : Workers
        Threads that do the work.
    """
    turn = math.atan2(suns[0, 1], suns[0, 0]) + math.pi / (2.0 * (particles.order + 1))
    quadrature = double_gauss(particles.order, turn)
    reflectance = _reflectance(grid, particles, air, weights, suns[-1], workers)
    harmonics, channels = (particles.order + 1) ** 2, weights.shape[1]
    shape = len(suns), *grid.extinction.shape, 1 + channels * harmonics
    volume = np.empty(shape, np.float32)
    leaving = np.empty((len(suns), *grid.extinction.shape[1:]), np.float32)
    irradiance = np.empty((len(suns), grid.extinction.shape[0], channels))
    mean = np.empty_like(irradiance)
    down, down_clear, down_sun = (np.empty((len(suns), channels)) for _ in range(3))
    for s, sun in enumerate(suns):
        voxels, leaving[s] = shine(grid, particles.fraction, sun)
        entering = enter(grid, quadrature, turn, air, weights, sun, reflectance)
        scattering = Scattering(particles.order, quadrature, particles.moments, sun)
        diffuse = solve_diffuse(voxels, scattering, entering, workers)
        fill_volume(voxels, diffuse, volume[s])
        irradiance[s] = entering.sun.T
        mean[s] = diffuse.moments[:, :, :, 0].mean(axis=(2, 3), dtype=float).T
        down[s], down_clear[s], down_sun[s] = diffuse.down, entering.down, entering.down_sun
    degree = degrees(particles.order)
    light = LayerLight(
        volume=volume,
        spacing=grid.spacing,
        base=grid.base,
        sun_mu=np.ascontiguousarray(suns[:, 2]),
        irradiance=irradiance,
        order=particles.order,
        fraction=particles.fraction,
        scatter=(2 * degree + 1) / (4.0 * math.pi) * particles.moments[degree],
        truncated=particles.truncated,
        peak=particles.peak,
    )
    return SolvedLayer(light, leaving, mean, down, down_clear, down_sun, reflectance)


def shine(grid: Grid, fraction: float, sun: Array) -> tuple[Voxels, Floats]:
    """Send the sun's beam through a layer; return its voxels and what leaves, shape (y, x)."""
    extinction = grid.extinction * np.float32(1.0 - fraction)
    mean = np.empty_like(extinction)
    leaving = np.empty(extinction.shape[1:], np.float32)
    ray, met = np.empty_like(leaving), np.empty_like(leaving)
    slope = math.copysign(max(abs(sun[2]), LEAST_SLOPE), sun[2])
    fill_beam(
        extinction, grid.spacing, float(sun[0]), float(sun[1]), slope, ray, met, mean, leaving
    )
    return Voxels(extinction, grid.spacing, mean, float(leaving.mean())), leaving


def fill_volume(voxels: Voxels, diffuse: Diffuse, out: Floats) -> None:
    """Interleave what rays look up, shape (z, y, x, 1 + channel * harmonic)."""
    out[..., 0] = -np.log(np.maximum(voxels.beam, 1e-30))
    harmonics = diffuse.moments.shape[3]
    for channel, moments in enumerate(diffuse.moments):
        first = 1 + channel * harmonics
        out[..., first : first + harmonics] = moments.transpose(0, 1, 3, 2)


def enter(
    grid: Grid,
    quadrature: Quadrature,
    turn: float,
    air: ClearAir,
    weights: Array,
    sun: Array,
    reflectance: Array | None,
) -> Entering:
    """Light that enters a layer.

    Parameters
    ----------
    grid, quadrature, turn, air, weights, sun
        As of `solve_layer`.
    reflectance : ndarray of float64, shape (channel,), optional
        Of layer and ground, by which the sky above is brighter than over the ground alone.
    """
    above = _boundary(quadrature, turn, quadrature.downward, air, grid.top, sun)
    sky = above.single + above.diffuse
    if reflectance is not None:
        albedo = channels_to_wavelengths(reflectance, weights)
        sky = sky + air.brightening(albedo) * _boundary_of(
            quadrature,
            turn,
            quadrature.downward,
            lambda directions: air.over_bright(grid.top, directions, sun),
        )
    below = _boundary(quadrature, turn, quadrature.upward, air, grid.base, sun)
    at_base = _boundary(quadrature, turn, quadrature.downward, air, grid.base, sun)
    slope = max(float(sun[2]), 0.0)
    return Entering(
        sun=(air.sunlight(grid.levels, float(sun[2])) @ weights).T,
        above=(sky @ weights).T,
        below=(below.diffuse @ weights).T,
        below_lit=(below.single @ weights).T,
        down=quadrature.flux((at_base.single + at_base.diffuse) @ weights),
        down_sun=slope * (air.sunlight(np.array([grid.base]), float(sun[2])) @ weights)[0],
    )


def channels_to_wavelengths(values: Array, weights: Array) -> Array:
    """Spread a ratio per channel over wavelengths by what each adds to the channels."""
    share = np.abs(weights)
    total = share.sum(axis=1, keepdims=True)
    spread: Array = (share / np.maximum(total, 1e-300)) @ values
    return np.clip(spread, 0.0, 0.98)


def _boundary(
    quadrature: Quadrature,
    turn: float,
    hemisphere: slice,
    air: ClearAir,
    altitude: float,
    sun: Array,
) -> Array:
    def light(directions: Array) -> Array:
        parts = air.light_at(altitude, directions, sun)
        return np.stack([parts.single, parts.diffuse], axis=1)

    return _Parts(*_boundary_of(quadrature, turn, hemisphere, light).transpose(1, 0, 2))


@dataclass(frozen=True, eq=False)
class _Parts:
    single: Array
    diffuse: Array


def _boundary_of(quadrature, turn, hemisphere, light):  # type: ignore[no-untyped-def]
    """Mean radiance in the cells of a hemisphere's directions, which keep its flux."""
    directions, share = cell_samples(quadrature, turn, hemisphere)
    # Light comes from where it travels away.
    radiance = light(-directions.reshape(-1, 3))
    radiance = radiance.reshape(*directions.shape[:2], *radiance.shape[1:])
    mean = np.einsum("ds,ds...->d...", share, radiance)
    cells = np.abs(directions[..., 2]).mean(axis=1) * quadrature.weight[hemisphere]
    flux = np.tensordot(cells / cells.sum() * math.pi, mean, axes=1)
    coarse = quadrature.flux(mean)
    return mean * (flux / np.where(coarse == 0.0, 1.0, coarse))


def _reflectance(
    grid: Grid, particles: Particles, air: ClearAir, weights: Array, sun: Array, workers: Workers
) -> Array:
    """Flux up over flux down at the top of a layer, on merged voxels, over the dark ground."""
    extinction, spacing = grid.extinction, grid.spacing
    for _ in range(SKETCH):
        if min(extinction.shape[1:]) < SKETCH_LEAST or any(n % 2 for n in extinction.shape[1:]):
            break
        extinction, spacing = merge_pairs(extinction), 2.0 * spacing
    sketch = Grid(extinction, spacing, grid.base)
    turn = math.atan2(sun[1], sun[0])
    quadrature = double_gauss(particles.order, turn)
    voxels, _ = shine(sketch, particles.fraction, sun)
    entering = enter(sketch, quadrature, turn, air, weights, sun, None)
    scattering = Scattering(particles.order, quadrature, particles.moments, sun)
    diffuse = solve_diffuse(voxels, scattering, entering, workers)
    slope = max(float(sun[2]), 0.0)
    down = (
        quadrature.flux(entering.above.T)
        + slope * (air.sunlight(np.array([grid.top]), float(sun[2])) @ weights)[0]
    )
    ratio: Array = diffuse.up / np.maximum(down, 1e-300)
    return np.clip(ratio, 0.0, 0.95)
