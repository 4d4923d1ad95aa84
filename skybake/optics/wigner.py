"""Generalised spherical functions, in which Stokes vectors and scattering matrices are series.

J. W. Hovenier, C. van der Mee and H. Domke, "Transfer of Polarized Light in Planetary
Atmospheres", 2004, appendix B.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


def wigner(m: int, spin: int, order: int, mu: Array) -> Array:
    """Functions (-1)^m d^l_{m, spin} of the cosines `mu` for l = 0 to `order`.

    Parameters
    ----------
    m : int
        Azimuthal order, at least 0.
    spin : int
        -2, 0 or 2; with 0 they are Legendre's associated functions, positive at small angles.
    order : int
        Highest l.
    mu : ndarray, shape (...)

    Returns
    -------
    ndarray of float64, shape (order + 1, ...)
        0 where l is less than m or 2.
    """
    values = np.zeros((order + 1, *np.shape(mu)))
    least = max(m, abs(spin))
    if least > order:
        return values
    values[least] = _first(m, spin, mu)
    product = m * spin
    for degree in range(least, order):
        ahead = math.sqrt(((degree + 1) ** 2 - m**2) * ((degree + 1) ** 2 - spin**2))
        if degree == 0:
            values[1] = mu
            continue
        behind = math.sqrt((degree**2 - m**2) * (degree**2 - spin**2))
        here = (2 * degree + 1) * (degree * (degree + 1) * mu - product) * values[degree]
        values[degree + 1] = (here - (degree + 1) * behind * values[degree - 1]) / (degree * ahead)
    return values


def _first(m: int, spin: int, mu: Array) -> Array:
    """Return the function of the least l."""
    cosine, sine = np.sqrt(0.5 * (1.0 + mu)), np.sqrt(np.maximum(0.5 * (1.0 - mu), 0.0))
    if m >= abs(spin):
        size = math.sqrt(math.comb(2 * m, m - spin))
        first: Array = size * cosine ** (m + spin) * sine ** (m - spin)
        return first
    # The function is that of the indices exchanged, but for its sign.
    sign = -1.0 if m == 1 and spin > 0 else 1.0
    size = sign * math.sqrt(math.comb(4, 2 - m))
    power = m if spin > 0 else -m
    exchanged: Array = size * cosine ** (2 + power) * sine ** (2 - power)
    return exchanged
