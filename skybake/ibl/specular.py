"""What mirrors of some roughness show, in all directions: the levels of a specular cube."""

from __future__ import annotations

import math

import numpy as np

from skybake.ibl.cube import Cube, pyramid, texel_directions, with_borders
from skybake.ibl.kernels import add_lobes, fill_filtered
from skybake.ibl.lobe import lobe_samples, lobe_total
from skybake.ibl.points import Points
from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers

CHUNKS = 16
"""Shares of the work on a level."""


def specular_cubes(
    cube: Cube,
    points: Points,
    sizes: list[tuple[int, float]],
    samples: int,
    workers: Workers = ALL_CPUS,
) -> list[Cube]:
    """Return cubes of filtered radiance.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        The light but for the points; n is a power of 2.
    points : Points
        Light from points, whose lobes are added exactly.
    sizes : list of (int, float)
        Edge [pixel] and perceptual roughness of each cube to return: GGX's width is the square of
        the roughness, which is greater than 0 and at most 1.
    samples : int
        Directions in which the lobe of a texel is sampled.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    list of ndarray of float32, shape (6, edge, edge, 3)
        A sky of radiance 1 gives 1.
    """
    levels = pyramid(cube)
    bordered = [with_borders(level).reshape(-1, 3) for level in levels]
    edges = np.array([level.shape[1] for level in levels])
    starts = np.cumsum([0, *(len(texels) for texels in bordered[:-1])])
    source = tuple(flatten(each) for each in (np.concatenate(bordered), starts, edges))
    directions = flatten(np.ascontiguousarray(points.directions.T, np.float32))
    flux = flatten(np.ascontiguousarray(points.flux.T, np.float32))
    cubes = []
    for edge, roughness in sizes:
        alpha = roughness * roughness
        taken = lobe_samples(alpha, samples, cube.shape[1], len(levels))
        lobe = [flatten(each) for each in taken]
        scale = alpha * alpha / (math.pi * lobe_total(alpha))
        width = [flatten(np.array([each], np.float32)) for each in (alpha * alpha, scale)]
        normals = texel_directions(edge).reshape(-1, 3)
        out = np.empty(normals.shape, np.float32)

        def work(first: int, last: int) -> None:
            fill_filtered(normals[first:last], *source, *lobe, out[first:last])
            add_lobes(normals[first:last], directions, flux, *width, out[first:last])

        workers.run_rows(len(normals), work, chunk=-(-len(normals) // CHUNKS))
        cubes.append(out.reshape(6, edge, edge, 3))
    return cubes
