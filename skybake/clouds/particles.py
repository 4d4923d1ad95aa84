"""How the particles of a layer scatter, divided between ordinates, a forward peak, and the eye."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.optics.legendre import legendre_moments, legendre_polynomials, sum_series
from skybake.optics.medium import Array
from skybake.optics.phase import scattering_angles

SERIES_ORDER = 600
TERMS = 16
"""Of the series over the depth of scattering within peaks; it holds up to `DEEPEST`."""

DEEPEST = 14.0

STRAIGHT, BENT = math.radians(40.0), math.radians(86.0)
"""Scattering angles up to which light that peaks have scattered several times is followed in full,
and from which it is not: far from the sun its legs are not in one line."""


class Particles(NamedTuple):
    """Phase functions of one layer.

    Attributes
    ----------
    order : int
        Highest degree of the ordinates.
    fraction : float
        Share of scattered light that is in the forward peak and counts as not scattered.
    moments : ndarray of float64, shape (order + 1,)
        chi_l of the truncated phase function.
    truncated : ndarray of float64, shape (SCATTERING_ANGLES, channel)
        What the light that the sun sends through the truncated medium is scattered by at the end
        of its way, at `scattering_angles`. [sr⁻¹]
    peak : ndarray of float64, shape (SCATTERING_ANGLES, channel, TERMS)
        The same of the light within peaks, as a series in the depth up to there. [sr⁻¹]
    """

    order: int
    fraction: float
    moments: Array
    truncated: Array
    peak: Array


def divide_phase(phase: Array, middle: Array, order: int) -> Particles:
    """Divide a phase function.

    Parameters
    ----------
    phase : ndarray of float64, shape (SCATTERING_ANGLES, channel)
        At `scattering_angles`, for what is scattered once. [sr⁻¹]
    middle : ndarray of float64, shape (SCATTERING_ANGLES,)
        For what is scattered more often, which keeps no colours. [sr⁻¹]
    order : int
        Highest degree that is kept.

    Notes
    -----
    Light that was scattered n times within peaks on its straight way from the sun, and then once
    toward the eye, has moments chi_l**(n+1). What of it the truncated medium holds already is
    subtracted: f**n times the truncated phase function. Summed over n with Poisson's weights of the
    depth y this is exp(-f y) times a series in y, of which `peak` holds the coefficients.

    References
    ----------
    W. J. Wiscombe, "The Delta-M Method", J. Atmos. Sci. 34, 1977.
    T. Nakajima and M. Tanaka, J. Quant. Spectrosc. Radiat. Transfer 40, 1988.
    """
    chi = legendre_moments(middle[None, :, None], SERIES_ORDER)[0, :, 0]
    fraction = max(float(chi[order + 1]), 0.0)
    kept = 1.0 - fraction
    moments = (chi[: order + 1] - fraction) / kept
    angle = scattering_angles()
    polynomials = legendre_polynomials(np.cos(angle), SERIES_ORDER)
    truncated = sum_series(polynomials[: order + 1], moments[:, None])
    terms = np.empty((angle.size, phase.shape[1], TERMS))
    terms[:, :, 0] = phase - kept * truncated
    scale = 1.0
    for n in range(1, TERMS):
        scale /= n
        left = chi ** (n + 1)
        left[: order + 1] = fraction ** (n + 1)
        terms[:, :, n] = scale * sum_series(polynomials, left[:, None])
    share = np.clip((BENT - angle) / (BENT - STRAIGHT), 0.0, 1.0)[:, None]
    share = share * share * (3.0 - 2.0 * share)
    # Elsewhere what is scattered once is exact, on the depths of the truncated medium.
    rest = terms[:, :, 0] * (1.0 - share) / kept
    return Particles(
        order=order,
        fraction=fraction,
        moments=moments,
        truncated=truncated + rest,
        peak=terms * share[:, :, None],
    )
