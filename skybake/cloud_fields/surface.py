"""Extinction near the surface of clouds, which noise displaces."""

from __future__ import annotations

import math

import numpy as np

from skybake.cloud_fields.noise import BILLOW_SIZE
from skybake.jit.kernel import inlined_kernel, kernel

STEP = 2.0**-14
"""Unit in which distances from a surface are stored. [km]"""

_FADES = 4.0
"""Blurs in a period of a noise at which nothing of it is left."""

AT_BASE = 0.2
"""Share of its displacement that the base of clouds has, which is flat."""

_NOISES = 3
"""Noises of a field at most."""

_PERIODS = 4096.0
"""Periods of a noise by which its coordinates are above 0 for sure."""

_PER_STEP = 1.0 / 127.0

_STEEPNESS = 0.5
"""Share of the distance from a displaced surface that is free of clouds for the most part: noises
are as steep as that."""

_SWIRL = 0.6
"""By how much of the displacement by coarser noises the finer ones are moved along."""


@kernel
def surface_detail(field, blur):
    """Return what blur leaves of a surface, and reciprocals of lengths, for a number of points.

    Returns
    -------
    shift, width : float
        Of `mean_shift` and `edge_width`. [km]
    coarse, middle, fine : float
        Amplitudes of the noises, 0 where nothing of one is left. [km]
    along_x, along_y, along_z : float
        Tiles along x and y, and nodes along z, in a kilometre. [km⁻¹]
    """
    count = field.displacement.shape[0]
    coarse = _amplitude(field, 0, blur) if count > 0 else 0.0
    middle = _amplitude(field, 1, blur) if count > 1 else 0.0
    fine = _amplitude(field, 2, blur) if count > 2 else 0.0
    return (
        mean_shift(field, blur),
        edge_width(field, blur),
        max(coarse, 0.0),
        max(middle, 0.0),
        max(fine, 0.0),
        1.0 / field.period[0],
        1.0 / field.period[1],
        1.0 / field.spacing[0],
    )


@inlined_kernel
def surface_extinction(field, x, y, altitude, detail, erosion=0.0):
    """Extinction at a point with the detail of a blur; others are as of `extinction_at`. [km⁻¹]"""
    return surface_around(field, x, y, altitude, detail, erosion)[0]


@inlined_kernel
def surface_around(field, x, y, altitude, detail, erosion):
    """Return the extinction at a point, and how far from it clouds are where there is none.

    Parameters are those of `surface_extinction`. Distances are estimates: noises may bring clouds
    nearer, but seldom do. [km⁻¹], [km]
    """
    shift, _, _, _, _, along_x, along_y, along_z = detail
    fz = (altitude - field.base) * along_z
    levels, rows, columns = field.distance.shape
    if fz < 0.0 or fz >= levels - 1:
        return 0.0, 0.0
    x -= math.floor(x * along_x) * field.period[0]
    y -= math.floor(y * along_y) * field.period[1]
    distance = node_distance(field, x * along_x * columns, y * along_y * rows, fz)
    distance += erosion - shift
    density = _density(field, distance, x, y, altitude, detail)
    if density <= 0.0:
        return 0.0, -density
    k = int(fz)
    low, high = field.extinction[k], field.extinction[k + 1]
    return density * (low + (fz - k) * (high - low)), 0.0


@kernel
def surface_distance(field, x, y, altitude, detail):
    """Distance from the surface that is not displaced, of points beyond the layer that of its end.

    Parameters are those of `surface_extinction`. [km]
    """
    shift, _, _, _, _, along_x, along_y, along_z = detail
    levels, rows, columns = field.distance.shape
    x -= math.floor(x * along_x) * field.period[0]
    y -= math.floor(y * along_y) * field.period[1]
    fz = min(max((altitude - field.base) * along_z, 0.0), levels - 1.000001)
    return node_distance(field, x * along_x * columns, y * along_y * rows, fz) - shift


