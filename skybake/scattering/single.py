"""Light that is scattered or reflected once on its way from the sun to the observer."""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.scattering.sunlit import gather_sunlit
from skybake.scattering.transmittance import fill_sun_column, fill_transmittance
from skybake.transport.exponential import fast_exp32


@kernel
def add_single_scattering(scaled, nodes, columns, fans, begin, end, samples, lit, single, ground):
    """Add the sunlight that reaches the samples of rays and the ground at their ends.

    Parameters
    ----------
    scaled : ScaledMedium
        The atmosphere's medium, and what restores its forward peaks.
    nodes : ndarray of float64
        `PEAK_NODES`.
    columns : ndarray
        Table of `build_columns`.
    fans : Fans
        The rays.
    begin, end, samples
        Fans, and the result of `trace` for their starts, in the truncated medium.
    lit : Sunlit
        Work space.
    single : ndarray of float64, shape (ray, phase function, wavelength)
        Receives, per unit irradiance, what the phase functions multiply; see
        `skybake.optics.delta_m.ScaledMedium`.
    ground : ndarray of float32, shape (ray, wavelength)
        Receives the radiance of the ground per unit irradiance. [sr⁻¹]
    """
    constituents, wavelengths = scaled.medium.extinction.shape
    depth, light, filled = lit.depth, lit.light, lit.filled
    for fan in range(begin, end):
        first, length = samples.first[fan - begin], samples.length[fan - begin]
        last = first + samples.number[fan - begin]
        for i in range(fans.first[fan], fans.first[fan + 1]):
            count = gather_sunlit(
                scaled.medium, columns, fans.rays[i], samples, first, last, length, lit
            )
            for k in range(wavelengths):
                _fill_light(scaled, k, count, lit, depth, light)
                for c in range(constituents):
                    scattering = scaled.medium.scattering[c, k]
                    single[i, c, k] += scattering * _sum_products(count, lit.density[c], light)
                if scaled.peaked.size > 0:
                    _split_peak(scaled, k, count, lit, depth, light, filled)
                    _add_peak(scaled, nodes, k, count, lit, light, filled, single[i])
            if samples.hits_ground[fan - begin]:
                behind = samples.transmittance[fan - begin]
                _add_ground(
                    scaled.medium,
                    columns,
                    fans.rays[i],
                    length,
                    behind,
                    lit.column,
                    lit.through,
                    ground[i],
                )


@kernel
def _fill_light(scaled, k, count, lit, depth, light):
    """Write the share of sunlight that arrives by way of each sample times its weight."""
    for n in range(count):
        depth[n] = np.float32(0.0)
    for c in range(lit.sunward.shape[0]):
        _add_scaled(count, scaled.medium.extinction[c, k], lit.sunward[c], depth)
    weight = lit.weight[k]
    for n in range(count):
        light[n] = weight[n] * fast_exp32(-depth[n])


@kernel
def _split_peak(scaled, k, count, lit, depth, light, filled):
    """Keep of the light what was scattered within peaks only; how far they have filled.

    That is 1 - exp(-f y), y the depth of peak scattering between sun and sample.
    """
    for n in range(count):
        depth[n] = np.float32(0.0)
        filled[n] = np.float32(0.0)
    for c in scaled.peaked:
        gain = scaled.mixture[k] * scaled.scattering[c, k]
        loss = scaled.fraction[c, k] * scaled.scattering[c, k]
        _add_scaled(count, gain, lit.sunward[c], filled)
        _add_scaled(count, loss - gain, lit.sunward[c], depth)
        _add_scaled(count, loss, lit.backward[c], depth)
    for n in range(count):
        light[n] *= fast_exp32(-depth[n])
        filled[n] = np.float32(1.0) - fast_exp32(-filled[n])


@kernel
def _add_peak(scaled, nodes, k, count, lit, light, filled, out):
    """Share each sample's light between the phase functions of the two nodes around `filled`."""
    constituents = scaled.fraction.shape[0]
    for j in range(scaled.peaked.size):
        c = scaled.peaked[j]
        p = constituents + j * nodes.size
        # Light counts for all nodes below it and, in part, for the next.
        total = scaled.scattering[c, k] * _sum_products(count, lit.density[c], light)
        for i in range(1, nodes.size):
            beyond = scaled.scattering[c, k] * _sum_ramps(
                count, lit.density[c], light, filled, nodes[i - 1], nodes[i]
            )
            out[p, k] += total - beyond
            total = beyond
            p += 1
            if total == 0.0:
                break
        out[p, k] += total


@kernel
def _add_scaled(count, factor, values, out):
    single = np.float32(factor)
    for n in range(count):
        out[n] += single * values[n]


@kernel
def _sum_products(count, a, b):
    total = np.float32(0.0)
    for n in range(count):
        total += a[n] * b[n]
    return total


@kernel
def _sum_ramps(count, a, b, x, low, high):
    """Sum of products weighted 0 where `x` is below `low`, 1 above `high`, linear between."""
    slope, shift = np.float32(1.0 / (high - low)), np.float32(low / (high - low))
    total = np.float32(0.0)
    for n in range(count):
        total += a[n] * b[n] * min(max(slope * x[n] - shift, np.float32(0.0)), np.float32(1.0))
    return total


@kernel
def _add_ground(medium, columns, ray, length, transmittance, column, light, out):
    """Add the ground at the end of a ray as the sun alone lights it, shape (wavelength,)."""
    mu_s = (ray[0] * ray[2] + length * ray[3]) / medium.r_bottom
    if mu_s <= 0.0:
        return
    fill_sun_column(columns, medium.r_bottom, medium.r_top, medium.r_bottom, mu_s, column)
    fill_transmittance(medium.extinction, column, light)
    for k in range(out.size):
        reflected = medium.ground_albedo[k] / math.pi * mu_s * light[k]
        out[k] += transmittance[k] * reflected
