"""Sums over the degrees and orders of a diffuse field's moments."""

from __future__ import annotations

import numpy as np

from skybake.jit.kernel import kernel


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
    """Sum over l of the scattered moments between two altitudes, flat by m and wavelength."""
    upper = np.float32(u)
    for q in range(degrees * wavelengths):
        out[q] = 0.0
    first = 0
    for degree in range(degrees):
        length = (degree + 1) * wavelengths
        low, high = below[first : first + length], above[first : first + length]
        scale = factor[first : first + length]
        for q in range(length):
            out[q] += scale[q] * (low[q] + upper * (high[q] - low[q]))
        first += length


@kernel
def add_orders(fourier, node, weights, cosine, degrees, series, out):
    """Add a Fourier series in azimuth, interpolated between four sun angles."""
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    at_a, at_b, at_c, at_d = fourier[node], fourier[node + 1], fourier[node + 2], fourier[node + 3]
    for q in range(degrees * out.size):
        series[q] = a * at_a[q] + b * at_b[q] + c * at_c[q] + d * at_d[q]
    before, now = np.float32(cosine), np.float32(1.0)
    twice = np.float32(2.0 * cosine)
    for m in range(degrees):
        term = series[m * out.size : (m + 1) * out.size]
        for k in range(out.size):
            out[k] += now * term[k]
        before, now = now, twice * now - before
