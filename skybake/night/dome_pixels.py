"""Evaluation of the night's table at the pixels of a map."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel


@kernel
def fill_dome(table, above, zenith_horizon, zenith, azimuth, footprint, first, last, spare, out):
    """Add light of a table to the rows first..last of pixels.

    Parameters
    ----------
    table : ndarray of float32, shape (row, bearing, 3)
        Light at the zenith angles of `skybake.night.air.row_zeniths`.
    above : int
        Rows above the horizon.
    zenith_horizon : float
        [rad]
    zenith, azimuth, footprint : ndarray of float64, each (row or 1, column or 1)
        Zenith angles and bearings, and extents in zenith angle over which the horizon is
        smoothed. [rad]
    first, last : int
        Rows of the pixels.
    spare : ndarray of float32, shape (bearing + 1, 3)
        Work space.
    out : ndarray of float32, shape (last - first, column, 3)
        Is added to.
    """
    if zenith.shape[1] == 1 and footprint.shape[1] == 1 and azimuth.shape[0] == 1:
        for i in range(first, last):
            theta = zenith[min(i, zenith.shape[0] - 1), 0]
            extent = footprint[min(i, footprint.shape[0] - 1), 0]
            spare[:] = 0.0
            for j in range(spare.shape[0]):
                node = j if j < table.shape[1] else 0
                _add_node(
                    table, above, zenith_horizon, theta, extent, node, np.float32(1.0), spare[j]
                )
            _add_ring(spare, azimuth[0], out[i - first])
        return
    for i in range(first, last):
        for j in range(out.shape[1]):
            theta = _at(zenith, i, j)
            extent = _at(footprint, i, j)
            before, u = _place(_at(azimuth, i, j), table.shape[1])
            after = before + 1 if before + 1 < table.shape[1] else 0
            rest = np.float32(1.0) - u
            here = out[i - first, j]
            _add_node(table, above, zenith_horizon, theta, extent, before, rest, here)
            _add_node(table, above, zenith_horizon, theta, extent, after, u, here)


@kernel
def _at(angle, i, j):
    """Element of an array whose rows or columns may all be alike."""
    return angle[min(i, angle.shape[0] - 1), min(j, angle.shape[1] - 1)]


@kernel
def _place(bearing, size):
    """Node before a bearing, and the share of the next one."""
    turns = bearing / (2.0 * math.pi)
    across = (turns - math.floor(turns)) * size
    before = min(int(across), size - 1)
    return before, np.float32(across - before)


@kernel
def _add_ring(ring, azimuth, out):
    """Add a ring of the table, which ends where it begins, to pixels at bearings."""
    for j in range(out.shape[0]):
        before, u = _place(azimuth[j], ring.shape[0] - 1)
        for c in range(3):
            out[j, c] += ring[before, c] + u * (ring[before + 1, c] - ring[before, c])


@kernel
def _add_node(table, above, zenith_horizon, theta, extent, bearing, share, out):
    """Add `share` of the light at a zenith angle and a node of bearing, shape (3,)."""
    over = (zenith_horizon - theta) / max(extent, 1e-12) + 0.5
    over = min(max(over, 0.0), 1.0)
    if over > 0.0:
        x = 1.0 - math.sqrt(max(1.0 - min(theta, zenith_horizon) / zenith_horizon, 0.0))
        _add_rows(table, 0, above, x, bearing, share * np.float32(over), out)
    if over < 1.0:
        depth = max(theta - zenith_horizon, 0.0) / (math.pi - zenith_horizon)
        x = math.sqrt(min(depth, 1.0))
        rest = share * np.float32(1.0 - over)
        _add_rows(table, above, table.shape[0], x, bearing, rest, out)


@kernel
def _add_rows(table, begin, end, x, bearing, share, out):
    """Add `share` of the light between rows, x from 0 to 1 of begin..end."""
    y = x * (end - begin - 1)
    i = min(int(y), end - begin - 2)
    v = np.float32(y - i)
    for c in range(3):
        upper, lower = table[begin + i, bearing, c], table[begin + i + 1, bearing, c]
        out[c] += share * (upper + v * (lower - upper))
