"""Zodiacal light: sunlight that the dust between the planets scatters."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np

from skybake.optics.medium import Array

_TABLE = Path(__file__).parents[1] / "data" / "night" / "zodiacal_light.csv"
_FIRST_ROW = 3

UNIT = 1e-11
"""Of the table. [W m⁻² sr⁻¹ nm⁻¹]"""

REFERENCE = 500.0
"""Wavelength of the table. [nm]"""

FALL = 2.3
"""Power of the distance from the sun with which it fades (Leinert et al. 1998, section 8.2)."""

INNER = 15.0
"""Distance from the sun within which the table is continued by a power. [deg]"""

INNER_FALL = 2.5
"""The power of elongation, as of the sun's F corona."""


def zodiacal_light(longitude: Array, latitude: Array, *, has_corona: bool = True) -> Array:
    """Radiance at 500 nm as seen from 1 au.

    Parameters
    ----------
    longitude, latitude : ndarray of float64
        Ecliptic, the former from the sun. [rad]
    has_corona : bool, optional
        Whether it grows within `INNER` too.

    Returns
    -------
    ndarray of float64
        [W m⁻² sr⁻¹ nm⁻¹]

    Notes
    -----
    Leinert et al. (1998), table 17, interpolated in its logarithm.
    """
    longitudes, latitudes, logarithms = _table()
    x = np.degrees(np.abs(np.mod(longitude + math.pi, 2.0 * math.pi) - math.pi))
    y = np.degrees(np.abs(latitude))
    elongation = np.degrees(np.arccos(np.cos(np.radians(x)) * np.cos(np.radians(y))))
    # Within the gap of the table, its edge in the same direction.
    stretch = np.maximum(INNER / np.maximum(elongation, 0.3), 1.0)
    x, y = x * stretch, y * stretch
    i, u = _interval(longitudes, x)
    j, v = _interval(latitudes, y)
    low = (1.0 - v) * logarithms[i, j] + v * logarithms[i, j + 1]
    high = (1.0 - v) * logarithms[i + 1, j] + v * logarithms[i + 1, j + 1]
    light: Array = UNIT * np.exp((1.0 - u) * low + u * high)
    return light * stretch**INNER_FALL if has_corona else light


def zodiacal_colours(wavelengths: Array) -> Array:
    """Factors of the sun's spectrum, 1 at 500 nm, near the sun and far from it, (2, wavelength).

    Leinert et al. (1998), equation 22: up to 30 deg of elongation, and from 90 deg on; it is
    linear between.
    """
    logarithm = np.log10(wavelengths / REFERENCE)
    is_blue = wavelengths < REFERENCE
    near = 1.0 + np.where(is_blue, 1.2, 0.8) * logarithm
    far = 1.0 + np.where(is_blue, 0.9, 0.6) * logarithm
    return np.stack([near, far])


def far_share(longitude: Array, latitude: Array) -> Array:
    """How much of the colour is that far from the sun, from 0 to 1."""
    elongation = np.degrees(np.arccos(np.cos(longitude) * np.cos(latitude)))
    share: Array = np.clip((elongation - 30.0) / 60.0, 0.0, 1.0)
    return share


def _interval(nodes: Array, at: Array) -> tuple[np.ndarray, Array]:
    first = np.clip(np.searchsorted(nodes, at, side="right") - 1, 0, len(nodes) - 2)
    share = (at - nodes[first]) / (nodes[first + 1] - nodes[first])
    return first, np.clip(share, 0.0, 1.0)


@cache
def _table() -> tuple[Array, Array, Array]:
    """Longitudes and latitudes [deg], and logarithms of the radiance in `UNIT`."""
    lines = _TABLE.read_text(encoding="utf-8").splitlines()[_FIRST_ROW - 1 :]
    latitudes = np.array(lines[0].split(",")[1:], float)
    rows = [[float(cell or "nan") for cell in line.split(",")] for line in lines[1:]]
    table = np.array(rows)
    longitudes, light = table[:, 0], np.log(table[:, 1:])
    # Beside the gap, where the interpolation reaches into it, the nearest value of the row.
    for row in light:
        known = np.flatnonzero(np.isfinite(row))
        row[: known[0]] = row[known[0]]
    return longitudes, latitudes, light
