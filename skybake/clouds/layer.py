"""The light of one layer of clouds: from what enters it to what the eye's rays look up."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.air import ClearAir, Light
from skybake.clouds.beam import fill_beam
from skybake.clouds.curved_beam import fill_curved_beam
from skybake.clouds.diffuse import Diffuse, Known, solve_diffuse
from skybake.clouds.harmonics import degrees
from skybake.clouds.light import LayerLight, half_words
from skybake.clouds.particles import Particles
from skybake.clouds.quadrature import Quadrature, cell_samples, double_gauss
from skybake.clouds.transfer import Entering, Scattering, Voxels
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

FLAT = math.sin(math.radians(12.0))
"""Of a sun, above which the planet's curvature does not matter to its beam."""

HEIGHTS = 3
"""At which the light of clear air within a layer is told, from its base to its top."""


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
        height: float = self.extinction.shape[0] * float(self.spacing[0])
        return self.base + height

    @property
    def levels(self) -> Array:
        """Altitudes of the voxels' middles. [km]"""
        middles: Array = (np.arange(self.extinction.shape[0]) + 0.5) * self.spacing[0]
        return self.base + middles


class Reflectance(NamedTuple):
    """What a layer and all beneath it reflect of the light that comes down, by channel.

    Attributes
    ----------
    flux : ndarray of float64, shape (channel,)
        All of it.
    scattered : ndarray of float64, shape (channel,)
        As if all directions were as bright as those are on average whose light the air above
        scatters, see `Quadrature.flux_scattered`: clouds under a low sun are brightest where they
        are seen from beside. May exceed 1.
    """

    flux: Array
    scattered: Array


@dataclass(frozen=True, eq=False)
class SolvedLayer:
    """A layer with its light.

    Attributes
    ----------
    light : LayerLight
        For the eye's rays.
    leaving : ndarray of float32, shape (sun, 2, y, x)
        Share of the sun's beam that reaches what is beneath and what is above, without forward
        peaks.
    mean_radiance : ndarray of float64, shape (sun, z, channel)
        Of the diffuse light, over all directions and the tile, times 4 pi.
    down : ndarray of float64, shape (sun, channel)
        Diffuse irradiance of a horizontal plane at the base.
    down_clear : ndarray of float64, shape (sun, channel)
        What the sky would bring there without clouds.
    reflectance : Reflectance
        Of the layer and what is beneath, seen from above.
    """

    light: LayerLight
    leaving: Floats
    mean_radiance: Array
    down: Array
    down_clear: Array
    reflectance: Reflectance


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Other layers around one.

    Attributes
    ----------
    sun_share, sky_ratio : ndarray of float64, shape (channel,)
        What layers above leave of the sun's beam, and of the sky's irradiance.
    ground : ndarray of float64, shape (channel,) or None
        Reflectance of the layers and the ground beneath; None for the ground alone.
    """

    sun_share: Array
    sky_ratio: Array
    ground: Array | None


def solve_layer(
    grid: Grid,
    particles: Particles,
    air: ClearAir,
    weights: Array,
    suns: Array,
    own: int,
    around: Surroundings,
    reflectance: Reflectance,
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
    own : int
        Which of them stands over the observer: it is solved for first, and most exactly.
    around : Surroundings
        Other layers.
    reflectance : Reflectance
        Of this layer and what is beneath, see `skybake.clouds.reflectance.reflectance_of`.
    workers : Workers
        Threads that do the work.
    """
    quadrature, turn = directions_of(particles, suns[0])
    harmonics, channels = (particles.order + 1) ** 2, weights.shape[1]
    beam = np.empty((len(suns), *grid.extinction.shape), np.float32)
    moments = np.empty((*beam.shape, channels * harmonics), np.uint16)
    leaving = np.empty((len(suns), 2, *grid.extinction.shape[1:]), np.float32)
    irradiance = np.empty((len(suns), grid.extinction.shape[0], channels))
    mean = np.empty_like(irradiance)
    down, down_clear = np.empty((len(suns), channels)), np.empty((len(suns), channels))
    known: dict[int, tuple[Known, ...]] = {}
    for s in [*range(own, len(suns)), *range(own - 1, -1, -1)]:
        sun = suns[s]
        voxels, leaving[s] = shine(grid, air.radius, particles.fraction, sun)
        entering = enter(grid, quadrature, turn, air, weights, sun, around, reflectance.scattered)
        scattering = Scattering(particles.order, quadrature, particles.moments, sun)
        near = known.get(s - 1) if s > own else known.get(s + 1)
        diffuse = solve_diffuse(voxels, scattering, entering, workers, near)
        # No more than what other suns start from is held while they are solved for.
        known = {at: each for at, each in known.items() if at == own} | {s: diffuse.known}
        beam[s] = voxels.beam
        fill_moments(diffuse, moments[s])
        irradiance[s] = entering.sun.T
        mean[s] = diffuse.moments[:, :, :, 0].mean(axis=(2, 3), dtype=float).T
        down[s], down_clear[s] = diffuse.down, entering.down
        del diffuse, near
    degree = degrees(particles.order)
    light = LayerLight(
        beam=beam,
        moments=moments,
        spacing=grid.spacing,
        base=grid.base,
        sun_mu=np.ascontiguousarray(suns[:, 2]),
        irradiance=irradiance,
        brightness=mean.mean(axis=1),
        order=particles.order,
        fraction=particles.fraction,
        scatter=(2 * degree + 1) / (4.0 * math.pi) * particles.moments[degree],
        truncated=particles.truncated,
        peak=particles.peak,
    )
    return SolvedLayer(light, leaving, mean, down, down_clear, reflectance)


