"""Interpolation in a sky's table, with cubics between its nodes."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.sky.view import dusk_coordinate, sun_range


@kernel
def _cubic(x, size, out):
    """Catmull-Rom weights of four nodes around `x`; returns the first, which may be -1."""
    i = min(max(int(x), 0), size - 2)
    s = min(max(x - i, 0.0), 1.0)
    out[0] = 0.5 * s * (-1.0 + s * (2.0 - s))
    out[1] = 1.0 + 0.5 * s * s * (3.0 * s - 5.0)
    out[2] = 0.5 * s * (1.0 + s * (4.0 - 3.0 * s))
    out[3] = 0.5 * s * s * (s - 1.0)
    return i - 1


@kernel
def _keep_inside(i, size, out):
    """Let a parabola stand for the node beyond either end; returns the first node, in 0..size-4."""
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
def _channels(view):
    """R, G and B with all lobes each."""
    return 3 * view.curves.shape[1]


@kernel
def azimuth_count(view):
    """Azimuths of a view's table."""
    return view.table.shape[2] // _channels(view)


@kernel
def azimuth_weights(view, theta, phi, cosine, out):
    """Weights of four azimuths; returns the row of `fill_latitude` that holds the first."""
    size = azimuth_count(view)
    if view.zenith_first == 0.0:
        return _cubic(phi / math.pi * (size - 1), size, out) + 1
    middle, half = sun_range(view.sun_zenith, view.zenith_horizon, theta)
    x = dusk_coordinate(middle, half, cosine)
    return _keep_inside(_cubic(x * (size - 1), size, out), size, out) + 1


@kernel
def _latitude_weights(view, side, zenith, out):
    """Weights of four latitudes; at a table's edge the missing node is extrapolated."""
    size = view.table.shape[1]
    if side == 1:
        span = math.pi - view.zenith_horizon
        x = math.sqrt(max(zenith - view.zenith_horizon, 0.0) / span)
    else:
        span = view.zenith_horizon - view.zenith_first
        x = 1.0 - math.sqrt(max(view.zenith_horizon - zenith, 0.0) / span)
    return _keep_inside(_cubic(x * (size - 1), size, out), size, out)


@kernel
def fill_latitude(view, side, zenith, j_first, j_last, weights, out):
    """Interpolate the table at one zenith angle into rows of `out`, (azimuth + 2) * channel.

    Row j holds azimuth j - 1; the first and the last row mirror the neighbours of the
    sun's meridian, about which the sky is symmetric. At least four rows are filled.
    """
    i = _latitude_weights(view, side, zenith, weights)
    channels, azimuths = _channels(view), azimuth_count(view)
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    begin, end = (max(j_first, 1) - 1) * channels, (min(j_last, azimuths + 1) - 1) * channels
    at_a, at_b = view.table[side, i, begin:end], view.table[side, i + 1, begin:end]
    at_c, at_d = view.table[side, i + 2, begin:end], view.table[side, i + 3, begin:end]
    here = out[begin + channels : end + channels]
    for k in range(here.size):
        here[k] = a * at_a[k] + b * at_b[k] + c * at_c[k] + d * at_d[k]
    if j_first == 0:
        for k in range(channels):
            out[k] = out[2 * channels + k]
    if j_last == azimuths + 2:
        for k in range(channels):
            out[(azimuths + 1) * channels + k] = out[(azimuths - 1) * channels + k]