@inlined_kernel
def _density(field, distance, x, y, altitude, detail):
    """Share of the full extinction at a point, at most 1; outside of clouds minus the distance.

    `distance` is that from the surface that is not displaced, and x and y are within the tile.
    """
    _, width, coarse, middle, fine, _, _, _ = detail
    beyond = 0.5 * width
    left = coarse + middle + fine
    if distance - left >= beyond:
        return beyond + left - distance
    below = field.condensation - altitude
    if below >= beyond + AT_BASE * left:
        return beyond + AT_BASE * left - below
    moved = 0.0
    for q in range(_NOISES):
        amplitude = coarse if q == 0 else middle if q == 1 else fine
        if amplitude <= 0.0:
            break
        # Where nothing that is left can bring a point out of its cloud, none is looked up.
        deep, high = moved - distance - left, AT_BASE * (moved - left) - below
        if min(deep, high) >= beyond:
            return 1.0
        # Coarser bulges carry the finer ones along, which hides the lattice of both.
        swirl = _SWIRL * moved
        moved += amplitude * _noise(field, q, x + swirl, y - swirl, altitude + 0.5 * swirl)
        left -= amplitude
        if distance - moved - left >= beyond:
            return _STEEPNESS * (beyond + left + moved - distance)
    distance = max(distance - moved, below - AT_BASE * moved)
    if distance >= beyond:
        return _STEEPNESS * (beyond - distance)
    return min(0.5 - distance / width, 1.0)


@kernel
def edge_width(field, blur):
    """Distance over which extinction falls at the surface. [km]"""
    return min(field.edge + blur, field.widest_edge)


@kernel
def mean_shift(field, blur):
    """By how much the surface is moved outward so that blur keeps the mean extinction. [km]"""
    last = field.shift.shape[0] - 1
    if blur >= field.largest_blur:
        return field.shift[last]
    f = math.sqrt(blur / field.largest_blur) * last
    i = min(int(f), last - 1)
    return field.shift[i] + (f - i) * (field.shift[i + 1] - field.shift[i])


@inlined_kernel
def node_distance(field, fx, fy, fz):
    """Trilinear distance from the surface that is not displaced, at coordinates in nodes. [km]"""
    nodes = field.distance
    _, rows, columns = nodes.shape
    # Indices without a sign need no check for a negative one.
    k, j, i = np.uint32(fz), np.uint32(fy), np.uint32(fx)
    u, v, w = fx - i, fy - j, fz - k
    # Rounding may put a point of the last cell on the period itself.
    i = np.uint32(0) if i >= columns else i
    j = np.uint32(0) if j >= rows else j
    east = np.uint32(i + 1) if i + 1 < columns else np.uint32(0)
    north = np.uint32(j + 1) if j + 1 < rows else np.uint32(0)
    up = np.uint32(k + 1)
    low = _between_rows(nodes[k, j], nodes[k, north], i, east, u, v)
    high = _between_rows(nodes[up, j], nodes[up, north], i, east, u, v)
    return STEP * (low + w * (high - low))


@inlined_kernel
def _between_rows(south, north, west, east, u, v):
    """Bilinear value of two rows of whole numbers."""
    a, b = np.int32(south[west]), np.int32(north[west])
    low, high = a + u * (np.int32(south[east]) - a), b + u * (np.int32(north[east]) - b)
    return low + v * (high - low)


@kernel
def _amplitude(field, q, blur):
    """Amplitude of a noise, 0 or less where blur leaves nothing of it. [km]"""
    return field.displacement[q, 0] * (1.0 - _FADES * blur * field.displacement[q, 5])


@inlined_kernel
def _noise(field, q, x, y, z):
    """Trilinear noise at a point, in [-1, 1]."""
    row, volume = field.displacement[q], field.noise
    # Whole periods more leave no negative number, which would not be rounded down.
    fx = (row[1] * x + row[2] * y + row[6] + _PERIODS) * BILLOW_SIZE
    fy = (row[3] * x + row[4] * y + row[7] + _PERIODS) * BILLOW_SIZE
    fz = (row[5] * z + row[8] + _PERIODS) * BILLOW_SIZE
    k, j, i = np.uint32(fz), np.uint32(fy), np.uint32(fx)
    u, v, w = fx - i, fy - j, fz - k
    mask, one = np.uint32(BILLOW_SIZE - 1), np.uint32(1)
    east, north, up = (i + one) & mask, (j + one) & mask, (k + one) & mask
    i, j, k = i & mask, j & mask, k & mask
    low = _between_rows(volume[k, j], volume[k, north], i, east, u, v)
    high = _between_rows(volume[up, j], volume[up, north], i, east, u, v)
    return (low + w * (high - low)) * _PER_STEP
