"""Altitudes at which rays are cut into steps, chosen from the atmosphere's profile."""

from __future__ import annotations

import numpy as np

from skybake.optics.medium import Array, Medium, altitude_nodes, vertical_columns

SHELL_COUNT = 49
"""Shells of a ray that is looked along; 48 layers keep single scattering within 0.05 %."""


def altitude_shells(medium: Medium, count: int = SHELL_COUNT) -> Array:
    """Altitudes that divide the atmosphere into layers of like importance.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    count : int
        Number of altitudes, at least 2.

    Returns
    -------
    ndarray of float64, shape (count,)
        Ascending from 0 to the top of the atmosphere. [km]

    Notes
    -----
    Layers share out equally the sum of two measures: how much each
    constituent's density varies, which finds haze, ozone and cloud layers, and
    the logarithm of altitude, which keeps thin layers aloft that deep twilight
    comes from.
    """
    altitude = altitude_nodes(medium.r_bottom, medium.r_top)
    peak = np.maximum(medium.density.max(axis=0), 1e-300)
    variation = np.abs(np.diff(medium.density / peak, axis=0)).sum(axis=1)
    variation /= variation.sum() or 1.0
    thinnest = _smallest_scale_height(medium, altitude)
    spread = np.diff(np.log1p(altitude / thinnest))
    spread /= spread.sum()
    measure = np.concatenate([[0.0], np.cumsum(variation + 2.0 * spread)])
    return np.interp(np.linspace(0.0, measure[-1], count), measure, altitude)


def _smallest_scale_height(medium: Medium, altitude: Array) -> float:
    """Column over peak density of the constituent that is most confined. [km]"""
    column = vertical_columns(medium)
    peak = medium.density.max(axis=0)
    present = peak > 0.0
    if not present.any():
        return float(altitude[-1])
    return float((column[present] / peak[present]).min())
