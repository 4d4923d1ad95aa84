"""Directions around an observer: unit vectors, and grids of them on both sides of the horizon."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array

EDGE = 1e-5
"""Angle by which nodes stay away from the horizon. [rad]"""


def unit_vectors(zenith: Array, bearing: Array) -> Array:
    """Return unit vectors of directions, shape (..., 3): x east, y north, z up.

    Angles are broadcast against each other.
    """
    out = np.empty((*np.broadcast_shapes(np.shape(zenith), np.shape(bearing)), 3))
    sine = np.sin(zenith)
    out[..., 0], out[..., 1] = sine * np.sin(bearing), sine * np.cos(bearing)
    out[..., 2] = np.cos(zenith)
    return out


def sun_vector(azimuth: float, elevation: float) -> Array:
    """Return the unit vector toward a compass bearing and an elevation: x east, y north, z up."""
    flat = math.cos(elevation)
    return np.array([flat * math.sin(azimuth), flat * math.cos(azimuth), math.sin(elevation)])


def node_directions(
    first: float, horizon: float, rows: int, columns: int, *, is_half: bool
) -> tuple[Array, Array]:
    """Return zenith angles and azimuths of the nodes of `fill_places`, each of shape (node,).

    Rows crowd quadratically toward the horizon from both sides, as those of a sky's table do.
    """
    x = np.linspace(0.0, 1.0, rows)
    above = np.minimum(horizon - (horizon - first) * (1.0 - x) ** 2, horizon - EDGE)
    below = np.maximum(horizon + (math.pi - horizon) * x**2, horizon + EDGE)
    zenith = np.concatenate([above, below])
    around = (
        np.linspace(0.0, math.pi, columns)
        if is_half
        else 2.0 * math.pi * np.arange(columns) / columns
    )
    zenith, azimuth = np.meshgrid(zenith, around, indexing="ij")
    return zenith.ravel(), azimuth.ravel()


@kernel
def fill_places(zenith, azimuth, first, horizon, rows, columns, is_half, row, weight):
    """Write between which nodes of a grid of directions each direction is, and their weights.

    Parameters
    ----------
    zenith, azimuth : ndarray of float64, shape (n,)
        Directions; azimuths from the grid's first column. [rad]
    first, horizon : float
        Zenith angles at which air and ground begin. [rad]
    rows, columns : int
        Of the grid, above the horizon and below it each.
    is_half : bool
        Whether columns go from 0 to pi, both included, or all around.
    row : ndarray of int64, shape (n, 4)
        Receives nodes, counted by side, row and column.
    weight : ndarray of float64, shape (n, 4)
        Receives their weights.
    """
    for n in range(zenith.size):
        side = 0 if zenith[n] <= horizon else 1
        if side == 0:
            x = 1.0 - math.sqrt(max(horizon - zenith[n], 0.0) / (horizon - first))
        else:
            x = math.sqrt((zenith[n] - horizon) / (math.pi - horizon))
        x = min(max(x, 0.0), 1.0) * (rows - 1)
        i = min(int(x), rows - 2)
        u = x - i
        phi = azimuth[n] - 2.0 * math.pi * math.floor(azimuth[n] / (2.0 * math.pi))
        if is_half:
            y = min(phi, 2.0 * math.pi - phi) / math.pi * (columns - 1)
            j = min(int(y), columns - 2)
            east = j + 1
        else:
            y = phi / (2.0 * math.pi) * columns
            j = min(int(y), columns - 1)
            east = (j + 1) % columns
        v = y - j
        at = (side * rows + i) * columns
        row[n, 0], row[n, 1] = at + j, at + east
        row[n, 2], row[n, 3] = at + columns + j, at + columns + east
        weight[n, 0], weight[n, 1] = (1.0 - u) * (1.0 - v), (1.0 - u) * v
        weight[n, 2], weight[n, 3] = u * (1.0 - v), u * v
