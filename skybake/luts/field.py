"""The diffuse light in the atmosphere: angular moments over altitude and sun angle.

A field of order L holds, at each altitude and solar zenith angle, the real
spherical harmonics of the radiance up to l = L. Order 0 is an isotropic field.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.luts.harmonics import Harmonics, fill_harmonics
from skybake.optics.medium import Array
from skybake.transport.exponential import fast_exp
from skybake.transport.geometry import radius_at
from skybake.transport.kernel import kernel

ANGLE_BINS = 2048
NEGLIGIBLE = 3e-4
"""Share of a ray's scattering below which an order l of a sample is left out."""

TWILIGHT_SLOPE = 40.0
TWILIGHT_ONSET = math.radians(5.0)


class DiffuseField(NamedTuple):
    """Diffuse radiance per unit irradiance of the sun, as kernels read it.

    Attributes
    ----------
    harmonics : Harmonics
        Recurrence of the harmonics that `radiance` counts.
    altitude : ndarray of float64, shape (altitude,)
        Ascending from 0 to the top; linear between. [km]
    sun_angle : ndarray of float64, shape (sun,)
        Solar zenith angles, ascending from 0; cubic between. [rad]
    sun_bin : ndarray of int64, shape (ANGLE_BINS,)
        First of the four nodes around a solar zenith angle, by equal bins of pi.
    source : ndarray of float64, shape (constituent, order + 1, wavelength)
        Scattering coefficient times chi_l at density 1. [km⁻¹]
    radiance : ndarray of float32, shape (altitude, sun, harmonic, wavelength)
        Moments of the radiance scattered or reflected at least once. [sr⁻¹]
    ground : ndarray of float64, shape (sun, wavelength)
        Irradiance of the ground by the sky.
    """

    harmonics: Harmonics
    altitude: Array
    sun_angle: Array
    sun_bin: npt.NDArray[np.int64]
    source: Array
    radiance: npt.NDArray[np.float32]
    ground: Array


def sun_bins(sun_angle: Array) -> npt.NDArray[np.int64]:
    """Table from equal bins of the solar zenith angle to the first of four nodes.

    It holds for the start of a bin; bins are narrower than the intervals between
    nodes, so a lookup moves on by one node at most.
    """
    starts = np.arange(ANGLE_BINS) * (math.pi / ANGLE_BINS)
    interval = np.searchsorted(sun_angle, starts, side="right") - 1
    return np.clip(interval - 1, 0, sun_angle.size - 4)


@kernel
def fast_acos(x):
    """Arc cosine within 2e-8 rad (Abramowitz and Stegun 4.4.46), without a library call."""
    a = min(abs(x), 1.0)
    series = 1.5707963050 + a * (
        -0.2145988016
        + a
        * (
            0.0889789874
            + a
            * (
                -0.0501743046
                + a * (0.0308918810 + a * (-0.0170881256 + a * (0.0066700901 - a * 0.0012624911)))
            )
        )
    )
    positive = math.sqrt(1.0 - a) * series
    return positive if x >= 0.0 else math.pi - positive


@kernel
def log_twilight(angle):
    """Logarithm of how dark twilight is, roughly: 0 by day, then falling by 0.7 a degree."""
    below = angle - 0.5 * math.pi
    if below <= 0.0:
        return 0.0
    if below < TWILIGHT_ONSET:
        return -TWILIGHT_SLOPE * below * below / (2.0 * TWILIGHT_ONSET)
    return -TWILIGHT_SLOPE * (below - 0.5 * TWILIGHT_ONSET)


@kernel
def sun_weights(sun_angle, sun_bin, mu_s, out):
    """First node and weights of the four nodes around a sun's position.

    Lagrange's cubic through the values divided by exp(log_twilight), which differ
    little from node to node even where twilight falls by half between them.
    """
    angle = min(fast_acos(mu_s), sun_angle[-1])
    j = sun_bin[min(int(angle * (ANGLE_BINS / math.pi)), ANGLE_BINS - 1)]
    if angle > sun_angle[j + 2] and j + 4 < sun_angle.size:
        j += 1
    a, b, c, d = sun_angle[j], sun_angle[j + 1], sun_angle[j + 2], sun_angle[j + 3]
    xa, xb, xc, xd = angle - a, angle - b, angle - c, angle - d
    out[0] = xb * xc * xd / ((a - b) * (a - c) * (a - d))
    out[1] = xa * xc * xd / ((b - a) * (b - c) * (b - d))
    out[2] = xa * xb * xd / ((c - a) * (c - b) * (c - d))
    out[3] = xa * xb * xc / ((d - a) * (d - b) * (d - c))
    if d > 0.5 * math.pi:
        here = log_twilight(angle)
        for q in range(4):
            out[q] *= fast_exp(here - log_twilight(sun_angle[j + q]))
    return j


@kernel
def altitude_weight(altitude, h):
    """Lower node around an altitude and the share of the upper one."""
    low, high = 0, altitude.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if altitude[middle] <= h:
            low = middle
        else:
            high = middle
    share = (h - altitude[low]) / (altitude[low + 1] - altitude[low])
    return low, min(max(share, 0.0), 1.0)


