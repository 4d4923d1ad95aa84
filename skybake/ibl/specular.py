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


class SpecularFilter:
    """Filters light by the lobes of rough mirrors.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        The light but for the points; n is a power of 2.
    points : Points
        Light from points, whose lobes are added exactly.
    """

    def __init__(self, cube: Cube, points: Points) -> None:
        levels = pyramid(cube)
        self._edge, self._levels = cube.shape[1], len(levels)
        bordered = [with_borders(level).reshape(-1, 3) for level in levels]
        edges = np.array([level.shape[1] for level in levels])
        starts = np.cumsum([0, *(len(texels) for texels in bordered[:-1])])
        source = np.concatenate(bordered), starts, edges
        self._source = [flatten(each) for each in source]
        light = points.directions.T, points.flux.T
        self._points = [flatten(np.ascontiguousarray(each, np.float32)) for each in light]

    def cube(self, edge: int, roughness: float, samples: int, workers: Workers = ALL_CPUS) -> Cube:
        """Return what mirrors of a roughness show.

        Parameters
        ----------
        edge : int
            Of the cube. [pixel]
        roughness : float
            Perceptual, greater than 0 and at most 1: GGX's width is its square.
        samples : int
            Directions in which the lobe of a texel is sampled.
        workers : Workers, optional
            Threads that do the work.

        Returns
        -------
        ndarray of float32, shape (6, edge, edge, 3)
            A sky of radiance 1 gives 1.
        """
        alpha = roughness * roughness
        lobe = [flatten(part) for part in lobe_samples(alpha, samples, self._edge, self._levels)]
        scale = alpha * alpha / (math.pi * lobe_total(alpha))
        width = [flatten(np.array([each], np.float32)) for each in (alpha * alpha, scale)]
        normals = texel_directions(edge).reshape(-1, 3)
        out = np.empty(normals.shape, np.float32)

        def work(first: int, last: int) -> None:
            fill_filtered(normals[first:last], *self._source, *lobe, out[first:last])
            add_lobes(normals[first:last], *self._points, *width, out[first:last])

        workers.run_rows(len(normals), work, chunk=-(-len(normals) // CHUNKS))
        return out.reshape(6, edge, edge, 3)
