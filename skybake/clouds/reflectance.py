"""What a layer of clouds and all beneath it reflect."""

from __future__ import annotations

import numpy as np

from skybake.clouds.air import ClearAir
from skybake.clouds.diffuse import solve_diffuse
from skybake.clouds.layer import Grid, Reflectance, Surroundings, directions_of, enter, shine
from skybake.clouds.merging import merge_pairs
from skybake.clouds.particles import Particles
from skybake.clouds.transfer import Entering, Scattering, Voxels
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

SKETCH = 2
"""How often voxels are merged by two for a first sight of what a layer reflects."""

SKETCH_LEAST = 8

MOST_REFLECTED, MOST_SCATTERED = 0.98, 8.0


def reflectance_of(
    grid: Grid,
    particles: Particles,
    air: ClearAir,
    weights: Array,
    sun: Array,
    ground: Array | None,
    workers: Workers,
) -> Reflectance:
    """Compare the light that goes up at the top of a layer with what comes down, on merged voxels.

    Parameters
    ----------
    grid, particles, air, weights, workers
        As of `solve_layer`.
    sun : ndarray of float64, shape (3,)
        Toward the sun.
    ground : ndarray of float64, shape (channel,) or None
        As of `Surroundings`.
    """
    extinction, spacing = grid.extinction, grid.spacing
    for _ in range(SKETCH):
        if min(extinction.shape[1:]) < SKETCH_LEAST or any(n % 2 for n in extinction.shape[1:]):
            break
        extinction, spacing = merge_pairs(extinction), 2.0 * spacing
    sketch = Grid(extinction, spacing, grid.base)
    quadrature, turn = directions_of(particles, sun)
    voxels, _ = shine(sketch, air.radius, particles.fraction, sun)
    channels = weights.shape[1]
    around = Surroundings(np.ones(channels), np.ones(channels), ground)
    entering = enter(sketch, quadrature, turn, air, weights, sun, around, None)
    scattering = Scattering(particles.order, quadrature, particles.moments, sun)
    diffuse = solve_diffuse(voxels, scattering, entering, workers)
    beam = air.sunlight(np.array([grid.top]), float(sun[2])) @ weights
    caught = caught_beam(voxels, entering)
    direct = np.maximum(max(float(sun[2]), 0.0) * beam[0], caught)
    down = np.maximum(quadrature.flux(entering.above.T) + direct, 1e-300)
    depth = air.depth_above(grid.top) @ weights / weights.sum(axis=0)
    return Reflectance(
        np.clip(quadrature.flux(diffuse.up) / down, 0.0, MOST_REFLECTED),
        np.clip(quadrature.flux_scattered(diffuse.up, depth) / down, 0.0, MOST_SCATTERED),
    )


def caught_beam(voxels: Voxels, entering: Entering) -> Array:
    """Sunlight that a layer scatters, by area of the ground, shape (channel,).

    Also a sun on the horizontal shines on what stands out of a layer.
    """
    met = (voxels.extinction * voxels.beam).mean(axis=(1, 2), dtype=float) * voxels.spacing[0]
    caught: Array = entering.sun @ met
    return caught
