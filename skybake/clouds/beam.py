"""The sun's beam through a layer of voxels."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.transport.exponential import fast_exp32


@kernel
def fill_beam(extinction, spacing, x, y, z, ray, met, mean, leaving):
    """Write the mean of a beam that enters with 1 in each voxel, and what leaves the layer.

    Parameters
    ----------
    extinction : ndarray of float32, shape (z, y, x)
        Without forward peaks; periodic in y and x. [km⁻¹]
    spacing : ndarray of float64, shape (3,)
        Of voxels along z, y and x. [km]
    x, y, z : float
        Unit vector toward the sun. A sun below the horizontal shines up through the layer.
    ray, met : ndarray of float32, shape (y, x)
        Work space.
    mean : ndarray of float32, shape (z, y, x)
        Receives the mean beam.
    leaving : ndarray of float32, shape (y, x)
        Receives the beam at the face where it leaves.

    Notes
    -----
    A lattice of rays, one for each voxel of a plane, moves through the tile: nothing is
    interpolated twice, so shadows stay sharp. A ray meets the bilinear mean of four voxels, and
    gives each the same share of itself: what the beam loses is what voxels scatter.
    """
    levels, rows, columns = extinction.shape
    length = spacing[0] / abs(z)
    along_x, along_y = -x * length / spacing[2], -y * length / spacing[1]
    parts = max(1, math.ceil(math.hypot(along_x, along_y)))
    step, share = np.float32(length / parts), np.float32(1.0 / parts)
    for j in range(rows):
        for i in range(columns):
            ray[j, i] = 1.0
            leaving[j, i] = 0.0
    for q in range(levels):
        k = levels - 1 - q if z > 0.0 else q
        here = mean[k]
        for j in range(rows):
            for i in range(columns):
                here[j, i] = 0.0
        for part in range(parts):
            along = q + (part + 0.5) / parts
            gather_plane(extinction[k], along * along_x, along * along_y, met)
            for j in range(rows):
                for i in range(columns):
                    depth = met[j, i] * step
                    passes = fast_exp32(-depth)
                    met[j, i] = share * ray[j, i] * mean_passing(depth, passes)
                    ray[j, i] *= passes
            scatter_plane(met, along * along_x, along * along_y, here)
    scatter_plane(ray, levels * along_x, levels * along_y, leaving)


@kernel
def mean_passing(depth, passes):
    """Mean of exp(-t) over t from 0 to `depth`, of which `passes` is exp(-depth)."""
    if depth > np.float32(0.02):
        return (np.float32(1.0) - passes) / depth
    return np.float32(1.0) - depth * (np.float32(0.5) - depth * np.float32(1 / 6))


@kernel
def gather_plane(plane, shift_x, shift_y, out):
    """Write a plane at places that are shifted by so many voxels, bilinear and periodic."""
    rows, columns = out.shape
    whole_x, whole_y = math.floor(shift_x), math.floor(shift_y)
    u, v = np.float32(shift_x - whole_x), np.float32(shift_y - whole_y)
    first = whole_x % columns
    for j in range(rows):
        low = plane[(j + whole_y) % rows]
        high = plane[(j + whole_y + 1) % rows]
        i = first
        for n in range(columns):
            east = i + 1 if i + 1 < columns else 0
            a = low[i] + u * (low[east] - low[i])
            b = high[i] + u * (high[east] - high[i])
            out[j, n] = a + v * (b - a)
            i = east


@kernel
def scatter_plane(plane, shift_x, shift_y, out):
    """Add to places that are shifted by so many voxels what `gather_plane` would weigh equally."""
    rows, columns = out.shape
    whole_x, whole_y = math.floor(shift_x), math.floor(shift_y)
    u, v = np.float32(shift_x - whole_x), np.float32(shift_y - whole_y)
    first = whole_x % columns
    for j in range(rows):
        low = out[(j + whole_y) % rows]
        high = out[(j + whole_y + 1) % rows]
        i = first
        for n in range(columns):
            east = i + 1 if i + 1 < columns else 0
            value = plane[j, n]
            a = value * (np.float32(1.0) - v)
            b = value - a
            low[i] += a - u * a
            low[east] += u * a
            high[i] += b - u * b
            high[east] += u * b
            i = east
