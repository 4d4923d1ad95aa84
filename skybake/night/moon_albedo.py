"""How bright the maria and the highlands of the Moon are."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

from skybake.optics.medium import Array

_TABLE = Path(__file__).parents[1] / "data" / "night" / "moon_albedo.npy"
_STEP = 100.0
_EAST = 100.0
_SOUTH = 90.0


def moon_albedo(longitude: Array, latitude: Array) -> Array:
    """Return the normal albedo over the mean of the disc, see docs/derivations/moon_albedo.py.

    Parameters
    ----------
    longitude, latitude : ndarray of float64, of the same shape
        Selenographic, east positive; beyond 100 deg from the prime meridian, which is never
        seen, the albedo is that of the nearest place. [rad]
    """
    table = _table()
    rows, columns = table.shape
    row = np.clip(np.degrees(latitude) + _SOUTH, 0.0, rows - 1.0)
    column = np.clip(np.degrees(longitude) + _EAST, 0.0, columns - 1.0)
    i = np.minimum(row.astype(np.int64), rows - 2)
    j = np.minimum(column.astype(np.int64), columns - 2)
    u, v = row - i, column - j
    low = (1.0 - v) * table[i, j] + v * table[i, j + 1]
    high = (1.0 - v) * table[i + 1, j] + v * table[i + 1, j + 1]
    albedo: Array = (1.0 - u) * low + u * high
    return albedo


@cache
def _table() -> Array:
    """Albedo by whole degrees of latitude and longitude, from the south and the west."""
    table = np.load(_TABLE, allow_pickle=False) / _STEP
    table.flags.writeable = False
    return np.asarray(table, dtype=float)


def mean_albedo(longitude: float, latitude: float) -> float:
    """Mean over the disc in whose middle a place is, by projected area."""
    ring = np.sqrt((np.arange(_RINGS) + 0.5) / _RINGS)[:, None]
    spoke = 2.0 * math.pi * (np.arange(_SPOKES) + 0.5) / _SPOKES
    x, y = ring * np.cos(spoke), ring * np.sin(spoke)
    z = np.sqrt(1.0 - ring**2) * np.ones_like(x)
    sine, cosine = math.sin(latitude), math.cos(latitude)
    up, out = y * cosine + z * sine, z * cosine - y * sine
    return float(moon_albedo(np.arctan2(x, out) + longitude, np.arcsin(up)).mean())


_RINGS, _SPOKES = 32, 64
