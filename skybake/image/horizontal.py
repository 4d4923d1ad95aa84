"""What the sky throws on a horizontal plane."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np

from skybake.optics.medium import Array

ZENITHS = 192
AZIMUTHS = 256
UNEVEN_AZIMUTHS = 128


def horizontal_irradiance(
    evaluate: Callable[[Array, Array, float], np.ndarray], *, is_even: bool
) -> Array:
    """Integrate light from above over the cosine of its zenith angle.

    Parameters
    ----------
    evaluate : callable
        Takes zenith angles (row, 1), azimuths from the sun (1, column) and a footprint, all in
        radians, and returns light, shape (row, column, channel).
    is_even : bool
        Whether both sides of the sun are alike.

    Returns
    -------
    ndarray of float64, shape (channel,)
        In the unit of the light, times steradian.
    """
    zenith, weight = _zeniths()
    count, around = (AZIMUTHS, math.pi) if is_even else (UNEVEN_AZIMUTHS, 2.0 * math.pi)
    azimuth = around * (np.arange(count) + 0.5) / count
    light = evaluate(zenith[:, None], azimuth[None], 1e-9)
    flux: Array = 2.0 * math.pi * weight @ light.astype(float).mean(axis=1)
    return flux


@cache
def _zeniths() -> tuple[Array, Array]:
    """Zenith angles of the upper hemisphere and their weights, which take longer than a frame."""
    node, weight = np.polynomial.legendre.leggauss(ZENITHS)
    zenith = math.pi / 4.0 * (node + 1.0)
    return zenith, math.pi / 4.0 * weight * np.sin(zenith) * np.cos(zenith)
