"""Heights of the sun over the clouds that an observer sees."""

from __future__ import annotations

import math

import numpy as np

from skybake.clouds.air import GROUNDED
from skybake.clouds.directions import sun_vector
from skybake.optics.medium import Array

HIGH_SUN, NEAR = math.radians(12.0), math.radians(5.0)
"""Elevation from which the sun is the same over all clouds of a layer, unless they are seen over
more than this angle at the planet's centre. [rad]"""

SUNS = tuple(math.radians(each) for each in (-18, -9, -5, -2, 0, 2, 5, 12, 30, 60))
"""Elevations of suns between which light is interpolated. [rad]"""

CLOSE = math.radians(0.8)


def suns_over(sun: Array, radius: float, altitude: float, top: float) -> Array:
    """Return suns over the places at which an observer sees a layer, in the order of their height.

    Parameters
    ----------
    sun : ndarray of float64, shape (3,)
        Toward the sun: x east, y north, z up at the observer; 0 where there is none.
    radius, altitude, top : float
        Of the ground; of the observer and of the highest clouds above it. [km]

    Returns
    -------
    ndarray of float64, shape (sun, 3)
        Where clouds are far away the sun stands higher or lower by their angle at the planet's
        centre, which counts while it is low.
    """
    if not sun.any():
        return sun[None]
    elevation = math.asin(float(np.clip(sun[2], -1.0, 1.0)))
    away = sum(math.acos(radius / (radius + max(h, GROUNDED))) for h in (top, altitude))
    low, high = max(elevation - away, -0.5 * math.pi), min(elevation + away, 0.5 * math.pi)
    if low > HIGH_SUN and away < NEAR:
        return sun[None]
    azimuth = math.atan2(sun[0], sun[1])
    # The observer's own, over the clouds that are seen best: light grows too fast with the sun's
    # height to be found between others.
    others = (low, high, *(each for each in SUNS if low + CLOSE < each < high - CLOSE))
    apart = [each for each in others if abs(each - elevation) > (CLOSE if each in SUNS else 1e-3)]
    return np.stack([sun_vector(azimuth, each) for each in sorted({elevation, *apart})])
