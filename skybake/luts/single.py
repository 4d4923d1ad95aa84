"""Light that is scattered or reflected once on its way from the sun to the observer."""

from __future__ import annotations

import math

import numpy as np

from skybake.luts.transmittance import fill_sun_column, fill_transmittance
from skybake.transport.exponential import fast_exp
from skybake.transport.kernel import inner_kernel, kernel


@kernel
def add_single_scattering(cut, nodes, columns, rays, begin, end, samples, out):
    """Add the sunlight that reaches the samples of rays, before any phase function.

    Parameters
    ----------
    cut : Truncation
        The atmosphere without forward peaks, and what restores them.
    nodes : ndarray of float64
        `PEAK_NODES`.
    columns : ndarray
        Table of `build_columns`.
    rays, begin, end, samples
        Arguments and result of `trace`, in the truncated medium; `end` is the ray
        after the last that was traced.
    out : ndarray of float64, shape (ray, channel, wavelength)
        Receives, per unit irradiance, what the phase functions of the channels
        multiply; see `skybake.optics.legendre.Truncation`.
    """
    medium = cut.medium
    constituents, wavelengths = medium.extinction.shape
    column = np.empty(constituents)
    light, peak, filled = np.empty(wavelengths), np.empty(wavelengths), np.empty(wavelengths)
    for i in range(begin, end):
        r, mu_s, nu = rays[i, 0], rays[i, 2], rays[i, 3]
        first = samples.first[i - begin]
        for n in range(first, first + samples.number[i - begin]):
            if not samples.lit[n]:
                continue
            mu_s_here = (r * mu_s + samples.distance[n] * nu) / samples.radius[n]
            if not fill_sun_column(
                columns, medium.r_bottom, medium.r_top, samples.radius[n], mu_s_here, column
            ):
                continue
            fill_transmittance(medium.extinction, column, light)
            for k in range(wavelengths):
                light[k] *= samples.weight[n, k]
            for c in range(constituents):
                density = samples.density[n, c]
                for k in range(wavelengths):
                    out[i, c, k] += density * medium.scattering[c, k] * light[k]
            if cut.peaked.size > 0:
                _split_peak(cut, column, samples, n, light, peak, filled)
                _add_peak(cut, nodes, samples, n, peak, filled, out[i])


@inner_kernel
def _split_peak(cut, column, samples, n, light, peak, filled):
    """Light that was scattered within peaks only, and how far they have filled, 1 - exp(-f y)."""
    for k in range(light.size):
        filled[k] = 0.0
        peak[k] = 0.0
    for c in cut.peaked:
        both = column[c] + samples.column_to[n, c]
        for k in range(light.size):
            filled[k] += cut.scattering[c, k] * column[c]
            peak[k] -= cut.fraction[c, k] * cut.scattering[c, k] * both
    for k in range(light.size):
        depth = cut.mixture[k] * filled[k]
        peak[k] = light[k] * fast_exp(peak[k] + depth)
        filled[k] = 1.0 - fast_exp(-depth)


@inner_kernel
def _add_peak(cut, nodes, samples, n, peak, filled, out):
    """Share the peak's light among the channels of the two nodes around `filled`."""
    constituents = cut.fraction.shape[0]
    least, most = filled[0], filled[0]
    for k in range(1, filled.size):
        least, most = min(least, filled[k]), max(most, filled[k])
    for i in range(nodes.size):
        below = nodes[i] - nodes[i - 1] if i > 0 else 1.0
        above = nodes[i + 1] - nodes[i] if i + 1 < nodes.size else 1.0
        if most < nodes[i] - below or least > nodes[i] + above:
            continue
        for j in range(cut.peaked.size):
            c = cut.peaked[j]
            channel = constituents + j * nodes.size + i
            density = samples.density[n, c]
            for k in range(peak.size):
                offset = filled[k] - nodes[i]
                hat = max(1.0 - max(offset / above, -offset / below), 0.0)
                out[channel, k] += density * cut.scattering[c, k] * hat * peak[k]


@kernel
def add_sunlit_ground(medium, columns, rays, begin, end, samples, out):
    """Add the ground at the end of rays as the sun alone lights it.

    Parameters
    ----------
    medium, columns : Medium, ndarray
        The atmosphere and its table of `build_columns`.
    rays, begin, end, samples
        Arguments and result of `trace`.
    out : ndarray of float32, shape (ray, wavelength)
        Receives the radiance per unit irradiance. [sr⁻¹]
    """
    column, light = np.empty(medium.extinction.shape[0]), np.empty(out.shape[1])
    for i in range(begin, end):
        ray = i - begin
        mu_s = (rays[i, 0] * rays[i, 2] + samples.length[ray] * rays[i, 3]) / medium.r_bottom
        if not samples.hits_ground[ray] or mu_s <= 0.0:
            continue
        fill_sun_column(columns, medium.r_bottom, medium.r_top, medium.r_bottom, mu_s, column)
        fill_transmittance(medium.extinction, column, light)
        for k in range(light.size):
            reflected = medium.ground_albedo[k] / math.pi * mu_s * light[k]
            out[i, k] += samples.transmittance[ray, k] * reflected
