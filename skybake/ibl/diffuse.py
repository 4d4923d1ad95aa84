"""Irradiance: what a white diffuse surface shows that faces a direction."""

from __future__ import annotations

import math

import numpy as np

from skybake.ibl.cube import Array, Cube, texel_directions, texel_sizes
from skybake.ibl.kernels import fill_irradiance
from skybake.ibl.points import Points
from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers

SOURCE_EDGE = 32
"""Edge of the cube whose texels are summed up. [pixel]"""

AT_ONCE = 4
"""Normals that `fill_irradiance` takes together."""


def diffuse_cube(cube: Cube, points: Points, edge: int, workers: Workers = ALL_CPUS) -> Cube:
    """Return the irradiance of planes that face the texels of a cube, over pi.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        The light but for the points.
    points : Points
        Light from points.
    edge : int
        Of the result, a multiple of 2. [pixel]
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float32, shape (6, edge, edge, 3)
        Radiance of white surfaces: a sky of radiance 1 gives 1.

    Notes
    -----
    The integral is a sum over all texels, not of samples. Each counts by the integral of its
    light times direction, whose product with the normal is exact whatever the texel shows, if
    all of it is above the plane.
    """
    coarse = min(cube.shape[1], SOURCE_EDGE)
    toward = np.concatenate([texel_directions(coarse).reshape(-1, 3), points.directions])
    moments = np.concatenate(
        [_moments(cube, coarse), points.flux[..., None] * points.directions[:, None]]
    )
    # Colours outside the space have negative channels, which light planes as negative light.
    signs = np.where(np.einsum("sca,sa->cs", moments, toward) < 0.0, -1.0, 1.0)
    weighted = np.ascontiguousarray(moments.transpose(1, 2, 0)) * signs[:, None] / math.pi
    sources = flatten(weighted.astype(np.float32)), flatten(signs.astype(np.float32))
    normals = texel_directions(edge).reshape(-1, 3)
    out = np.empty(normals.shape, np.float32)

    def work(first: int, last: int) -> None:
        fill_irradiance(normals[first:last], *sources, out[first:last])

    workers.run_rows(len(normals), work, chunk=AT_ONCE * -(-edge * edge // (4 * AT_ONCE)))
    return out.reshape(6, edge, edge, 3)


def _moments(cube: Cube, coarse: int) -> Array:
    """Integrals of light times direction over the texels of a coarser cube, (texel, 3, 3)."""
    edge = cube.shape[1]
    light = cube * texel_sizes(edge)[..., None].astype(np.float32)
    directions = texel_directions(edge)
    blocks = (6, coarse, edge // coarse, coarse, edge // coarse, 3)
    sums = [
        (light * directions[..., axis, None]).reshape(blocks).sum(axis=(2, 4), dtype=np.float64)
        for axis in range(3)
    ]
    return np.stack(sums, axis=-1).reshape(-1, 3, 3)
