"""Optical columns toward the sun, from which transmittance follows at any wavelength.

Columns are the integral of each constituent's relative density. Unlike
transmittance they do not depend on wavelength, so one table serves all of
them, and a lookup costs one exponential per wavelength.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.medium import Medium
from skybake.transport.density import fill_column
from skybake.transport.exponential import fast_exp
from skybake.transport.geometry import distance_to_exit

SHAPE = (256, 256)
BUILD_STEPS = 48


@kernel
def altitude_mu_from_unit(r_bottom, r_top, x_altitude, x_mu):
    """Altitude [km] and cosine of the zenith angle of a place in the table's unit square."""
    return x_altitude * x_altitude * (r_top - r_bottom), x_mu * x_mu


@kernel
def unit_from_altitude_mu(r_bottom, r_top, h, mu):
    """Inverse of `altitude_mu_from_unit`, for upward directions (mu >= 0)."""
    return math.sqrt(min(max(h / (r_top - r_bottom), 0.0), 1.0)), math.sqrt(min(max(mu, 0.0), 1.0))


@kernel
def _fill_columns(medium, steps, first, last, scratch, out):
    for i in range(first, last):
        for j in range(out.shape[1]):
            h, mu = altitude_mu_from_unit(
                medium.r_bottom, medium.r_top, i / (out.shape[0] - 1), j / (out.shape[1] - 1)
            )
            r = medium.r_bottom + h
            length = distance_to_exit(r, mu, medium.r_top)
            fill_column(medium, r, mu, length, steps, scratch, out[i, j])


def build_columns(
    medium: Medium,
    *,
    shape: tuple[int, int] = SHAPE,
    steps: int = BUILD_STEPS,
    workers: Workers = ALL_CPUS,
) -> npt.NDArray[np.float64]:
    """Tabulate the columns from a point to the top of the atmosphere.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    shape : (int, int)
        Nodes in altitude and in the cosine of the zenith angle, which covers
        the horizontal to the zenith.
    steps : int
        Gauss-Legendre steps of each column.
    workers : Workers, optional
        Threads that do the work.

    Returns
    -------
    ndarray of float64, shape (altitude, mu, constituent)
        Column of relative density. [km]
    """
    constituents = medium.extinction.shape[0]
    out = np.empty((*shape, constituents))

    def work(first: int, last: int) -> None:
        _fill_columns(medium, steps, first, last, np.empty(constituents), out)

    workers.run_rows(shape[0], work, chunk=8)
    return out


@kernel
def _add_upward(columns, r_bottom, r_top, h, mu, factor, out):
    """Add `factor` times the interpolated column toward an upward direction to `out`."""
    x_altitude, x_mu = unit_from_altitude_mu(r_bottom, r_top, h, mu)
    x_altitude *= columns.shape[0] - 1
    x_mu *= columns.shape[1] - 1
    i = min(int(x_altitude), columns.shape[0] - 2)
    j = min(int(x_mu), columns.shape[1] - 2)
    u = x_altitude - i
    v = x_mu - j
    for c in range(out.size):
        low = columns[i, j, c] + v * (columns[i, j + 1, c] - columns[i, j, c])
        high = columns[i + 1, j, c] + v * (columns[i + 1, j + 1, c] - columns[i + 1, j, c])
        out[c] += factor * (low + u * (high - low))


@kernel
def fill_sun_column(columns, r_bottom, r_top, r, mu_s, out):
    """Write the columns from a point toward the sun to `out`.

    Parameters
    ----------
    columns : ndarray
        Table of `build_columns`.
    r_bottom, r_top : float
        Radii of the ground and of the top of the atmosphere. [km]
    r, mu_s : float
        Radius of the point, at most `r_top` [km], and cosine of the sun's zenith
        angle there; rounding may take it beyond -1.
    out : ndarray of float64, shape (constituent,)
        Receives the columns. [km]

    Returns
    -------
    bool
        False if the planet blocks the sun; `out` is then left at 0.

    Notes
    -----
    A sun below the horizontal shines along a chord whose closest point to the
    planet has radius r_t; by symmetry the column is twice the one from r_t
    outward, less the one from the point away from the sun.
    """
    for c in range(out.size):
        out[c] = 0.0
    if mu_s < 0.0:
        h_closest = r * math.sqrt(max(1.0 - mu_s * mu_s, 0.0)) - r_bottom
        if h_closest < 0.0:
            return False
        _add_upward(columns, r_bottom, r_top, h_closest, 0.0, 2.0, out)
    sign = 1.0 if mu_s >= 0.0 else -1.0
    _add_upward(columns, r_bottom, r_top, r - r_bottom, sign * mu_s, sign, out)
    return True


@kernel
def fill_transmittance(extinction, column, out):
    """Write exp(-optical depth) of a column to `out`, shape (wavelength,)."""
    for k in range(out.size):
        out[k] = 0.0
    for c in range(column.size):
        for k in range(out.size):
            out[k] -= extinction[c, k] * column[c]
    for k in range(out.size):
        out[k] = fast_exp(out[k])
