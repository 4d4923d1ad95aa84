"""Extinction near the surface of clouds, which noise displaces."""

from __future__ import annotations

import math

import numpy as np

from skybake.cloud_fields.noise import BILLOW_SIZE
from skybake.cloud_fields.trilinear import between_nodes
from skybake.jit.kernel import kernel

STEP = 2.0**-14
"""Unit in which distances from a surface are stored. [km]"""

_FADES = 4.0
"""Blurs in a period of a noise at which nothing of it is left."""

_AT_BASE = 0.2
"""Share of its displacement that the base of clouds has, which is flat."""

_SWIRL = 0.6
"""By how much of the displacement by coarser noises the finer ones are moved along."""


@kernel
def surface_extinction(field, x, y, altitude, blur, erosion=0.0):
    """Extinction at a point; parameters are those of `extinction_at`. [km⁻¹]"""
    fz = (altitude - field.base) / field.spacing[0]
    if fz < 0.0 or fz >= field.distance.shape[0] - 1:
        return 0.0
    x -= math.floor(x / field.period[0]) * field.period[0]
    y -= math.floor(y / field.period[1]) * field.period[1]
    distance = node_distance(field, x, y, fz) - mean_shift(field, blur) + erosion
    density = surface_density(field, distance, x, y, altitude, blur)
    if density <= 0.0:
        return 0.0
    k = int(fz)
    low, high = field.extinction[k], field.extinction[k + 1]
    return density * (low + (fz - k) * (high - low))


@kernel
def surface_distance(field, x, y, altitude, blur):
    """Distance from the surface that is not displaced, of points beyond the layer that of its end.

    Parameters are those of `extinction_at`. [km]
    """
    x -= math.floor(x / field.period[0]) * field.period[0]
    y -= math.floor(y / field.period[1]) * field.period[1]
    fz = (altitude - field.base) / field.spacing[0]
    fz = min(max(fz, 0.0), field.distance.shape[0] - 1.000001)
    return node_distance(field, x, y, fz) - mean_shift(field, blur)


@kernel
def surface_density(field, distance, x, y, altitude, blur):
    """Share of the full extinction at a point, in [0, 1].

    Parameters
    ----------
    field : CloudField
        A surface.
    distance : float
        From the surface that is not displaced. [km]
    x, y, altitude, blur : float
        As `extinction_at` takes them, with x and y within the tile.
    """
    width = edge_width(field, blur)
    beyond = 0.5 * width
    left = reach_of_noise(field, blur)
    if distance - left >= beyond:
        return 0.0
    if altitude <= field.condensation - beyond - _AT_BASE * left:
        return 0.0
    moved = 0.0
    near_base = altitude < field.condensation + beyond + _AT_BASE * left
    if distance + left > -beyond or near_base:
        for q in range(field.displacement.shape[0]):
            amplitude = _amplitude(field, q, blur)
            if amplitude <= 0.0:
                break
            # Coarser bulges carry the finer ones along, which hides the lattice of both.
            swirl = _SWIRL * moved
            moved += amplitude * _noise(field, q, x + swirl, y - swirl, altitude + 0.5 * swirl)
            left -= amplitude
            if distance - moved - left >= beyond:
                return 0.0
    distance = max(distance - moved, field.condensation - altitude - _AT_BASE * moved)
    return min(0.5 - distance / width, 1.0)


@kernel
def edge_width(field, blur):
    """Distance over which extinction falls at the surface. [km]"""
    return min(field.edge + blur, field.widest_edge)


@kernel
def reach_of_noise(field, blur):
    """Farthest that noise displaces the surface. [km]"""
    total = 0.0
    for q in range(field.displacement.shape[0]):
        total += max(_amplitude(field, q, blur), 0.0)
    return total


@kernel
def mean_shift(field, blur):
    """By how much the surface is moved outward so that blur keeps the mean extinction. [km]"""
    last = field.shift.shape[0] - 1
    if blur >= field.largest_blur:
        return field.shift[last]
    f = math.sqrt(blur / field.largest_blur) * last
    i = min(int(f), last - 1)
    return field.shift[i] + (f - i) * (field.shift[i + 1] - field.shift[i])


@kernel
def node_distance(field, x, y, fz):
    """Trilinear distance from the surface that is not displaced, at a height in nodes. [km]"""
    nodes = field.distance
    _, rows, columns = nodes.shape
    fy, fx = y / field.spacing[1], x / field.spacing[2]
    # Indices without a sign need no check for a negative one.
    k, j, i = np.uint32(fz), np.uint32(fy), np.uint32(fx)
    u, v, w = fx - i, fy - j, fz - k
    # Rounding may put a point of the last cell on the period itself.
    i = np.uint32(0) if i >= columns else i
    j = np.uint32(0) if j >= rows else j
    east = np.uint32(i + 1) if i + 1 < columns else np.uint32(0)
    north = np.uint32(j + 1) if j + 1 < rows else np.uint32(0)
    up = np.uint32(k + 1)
    a = nodes[k, j, i] + u * (nodes[k, j, east] - nodes[k, j, i])
    b = nodes[k, north, i] + u * (nodes[k, north, east] - nodes[k, north, i])
    c = nodes[up, j, i] + u * (nodes[up, j, east] - nodes[up, j, i])
    d = nodes[up, north, i] + u * (nodes[k + 1, north, east] - nodes[k + 1, north, i])
    a += v * (b - a)
    c += v * (d - c)
    return STEP * (a + w * (c - a))


@kernel
def _amplitude(field, q, blur):
    """Amplitude of a noise, 0 or less where blur leaves nothing of it. [km]"""
    return field.displacement[q, 0] * (1.0 - _FADES * blur * field.displacement[q, 5])


@kernel
def _noise(field, q, x, y, z):
    """Trilinear noise at a point, in [-1, 1]."""
    row = field.displacement[q]
    fx = row[1] * x + row[2] * y + row[6]
    fy = row[3] * x + row[4] * y + row[7]
    fz = row[5] * z + row[8]
    fx, fy = (fx - math.floor(fx)) * BILLOW_SIZE, (fy - math.floor(fy)) * BILLOW_SIZE
    fz = (fz - math.floor(fz)) * BILLOW_SIZE
    return between_nodes(field.noise, fx, fy, fz) / 127.0
