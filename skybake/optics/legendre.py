"""Phase functions as Legendre series.

A phase function is sum_l (2l+1)/(4 pi) chi_l P_l(nu), with chi_0 = 1 and chi_1
the mean cosine.
"""

from __future__ import annotations

import numpy as np

from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase, scattering_angles


def legendre_moments(phase: Array, order: int) -> Array:
    """Moments chi_l of tabulated phase functions.

    Parameters
    ----------
    phase : ndarray of float64, shape (constituent, SCATTERING_ANGLES, wavelength)
        [sr⁻¹]
    order : int
        Highest l.

    Returns
    -------
    ndarray of float64, shape (constituent, order + 1, wavelength)
        chi_l, normalised to chi_0 = 1.
    """
    theta = scattering_angles()
    step = np.diff(theta)
    offset = 0.5 / np.sqrt(3.0)
    nodes = np.concatenate([theta[:-1] + (0.5 - offset) * step, theta[:-1] + (0.5 + offset) * step])
    weight = 2.0 * np.pi * np.concatenate([step, step]) / 2.0 * np.sin(nodes)
    values = eval_phase(phase, np.cos(nodes)) * weight[:, None, None]
    moments = np.tensordot(legendre_polynomials(np.cos(nodes), order), values, axes=1)
    return np.ascontiguousarray((moments / moments[0]).transpose(1, 0, 2))


def legendre_polynomials(nu: Array, order: int) -> Array:
    """Legendre polynomials P_0 to P_order, shape (order + 1, nu)."""
    values = np.ones((order + 1, nu.size))
    if order:
        values[1] = nu
    for degree in range(1, order):
        values[degree + 1] = (
            (2 * degree + 1) * nu * values[degree] - degree * values[degree - 1]
        ) / (degree + 1)
    return values


def sum_series(polynomials: Array, moments: Array) -> Array:
    """Sum of (2l+1)/(4 pi) chi_l P_l.

    Parameters
    ----------
    polynomials : ndarray of float64, shape (order + 1, angle)
        Result of `legendre_polynomials`.
    moments : ndarray of float64, shape (order + 1, wavelength)
        chi_l.

    Returns
    -------
    ndarray of float64, shape (angle, wavelength)
        [sr⁻¹]
    """
    degree = np.arange(polynomials.shape[0])
    weighted = (2 * degree + 1)[:, None] / (4.0 * np.pi) * moments
    total: Array = polynomials.T @ weighted
    return total
