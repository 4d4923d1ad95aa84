"""Unit vectors of directions, and the cosine of the angle between two.

The world is right-handed with +Y up and -Z north. An azimuth is a compass bearing: 0 = north,
clockwise as seen from above, 90 deg = east = +X.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def direction_from_angles(azimuth: npt.ArrayLike, elevation: npt.ArrayLike) -> Array:
    """Return unit vectors.

    Parameters
    ----------
    azimuth, elevation : array_like, broadcast to shape (...)
        [rad]

    Returns
    -------
    ndarray of float64, shape (..., 3)
    """
    azimuth, elevation = np.broadcast_arrays(azimuth, elevation)
    horizontal = np.cos(elevation)
    return np.stack(
        [horizontal * np.sin(azimuth), np.sin(elevation), -horizontal * np.cos(azimuth)], axis=-1
    )


def zenith_azimuth(directions: Array) -> tuple[Array, Array]:
    """Zenith angles and azimuths, in [-pi, pi], of vectors of any length.

    Parameters
    ----------
    directions : ndarray of float64, shape (..., 3)

    Returns
    -------
    zenith, azimuth : ndarray of float64, shape (...)
        [rad]
    """
    x, y, z = np.moveaxis(directions, -1, 0)
    return np.arctan2(np.hypot(x, z), y), np.arctan2(x, -z)


def cosine_between(
    mu: npt.ArrayLike,
    sine: npt.ArrayLike,
    mu_s: npt.ArrayLike,
    sine_s: npt.ArrayLike,
    azimuth: npt.ArrayLike,
) -> Array:
    """Cosine nu of the angle between two directions.

    Parameters
    ----------
    mu, sine : array_like
        Cosine and sine of the zenith angle of one. Both are needed since neither gives the
        other to full precision everywhere.
    mu_s, sine_s : array_like
        The same of the other, such as the sun.
    azimuth : array_like
        Between the two. [rad]

    Returns
    -------
    ndarray of float64
        Of the shape that all broadcast to; rounding may take it just beyond [-1, 1].
    """
    nu: Array = np.multiply(mu, mu_s) + np.multiply(sine, sine_s) * np.cos(azimuth)
    return nu
