"""Density against altitude."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.preset import ExponentialProfile, Profile, TentProfile

Array = npt.NDArray[np.float64]


def eval_profile(profile: Profile, altitude: Array) -> Array:
    """Relative density at altitudes.

    Parameters
    ----------
    profile : Profile
        Of one constituent.
    altitude : ndarray
        [km]

    Returns
    -------
    ndarray of float64, shape of `altitude`
        1 at the ground for an exponential and at the centre for a tent.
    """
    if isinstance(profile, ExponentialProfile):
        return np.exp(-altitude / profile.scale_height)
    if isinstance(profile, TentProfile):
        return np.maximum(0.0, 1.0 - np.abs(altitude - profile.center) / profile.half_width)
    nodes = np.array(profile.altitude)
    density = np.array(profile.density)
    linear = np.interp(altitude, nodes, density, left=0.0, right=0.0)
    with np.errstate(divide="ignore"):
        logarithm = np.log(density)
    right = np.clip(np.searchsorted(nodes, altitude), 1, len(nodes) - 1)
    smooth = (density[right] > 0.0) & (density[right - 1] > 0.0) & (linear > 0.0)
    fraction = (altitude - nodes[right - 1]) / (nodes[right] - nodes[right - 1])
    result: Array = linear.copy()
    lower, upper = logarithm[right - 1][smooth], logarithm[right][smooth]
    result[smooth] = np.exp(lower + fraction[smooth] * (upper - lower))
    return result
