"""Evaluation of the night's table at the pixels of a map."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel


@kernel
def fill_dome(table, above, zenith_horizon, zenith, azimuth, footprint, first, last, out):
    """Add light of a table to the rows first..last of pixels.

    Parameters
    ----------
    table : ndarray of float32, shape (row, bearing, 3)
        As of `skybake.night.dome.NightDome`.
    above : int
        Rows above the horizon.
    zenith_horizon : float
        [rad]
    zenith, azimuth, footprint : ndarray of float64, each (row or 1, column or 1)
        Zenith angles and bearings, and extents in zenith angle over which the horizon is
        smoothed. [rad]
    first, last : int
        Rows of the pixels.
    out : ndarray of float32, shape (last - first, column, 3)
        Is added to.
    """
    for i in range(first, last):
        for j in range(out.shape[1]):
            theta = zenith[i if zenith.shape[0] > 1 else 0, j if zenith.shape[1] > 1 else 0]
            around = azimuth[i if azimuth.shape[0] > 1 else 0, j if azimuth.shape[1] > 1 else 0]
            extent = footprint[
                i if footprint.shape[0] > 1 else 0, j if footprint.shape[1] > 1 else 0
            ]
            over = (zenith_horizon - theta) / max(extent, 1e-12) + 0.5
            over = min(max(over, 0.0), 1.0)
            if over > 0.0:
                x = 1.0 - math.sqrt(max(1.0 - min(theta, zenith_horizon) / zenith_horizon, 0.0))
                _add_place(table, 0, above, x, around, over, out[i - first, j])
            if over < 1.0:
                depth = max(theta - zenith_horizon, 0.0) / (math.pi - zenith_horizon)
                x = math.sqrt(min(depth, 1.0))
                _add_place(table, above, table.shape[0], x, around, 1.0 - over, out[i - first, j])


@kernel
def _add_place(table, begin, end, x, around, share, out):
    """Add `share` of the light at a place between rows, x from 0 to 1, and between bearings."""
    y = x * (end - begin - 1)
    i = min(int(y), end - begin - 2)
    v = y - i
    turns = around / (2.0 * math.pi)
    across = (turns - math.floor(turns)) * table.shape[1]
    j = min(int(across), table.shape[1] - 1)
    u = across - j
    after = j + 1 if j + 1 < table.shape[1] else 0
    for c in range(3):
        upper = (1.0 - u) * table[begin + i, j, c] + u * table[begin + i, after, c]
        lower = (1.0 - u) * table[begin + i + 1, j, c] + u * table[begin + i + 1, after, c]
        out[c] += np.float32(share * ((1.0 - v) * upper + v * lower))