def directions_of(particles: Particles, sun: Array) -> tuple[Quadrature, float]:
    """Directions of a layer's light and the azimuth of the first, which avoids the sun's."""
    turn = math.atan2(sun[1], sun[0]) + math.pi / (2.0 * (particles.order + 1))
    return double_gauss(particles.order, turn), turn


def shine(grid: Grid, radius: float, fraction: float, sun: Array) -> tuple[Voxels, Floats]:
    """Send the sun's beam through a layer; return its voxels and what leaves, shape (2, y, x).

    Without a sun nothing is in its shadow.
    """
    extinction = grid.extinction * np.float32(1.0 - fraction)
    leaving = np.ones((2, *extinction.shape[1:]), np.float32)
    if not sun.any():
        return Voxels(extinction, grid.spacing, np.ones_like(extinction), 1.0), leaving
    mean = np.empty_like(extinction)
    ray, met = np.empty_like(leaving)
    toward = [float(each) for each in sun]
    if toward[2] > FLAT:
        fill_beam(extinction, grid.spacing, *toward, ray, met, mean, leaving[0])
    else:
        around = radius + grid.base
        fill_curved_beam(extinction, grid.spacing, around, *toward, ray, met, mean, leaving)
    return Voxels(extinction, grid.spacing, mean, float(leaving[0].mean())), leaving


def fill_moments(diffuse: Diffuse, out: npt.NDArray[np.uint16]) -> None:
    """Interleave what rays look up, shape (z, y, x, channel * harmonic)."""
    harmonics = diffuse.moments.shape[3]
    for channel, moments in enumerate(diffuse.moments):
        first = channel * harmonics
        out[..., first : first + harmonics] = half_words(moments).transpose(0, 1, 3, 2)


def enter(
    grid: Grid,
    quadrature: Quadrature,
    turn: float,
    air: ClearAir,
    weights: Array,
    sun: Array,
    around: Surroundings,
    reflectance: Array | None,
) -> Entering:
    """Light that enters a layer.

    Parameters
    ----------
    grid, quadrature, turn, air, weights, sun, around
        As of `solve_layer`.
    reflectance : ndarray of float64, shape (channel,) or None
        `Reflectance.scattered` of the layer, by which the sky above is brighter than over the
        ground.
    """

    def mean_light(altitude: float, hemisphere: slice) -> Light:
        def light(directions: Array) -> Array:
            return np.stack(air.light_at(altitude, directions, sun), axis=1)

        parts = _mean_in_cells(quadrature, turn, hemisphere, light)
        return Light(parts[:, 0], parts[:, 1])

    heights = np.linspace(grid.base, grid.top, HEIGHTS)
    # (height, hemisphere, single or diffuse, direction, wavelength)
    clear = np.array(
        [
            [mean_light(height, half) for half in (quadrature.downward, quadrature.upward)]
            for height in heights.tolist()
        ]
    )
    sky = clear[-1, 0].sum(axis=0)
    if reflectance is not None:

        def glow(directions: Array) -> Array:
            return air.over_bright(grid.top, directions, sun)

        albedo = channels_to_wavelengths(reflectance, weights)
        more = _mean_in_cells(quadrature, turn, quadrature.downward, glow)
        sky = sky + air.brightening(albedo, grid.top, sun) * more
    below = Light(*clear[0, 1])
    down = quadrature.flux(clear[0, 0].sum(axis=0) @ weights)
    slope = max(float(sun[2]), 0.0)
    down_sun = slope * (air.sunlight(np.array([grid.base]), float(sun[2])) @ weights)[0]
    straight = below.single @ weights
    brighter = np.ones_like(down)
    if around.ground is not None:
        up = quadrature.flux((below.single + below.diffuse) @ weights)
        brighter = around.ground * (down + down_sun) / np.maximum(up, 1e-300)
        if not sun.any():
            # What the ground sends by itself passes the layers beneath.
            straight = straight * (1.0 - around.ground)
    return Entering(
        sun=(air.sunlight(grid.levels, float(sun[2])) @ weights * around.sun_share).T,
        above=(sky @ weights * around.sky_ratio).T,
        below=(below.diffuse @ weights * brighter).T,
        below_lit=straight.T,
        down=down,
        down_sun=down_sun,
        sun_share=around.sun_share,
        clear_single=(clear[:, :, 0] @ weights).transpose(3, 1, 0, 2),
        clear_diffuse=(clear[:, :, 1] @ weights).transpose(3, 1, 0, 2),
    )


def channels_to_wavelengths(values: Array, weights: Array) -> Array:
    """Spread a ratio per channel over wavelengths by what each adds to the channels."""
    share = np.abs(weights)
    total = share.sum(axis=1, keepdims=True)
    spread: Array = (share / np.maximum(total, 1e-300)) @ values
    return spread


def _mean_in_cells(
    quadrature: Quadrature, turn: float, hemisphere: slice, light: Callable[[Array], Array]
) -> Array:
    """Mean radiance in the cells of a hemisphere's directions, scaled to keep its flux."""
    directions, share = cell_samples(quadrature, turn, hemisphere)
    # Light comes from where it travels away.
    radiance = light(-directions.reshape(-1, 3))
    radiance = radiance.reshape(*directions.shape[:2], *radiance.shape[1:])
    mean: Array = np.einsum("ds,ds...->d...", share, radiance)
    cells = np.abs(directions[..., 2]).mean(axis=1) * quadrature.weight[hemisphere]
    flux = np.tensordot(cells / cells.sum() * math.pi, mean, axes=1)
    coarse = quadrature.flux(mean)
    return mean * (flux / np.where(coarse == 0.0, 1.0, coarse))
