"""Delta-M scaling: a medium without the forward peaks of its phase functions.

A table of the diffuse field holds Legendre orders up to L; what a phase function
has beyond them is a narrow forward peak, which the delta-M method (Wiscombe 1977)
treats as light that was not scattered at all.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.legendre import legendre_moments, legendre_polynomials, sum_series
from skybake.optics.matrix import ELEMENTS, matrix_moments
from skybake.optics.medium import (
    Array,
    Medium,
    altitude_nodes,
    pad_wavelengths,
    vertical_columns,
)
from skybake.optics.phase import scattering_angles

SERIES_ORDER = 400
"""Order up to which peaks are resolved; a lobe of 0.5 deg needs about as many."""

PEAK_NODES = np.array([0.0, 0.12, 0.26, 0.42, 0.58, 0.74, 0.88, 1.0])
"""Nodes of 1 - exp(-f y), y the depth of peak scattering between sun and sample."""

PEAKED = 2e-3
"""Share of light in the peak from which a constituent is truncated."""


class ScaledMedium(NamedTuple):
    """A medium without forward peaks, and what restores them on the final ray.

    Attributes
    ----------
    medium : Medium
        Scattering and extinction less the peaks' share; its phase functions are
        the truncated series, which may be negative.
    moments : ndarray of float64, shape (constituent, order + 1, wavelength)
        chi_l of the truncated phase functions.
    peaked : ndarray of int64, shape (peak,)
        Constituents that were truncated.
    fraction : ndarray of float64, shape (constituent, wavelength)
        Share f of the scattered light that is in the peak.
    scattering : ndarray of float64, shape (constituent, wavelength)
        Scattering coefficients before truncation, 0 where there is no peak. [km⁻¹]
    mixture : ndarray of float64, shape (wavelength,)
        Mean f of the peaked constituents, weighted by their scattering columns.
    phase : ndarray of float64, shape (phase function, SCATTERING_ANGLES, wavelength)
        Phase functions that a ray's light is kept apart by: each constituent's, then
        for each peaked one the functions at `PEAK_NODES`. [sr⁻¹]
    matrix_moments : ndarray of float64, shape (constituent, 3, order + 1, wavelength)
        Of the truncated scattering matrices, see `skybake.optics.matrix`; of no constituent where
        light is not polarised.
    """

    medium: Medium
    moments: Array
    peaked: npt.NDArray[np.int64]
    fraction: Array
    scattering: Array
    mixture: Array
    phase: Array
    matrix_moments: Array


def scale_medium(medium: Medium, order: int) -> ScaledMedium:
    """Move forward peaks beyond a Legendre order from scattering to transmission.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    order : int
        Highest order L that stays.

    Returns
    -------
    ScaledMedium
        With f = chi_{L+1}, so that the series of a truncated function ends where
        it vanishes.

    References
    ----------
    W. J. Wiscombe, "The Delta-M Method", J. Atmos. Sci. 34, 1977, equations 8-18.
    T. Nakajima and M. Tanaka, J. Quant. Spectrosc. Radiat. Transfer 40, 1988
    (exact single scattering over a truncated field).
    """
    series = legendre_moments(medium.phase, SERIES_ORDER)
    column = vertical_columns(medium)
    fraction = np.maximum(series[:, order + 1], 0.0)
    is_peaked = (fraction.max(axis=1) > PEAKED) & (medium.scattering.max(axis=1) > 0.0)
    fraction[~is_peaked] = 0.0
    kept = 1.0 - fraction
    moments = (series[:, : order + 1] - fraction[:, None]) / kept[:, None]
    true_scattering = medium.scattering * is_peaked[:, None]
    depth = true_scattering * column[:, None]
    total = np.maximum(depth.sum(axis=0), 1e-300)
    share = depth / total
    mixture = (share * fraction).sum(axis=0)
    mixture_series = np.einsum("cw,clw->lw", share, series)
    polynomials = legendre_polynomials(np.cos(scattering_angles()), SERIES_ORDER)
    phase = medium.phase.copy()
    peaked = np.flatnonzero(is_peaked)
    for c in peaked:
        phase[c] = sum_series(polynomials[: order + 1], moments[c])
    peaks = [
        _peak_functions(
            medium.phase[c], series[c], fraction[c], mixture_series, mixture, polynomials, order
        )
        for c in peaked
    ]
    scaled = medium._replace(
        scattering=medium.scattering * kept,
        extinction=medium.extinction - medium.scattering * fraction,
        phase=phase,
        matrix=medium.matrix[:0],
    )
    return ScaledMedium(
        scaled,
        moments,
        peaked,
        fraction,
        true_scattering,
        mixture,
        np.concatenate([phase, *peaks]),
        _truncated_matrices(medium, fraction, order),
    )


def _truncated_matrices(medium: Medium, fraction: Array, order: int) -> Array:
    """Moments of matrices without peaks, within which light keeps its polarisation."""
    moments = matrix_moments(medium.matrix, medium.phase, order)
    if len(moments):
        moments[:, 1:, 2:] -= fraction[:, None, None]
        moments /= (1.0 - fraction)[:, None, None]
    return moments


def peak_moments(medium: Medium, scaled: ScaledMedium) -> Array:
    """Legendre moments of the constituents' peaks, (constituent, `SERIES_ORDER` + 1, wavelength).

    Parameters
    ----------
    medium : Medium
        The atmosphere as it is.
    scaled : ScaledMedium
        The same without peaks, whose share is the moment up to the order that stayed.
    """
    moments = legendre_moments(pad_wavelengths(medium).phase, SERIES_ORDER)
    moments[:, : scaled.moments.shape[1]] = scaled.fraction[:, None]
    return moments


def peaked_shares(scaled: ScaledMedium, altitude: Array) -> Array:
    """Shares of constituents in what is scattered by peaked ones at altitudes [km].

    Shape (altitude, constituent, wavelength).
    """
    medium = scaled.medium
    nodes = altitude_nodes(medium.r_bottom, medium.r_top)
    density = np.stack([np.interp(altitude, nodes, each) for each in medium.density.T], axis=1)
    share: Array = density[:, :, None] * scaled.scattering + 1e-30 * scaled.scattering
    share /= np.maximum(share.sum(axis=1, keepdims=True), 1e-300)
    return share


def phase_groups(scaled: ScaledMedium) -> list[list[int]]:
    """Phase functions by constituent: its truncated one and those of its peak."""
    constituents = scaled.moments.shape[0]
    groups = [[c] for c in range(constituents)]
    for j, c in enumerate(scaled.peaked):
        first = constituents + j * PEAK_NODES.size
        groups[c].extend(range(first, first + PEAK_NODES.size))
    return groups


def keep_unscaled(medium: Medium) -> ScaledMedium:
    """Present a medium as it is, for methods that know no peaks."""
    nothing = np.zeros_like(medium.scattering)
    return ScaledMedium(
        medium=medium,
        moments=np.ones((medium.scattering.shape[0], 1, medium.scattering.shape[1])),
        peaked=np.empty(0, np.int64),
        fraction=nothing,
        scattering=nothing,
        mixture=nothing[0],
        phase=medium.phase,
        matrix_moments=np.zeros((0, ELEMENTS, 1, medium.scattering.shape[1])),
    )


def _peak_functions(
    exact: Array,
    series: Array,
    fraction: Array,
    mixture_series: Array,
    mixture: Array,
    polynomials: Array,
    order: int,
) -> Array:
    """Return what truncation leaves of a phase function, at each depth of `PEAK_NODES`.

    Light that was scattered n times within peaks on its straight way from the sun
    and then once toward the observer has moments chi_l**(n+1). Summed over n with
    the Poisson weights of a depth y, and less what the truncated medium holds
    already, orders above L keep chi_l * exp(y * (chi_l - f)) and the others f,
    both times exp(f * y), which is left to the ray. Shape (node, angle, wavelength).
    """
    residual = exact - sum_series(polynomials, series)
    functions = []
    for node in PEAK_NODES:
        # At the last node y is infinite and only the pure peak is left.
        depth = -np.log(max(1.0 - node, 1e-30)) / np.maximum(mixture, 1e-6)
        damping = np.exp(np.minimum(depth * (mixture_series - mixture), 0.0))
        left = series * damping
        left[: order + 1] = fraction
        functions.append(sum_series(polynomials, left) + residual * (1.0 - node))
    return np.stack(functions)
