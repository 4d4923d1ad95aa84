"""Interpolation in a sky's table, with cubics between its nodes or linearly."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.sky.table import dusk_coordinate, sun_range


@kernel
def _fill_weights(x, size, is_linear, out):
    """Catmull-Rom or linear weights of four nodes around `x`; returns the first, maybe -1."""
    i = min(max(int(x), 0), size - 2)
    s = min(max(x - i, 0.0), 1.0)
    if is_linear:
        out[0], out[1], out[2], out[3] = 0.0, 1.0 - s, s, 0.0
        return i - 1
    out[0] = 0.5 * s * (-1.0 + s * (2.0 - s))
    out[1] = 1.0 + 0.5 * s * s * (3.0 * s - 5.0)
    out[2] = 0.5 * s * (1.0 + s * (4.0 - 3.0 * s))
    out[3] = 0.5 * s * s * (s - 1.0)
    return i - 1


@kernel
def _keep_inside(i, size, out):
    """Extrapolate a node beyond either end by a parabola; returns the first node, in 0..size-4."""
    if i < 0:
        ghost = out[0]
        out[0], out[1], out[2] = out[1] + 3.0 * ghost, out[2] - 3.0 * ghost, out[3] + ghost
        out[3] = 0.0
        return 0
    if i > size - 4:
        ghost = out[3]
        out[3], out[2], out[1] = out[2] + 3.0 * ghost, out[1] - 3.0 * ghost, out[0] + ghost
        out[0] = 0.0
        return size - 4
    return i


@kernel
def _node_size(folded):
    """Values of one node: R, G and B with all curves each."""
    return 3 * folded.curves.shape[1]


@kernel
def azimuth_count(folded):
    """Azimuths of a table."""
    return folded.values.shape[2] // _node_size(folded)


@kernel
def azimuth_weights(folded, theta, phi, cosine, out):
    """Weights of four azimuths; returns the row of `fill_latitude` that holds the first."""
    size = azimuth_count(folded)
    if folded.zenith_first == 0.0:
        return _fill_weights(phi / math.pi * (size - 1), size, folded.is_linear, out) + 1
    middle, half = sun_range(folded.source_zenith, folded.zenith_horizon, theta)
    x = dusk_coordinate(middle, half, cosine)
    first = _fill_weights(x * (size - 1), size, folded.is_linear, out)
    return _keep_inside(first, size, out) + 1


@kernel
def _latitude_weights(folded, side, zenith, out):
    """Weights of four latitudes; at a table's edge the missing node is extrapolated."""
    size = folded.values.shape[1]
    if side == 1:
        span = math.pi - folded.zenith_horizon
        x = math.sqrt(max(zenith - folded.zenith_horizon, 0.0) / span)
    else:
        span = folded.zenith_horizon - folded.zenith_first
        x = 1.0 - math.sqrt(max(folded.zenith_horizon - zenith, 0.0) / span)
    first = _fill_weights(x * (size - 1), size, folded.is_linear, out)
    return _keep_inside(first, size, out)


@kernel
def fill_latitude(folded, side, zenith, j_first, j_last, weights, out):
    """Interpolate the table at one zenith angle into rows of `out`, (azimuth + 2) * node size.

    Row j holds azimuth j - 1; the first and the last row mirror the neighbours of the
    sun's meridian, about which the sky is symmetric. At least four rows are filled.
    """
    i = _latitude_weights(folded, side, zenith, weights)
    size, azimuths = _node_size(folded), azimuth_count(folded)
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    begin, end = (max(j_first, 1) - 1) * size, (min(j_last, azimuths + 1) - 1) * size
    at_a, at_b = folded.values[side, i, begin:end], folded.values[side, i + 1, begin:end]
    at_c, at_d = folded.values[side, i + 2, begin:end], folded.values[side, i + 3, begin:end]
    here = out[begin + size : end + size]
    for k in range(here.size):
        here[k] = a * at_a[k] + b * at_b[k] + c * at_c[k] + d * at_d[k]
    if j_first == 0:
        for k in range(size):
            out[k] = out[2 * size + k]
    if j_last == azimuths + 2:
        for k in range(size):
            out[(azimuths + 1) * size + k] = out[(azimuths - 1) * size + k]
