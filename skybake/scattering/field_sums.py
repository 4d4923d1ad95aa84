"""Sums over the degrees and orders of a diffuse field's moments."""

from __future__ import annotations

import numpy as np

from skybake.jit.kernel import kernel

TOGETHER = 3
"""Orders m that are summed at once."""

FAINT = 1e-4
"""Share of the mean over azimuth below which terms of order m are left out, with all beyond."""


@kernel
def fill_factors(harmonic, scattering, degrees, out):
    """Write harmonics times what their degree scatters, flat as the moments of a field."""
    wavelengths = scattering.shape[1]
    p = 0
    for degree in range(degrees):
        for _ in range(degree + 1):
            value, here = np.float32(harmonic[p]), out[p * wavelengths : (p + 1) * wavelengths]
            for k in range(here.size):
                here[k] = value * scattering[degree, k]
            p += 1


@kernel
def sum_degrees(below, above, u, factor, degrees, wavelengths, out):
    """Sum over l of the scattered moments between two altitudes, flat by m and wavelength.

    Terms of m that no degree has are 0.
    """
    upper = np.float32(u)
    for q in range(out.size):
        out[q] = np.float32(0.0)
    first = 0
    for degree in range(degrees):
        length = (degree + 1) * wavelengths
        low, high = below[first : first + length], above[first : first + length]
        scale = factor[first : first + length]
        for q in range(length):
            out[q] += scale[q] * (low[q] + upper * (high[q] - low[q]))
        first += length


@kernel
def count_orders(terms, degrees, wavelengths):
    """Orders m that matter beside that of 0, a multiple of `TOGETHER`."""
    share = np.float32(FAINT)
    for m in range(degrees - 1, 0, -1):
        needed = 0
        for k in range(wavelengths):
            needed += abs(terms[m * wavelengths + k]) > share * abs(terms[k])
        if needed > 0:
            return (m // TOGETHER + 1) * TOGETHER
    return TOGETHER


@kernel
def add_orders(fourier, orders, node, weights, cosine, series, out):
    """Add Fourier series in azimuth to the rays of a fan, (ray, wavelength).

    Parameters
    ----------
    fourier : ndarray of float32, shape (sun, order * wavelength)
        Terms at the nodes of the sun's angle.
    orders : ndarray of int64, shape (sun,)
        Result of `count_orders` for each.
    node, weights, cosine : ndarray
        Of `skybake.scattering.suns.fill_suns`.
    series : ndarray of float32, shape (order * wavelength,)
        Work space.
    out : ndarray of float32, shape (ray, wavelength)
        Is added to.

    Notes
    -----
    Indices are unsigned: numba lets others count from the end, which LLVM cannot vectorise.
    """
    rays, wavelengths = out.shape
    lanes = np.uint64(wavelengths)
    for i in range(rays):
        j = node[i]
        a, b = np.float32(weights[i, 0]), np.float32(weights[i, 1])
        c, d = np.float32(weights[i, 2]), np.float32(weights[i, 3])
        needed = max(orders[j], orders[j + 1], orders[j + 2], orders[j + 3])
        for p in range(needed * wavelengths):
            series[p] = (
                a * fourier[j, p]
                + b * fourier[j + 1, p]
                + c * fourier[j + 2, p]
                + d * fourier[j + 3, p]
            )
        first, second = np.float32(1.0), np.float32(cosine[i])
        twice = np.float32(2.0 * cosine[i])
        for group in range(needed // TOGETHER):
            third = twice * second - first
            u = np.uint64(group * TOGETHER) * lanes
            v, w = u + lanes, u + lanes + lanes
            for k in range(lanes):
                out[i, k] += first * series[u + k] + second * series[v + k] + third * series[w + k]
            first = twice * third - second
            second = twice * first - third
