"""Light that is scattered or reflected once on its way from the sun to the observer."""

from __future__ import annotations

import math

from skybake.luts.transmittance import fill_sun_column, fill_transmittance
from skybake.transport.exponential import fast_exp
from skybake.transport.kernel import kernel


@kernel
def add_single_scattering(cut, columns, nodes, r, mu_s, nu, samples, count, scratch, out):
    """Add the sunlight that reaches a ray's samples, before any phase function.

    Parameters
    ----------
    cut : Truncation
        The atmosphere without forward peaks, and what restores them.
    columns : ndarray
        Table of `build_columns`.
    nodes : ndarray of float64
        `PEAK_NODES`.
    r, mu_s, nu : float
        Start of the ray [km], cosines of the sun's zenith angle there and of
        the angle between ray and sun.
    samples, count : Samples, int
        Result of `trace` in the truncated medium.
    scratch : ndarray of float64, shape (3, wavelength)
        Work space.
    out : ndarray of float64, shape (channel, wavelength)
        Receives, per unit irradiance, what the phase functions of the channels
        multiply; see `skybake.optics.legendre.Truncation`.
    """
    medium = cut.medium
    constituents, wavelengths = medium.extinction.shape
    column = samples.sun_column
    light, peak, filled = scratch[0], scratch[1], scratch[2]
    for n in range(count):
        if not samples.lit[n]:
            continue
        mu_s_here = (r * mu_s + samples.distance[n] * nu) / samples.radius[n]
        if not fill_sun_column(
            columns, medium.r_bottom, medium.r_top, samples.radius[n], mu_s_here, column
        ):
            continue
        for k in range(wavelengths):
            light[k] = 0.0
        for c in range(constituents):
            for k in range(wavelengths):
                light[k] -= medium.extinction[c, k] * column[c]
        for k in range(wavelengths):
            light[k] = fast_exp(light[k]) * samples.weight[n, k]
        for c in range(constituents):
            density = samples.density[n, c]
            for k in range(wavelengths):
                out[c, k] += density * medium.scattering[c, k] * light[k]
        if cut.peaked.size > 0:
            _split_peak(cut, column, samples, n, light, peak, filled)
            _add_peak(cut, nodes, samples, n, peak, filled, out)


@kernel
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


@kernel
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
def add_ground(medium, columns, diffuse, r, mu_s, nu, length, samples, out):
    """Add the ground at the end of a ray, lit by the sun and by the sky.

    Parameters
    ----------
    medium, columns : Medium, ndarray
        The atmosphere and its table of `build_columns`.
    diffuse : ndarray of float64, shape (wavelength,)
        Irradiance of the ground by the sky where the ray ends, per unit
        irradiance of the sun.
    r, mu_s, nu, length : float
        Start of the ray [km], cosines of the sun's zenith angle there and of
        the angle between ray and sun, distance to the ground [km].
    samples : Samples
        Result of `trace`.
    out : ndarray of float64, shape (wavelength,)
        Receives the radiance per unit irradiance. [sr⁻¹]
    """
    mu_s_ground = (r * mu_s + length * nu) / medium.r_bottom
    column, direct = samples.sun_column, samples.light
    fill_sun_column(
        columns, medium.r_bottom, medium.r_top, medium.r_bottom, max(mu_s_ground, 0.0), column
    )
    fill_transmittance(medium.extinction, column, direct)
    for k in range(out.size):
        irradiance = direct[k] * max(mu_s_ground, 0.0) + diffuse[k]
        out[k] += samples.transmittance[k] * medium.ground_albedo[k] / math.pi * irradiance
