"""Light that is scattered or reflected once on its way from the sun to the observer."""

from __future__ import annotations

import math

from skybake.luts.transmittance import fill_sun_column, fill_transmittance
from skybake.transport.exponential import fast_exp
from skybake.transport.kernel import kernel


@kernel
def add_single_scattering(medium, columns, r, mu_s, nu, samples, count, out):
    """Add the sunlight that reaches a ray's samples, before any phase function.

    Parameters
    ----------
    medium : Medium
        The atmosphere.
    columns : ndarray
        Table of `build_columns`.
    r, mu_s, nu : float
        Start of the ray [km], cosines of the sun's zenith angle there and of
        the angle between ray and sun.
    samples, count : Samples, int
        Result of `trace`.
    out : ndarray of float64, shape (constituent, wavelength)
        Receives the integral of density * transmittance per unit irradiance;
        times scattering coefficient and phase function it is radiance. [km]
    """
    constituents, wavelengths = medium.extinction.shape
    column, light = samples.sun_column, samples.light
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
                out[c, k] += density * light[k]


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