@kernel
def fill_ground_irradiance(field, mu_s, weights, out):
    """Write the sky's irradiance of the ground to `out`, shape (wavelength,)."""
    j = sun_weights(field.sun_angle, field.sun_bin, mu_s, weights)
    for k in range(out.size):
        value = 0.0
        for q in range(4):
            value += weights[q] * field.ground[j + q, k]
        out[k] = max(value, 0.0)


@kernel
def add_diffuse(field, r_bottom, r, mu, mu_s, nu, samples, count, scratch, out):
    """Add the light that a ray's samples scatter out of the diffuse field.

    Parameters
    ----------
    field : DiffuseField
        The light to be scattered.
    r_bottom : float
        Radius of the ground. [km]
    r, mu, mu_s, nu : float
        Start of the ray [km], cosines of the zenith angles of ray and sun there and
        of the angle between them.
    samples, count : Samples, int
        Result of `trace`.
    scratch : FieldScratch
        Work space of `allocate_scratch`.
    out : ndarray of float64, shape (wavelength,)
        Receives radiance per unit irradiance. [sr⁻¹]
    """
    wavelengths = out.size
    whole, scattering = scratch.whole, scratch.scattering
    for k in range(wavelengths):
        whole[k] = 0.0
    for n in range(0, count, 2):
        fill_scattering(field, samples, n, n + 2, np.int64(1), scattering)
        for k in range(wavelengths):
            whole[k] += scattering[0, k]
    # The field is smooth within a step, so that its two samples share a lookup halfway.
    for n in range(0, count, 2):
        fill_scattering(field, samples, n, n + 2, scattering.shape[0], scattering)
        degrees = count_degrees(scattering, whole)
        if degrees == 0:
            continue
        t = 0.5 * (samples.distance[n] + samples.distance[n + 1])
        radius = radius_at(r, mu, t)
        mu_s_here = min(max((r * mu_s + t * nu) / radius, -1.0), 1.0)
        mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
        i, u = altitude_weight(field.altitude, radius - r_bottom)
        j = sun_weights(field.sun_angle, field.sun_bin, mu_s_here, scratch.weights)
        fill_harmonics(field.harmonics, mu_here, scratch.polar)
        sines = math.sqrt((1.0 - mu_here * mu_here) * (1.0 - mu_s_here * mu_s_here))
        cosine = 1.0 if sines < 1e-12 else (nu - mu_here * mu_s_here) / sines
        _add_harmonics(field, scratch, i, j, u, min(max(cosine, -1.0), 1.0), degrees, out)


@kernel
def _add_harmonics(field, scratch, i, j, u, cosine, degrees, out):
    """Add the harmonics of the field between two altitudes and four sun angles."""
    order = field.harmonics.order
    low, high = np.float32(1.0 - u), np.float32(u)
    a, b = np.float32(scratch.weights[0]), np.float32(scratch.weights[1])
    c, d = np.float32(scratch.weights[2]), np.float32(scratch.weights[3])
    lower, upper = field.radiance[i], field.radiance[i + 1]
    before, now = cosine, 1.0
    first = 0
    for m in range(degrees):
        for degree in range(m, degrees):
            p = first + degree - m
            factor = np.float32(now * scratch.polar[p])
            for k in range(out.size):
                below = (
                    a * lower[j, p, k]
                    + b * lower[j + 1, p, k]
                    + c * lower[j + 2, p, k]
                    + d * lower[j + 3, p, k]
                )
                above = (
                    a * upper[j, p, k]
                    + b * upper[j + 1, p, k]
                    + c * upper[j + 2, p, k]
                    + d * upper[j + 3, p, k]
                )
                out[k] += factor * scratch.scattering[degree, k] * (low * below + high * above)
        first += order + 1 - m
        before, now = now, 2.0 * cosine * now - before


@kernel
def fill_scattering(field, samples, first, last, degrees, out):
    """Write weight * scattering coefficient * chi_l of samples, shape (degree, wavelength)."""
    for degree in range(degrees):
        for k in range(out.shape[1]):
            out[degree, k] = 0.0
    for n in range(first, last):
        for c in range(field.source.shape[0]):
            density = samples.density[n, c]
            if density == 0.0:
                continue
            for degree in range(degrees):
                for k in range(out.shape[1]):
                    out[degree, k] += density * field.source[c, degree, k] * samples.weight[n, k]


@kernel
def count_degrees(scattering, whole):
    """Orders l of a sample that matter beside what all samples of the ray scatter."""
    for degree in range(scattering.shape[0] - 1, -1, -1):
        for k in range(whole.size):
            if abs(scattering[degree, k]) > NEGLIGIBLE * whole[k]:
                return degree + 1
    return 0


class FieldScratch(NamedTuple):
    """Work space of `add_diffuse`; each thread needs its own."""

    weights: Array
    whole: Array
    scattering: npt.NDArray[np.float32]
    polar: Array


def allocate_scratch(field: DiffuseField) -> FieldScratch:
    """Make the work space for looking up a field."""
    _, _, moments, wavelengths = field.radiance.shape
    return FieldScratch(
        weights=np.empty(4),
        whole=np.empty(wavelengths),
        scattering=np.empty((field.harmonics.order + 1, wavelengths), np.float32),
        polar=np.empty(moments),
    )
