"""Light that rays bring out of the diffuse field, by scattering or from the ground."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array
from skybake.scattering.aureole import fill_peak_emission
from skybake.scattering.fans import Fans
from skybake.scattering.field import (
    DiffuseField,
    altitude_weight,
    fill_ground_irradiance,
)
from skybake.scattering.field_sums import (
    TOGETHER,
    add_orders,
    count_orders,
    fill_factors,
    sum_degrees,
)
from skybake.scattering.harmonics import fill_harmonics
from skybake.scattering.horizon_peaks import add_horizon_peaks, fill_elevation_weights
from skybake.scattering.polarised import (
    ORDERS,
    add_polarised_source,
    add_twists,
    fill_polarised_scattering,
    fill_spin_functions,
)
from skybake.scattering.suns import fill_suns
from skybake.transport.geometry import radius_at

NEGLIGIBLE = 3e-4
"""Share of what a sample scatters below which its moments of order l are left out. It is not a
share of what the whole ray scatters: in twilight the thin air aloft carries most of the light."""


class Scratch(NamedTuple):
    """Work space of `add_diffuse`; each thread needs its own.

    Attributes
    ----------
    angle, node, weights, cosine : ndarray, shape (ray,), (ray,), (ray, 4) and (ray,)
        Of `fill_suns`.
    fourier : ndarray of float32, shape (sun, order m * wavelength)
        Sums over degrees l at the nodes of the sun's angle.
    orders : ndarray of int64, shape (sun,)
        How many of the orders m matter there.
    series : ndarray of float32, shape (order m * wavelength,)
        The same between nodes.
    harmonic, factor : ndarray, shape (harmonic,) and (harmonic * wavelength,)
        Spherical harmonics, and what of them is scattered.
    scattering : ndarray of float32, shape (degree, wavelength)
        What a step scatters.
    weight, sky : ndarray, shape (wavelength,)
        Of a step, and on the ground.
    polar, emitted : ndarray, shape (4,) and (2, wavelength)
        Weights of elevations, and what a step scatters in peaks.
    coupling : ndarray of float32, shape (2, wavelength)
        What a step scatters from and to polarised light.
    twist, turned : ndarray of float32, shape (sun, 3 * wavelength) and (3 * wavelength,)
        Moments of scattered polarised light at the nodes of the sun's angle, and between them.
    spins : ndarray, shape (2, 3)
        Functions of `skybake.scattering.polarised`.
    """

    angle: Array
    node: npt.NDArray[np.int64]
    weights: Array
    cosine: Array
    fourier: npt.NDArray[np.float32]
    orders: npt.NDArray[np.int64]
    series: npt.NDArray[np.float32]
    harmonic: Array
    factor: npt.NDArray[np.float32]
    scattering: npt.NDArray[np.float32]
    weight: npt.NDArray[np.float32]
    sky: Array
    polar: Array
    emitted: Array
    coupling: npt.NDArray[np.float32]
    twist: npt.NDArray[np.float32]
    turned: npt.NDArray[np.float32]
    spins: Array


def allocate_scratch(field: DiffuseField, fans: Fans) -> Scratch:
    """Make the work space for fans in a field."""
    suns, _, wavelengths = field.radiance.shape[1:]
    harmonics = field.harmonics.degree.size
    widest = int(np.diff(fans.first).max())
    orders = field.harmonics.order + 1
    size = -(-orders // TOGETHER) * TOGETHER * wavelengths
    return Scratch(
        angle=np.empty(widest),
        node=np.empty(widest, np.int64),
        weights=np.empty((widest, 4)),
        cosine=np.empty(widest),
        fourier=np.empty((suns, size), np.float32),
        orders=np.empty(suns, np.int64),
        series=np.empty(size, np.float32),
        harmonic=np.empty(harmonics),
        factor=np.empty(harmonics * wavelengths, np.float32),
        scattering=np.empty((orders, wavelengths), np.float32),
        weight=np.empty(wavelengths, np.float32),
        sky=np.empty(wavelengths),
        polar=np.empty(4),
        emitted=np.empty((2, wavelengths)),
        coupling=np.empty((2, wavelengths), np.float32),
        twist=np.empty((suns, ORDERS * wavelengths), np.float32),
        turned=np.empty(ORDERS * wavelengths, np.float32),
        spins=np.empty((2, ORDERS)),
    )


def side_by_side(field: DiffuseField) -> npt.NDArray[np.float32]:
    """Moments of a field with harmonics and wavelengths in one row, as a view."""
    altitudes, suns, harmonics, wavelengths = field.radiance.shape
    return field.radiance.reshape(altitudes, suns, harmonics * wavelengths)


@kernel
def add_diffuse(field, radiance, peaks, scaled, fans, begin, end, samples, scratch, out, stokes):
    """Add the light that rays bring out of the diffuse field.

    Parameters
    ----------
    field : DiffuseField
        The light to be scattered.
    radiance : ndarray of float32, shape (altitude, sun, harmonic * wavelength)
        Its moments once more, from `side_by_side`.
    peaks : HorizonPeaks
        What peaks scatter of it across the horizon.
    scaled : ScaledMedium
        The atmosphere.
    fans : Fans
        The rays.
    begin, end, samples
        Fans, and the result of `trace` for their starts.
    scratch : Scratch
        Work space.
    out : ndarray of float32, shape (ray, wavelength)
        Receives radiance per unit irradiance. [sr⁻¹]
    stokes : ndarray of float32, shape (ray, 2 * wavelength) or (0, 2 * wavelength)
        Receives Q and U as `skybake.scattering.polarised` has them, if it has rows.

    Notes
    -----
    At a sample the sum over degrees l, which rays of a fan share, is done first,
    at each node of the sun's angle that any of them needs; a ray then sums orders m.
    """
    medium, wavelengths = scaled.medium, out.shape[1]
    node, weights, cosine = scratch.node, scratch.weights, scratch.cosine
    fourier, series = scratch.fourier, scratch.series
    harmonic, factor, scattering = scratch.harmonic, scratch.factor, scratch.scattering
    weight, sky = scratch.weight, scratch.sky
    polar, emitted = scratch.polar, scratch.emitted
    for fan in range(begin, end):
        i, count = fans.first[fan], fans.first[fan + 1] - fans.first[fan]
        r, mu = fans.starts[fan, 0], fans.starts[fan, 1]
        first = samples.first[fan - begin]
        last = first + samples.number[fan - begin]
        # The field is smooth within a step, so that its two samples share a lookup where
        # the middle of what they scatter is.
        for n in range(first, last, 2):
            _fill_scattering(field, samples, n, weight, scattering)
            degrees = _count_degrees(scattering)
            if degrees == 0:
                continue
            share = _second_share(field, samples, n)
            t = (1.0 - share) * samples.distance[n] + share * samples.distance[n + 1]
            radius = radius_at(r, mu, t)
            mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
            least, most = fill_suns(
                field, fans.rays, i, count, t, radius, mu_here, scratch.angle, node, weights, cosine
            )
            fill_harmonics(field.harmonics, mu_here, harmonic)
            fill_factors(harmonic, scattering, degrees, factor)
            is_polarised = degrees >= ORDERS and fill_polarised_scattering(
                field, samples, n, weight, scratch.coupling
            )
            low, u = altitude_weight(field, radius - medium.r_bottom)
            at = _fill_peaks(peaks, scaled, samples, n, radius, mu_here, polar, emitted)
            for j in range(least, most):
                below, above = radiance[low, j], radiance[low + 1, j]
                sum_degrees(below, above, u, factor, degrees, wavelengths, fourier[j])
                if is_polarised:
                    add_polarised_source(
                        below, above, u, harmonic, scratch.coupling, fourier[j], scratch.twist[j]
                    )
                if at >= 0:
                    add_horizon_peaks(
                        peaks, low, u, j, at, polar, emitted[0], degrees, series, fourier[j]
                    )
                scratch.orders[j] = count_orders(fourier[j], degrees, wavelengths)
            add_orders(fourier, scratch.orders, node, weights, cosine, series, out[i : i + count])
            if is_polarised and stokes.shape[0] > 0:
                fill_spin_functions(mu_here, scratch.spins)
                add_twists(
                    scratch.twist, node, weights, cosine, scratch.spins, scratch.turned,
                    stokes[i : i + count],
                )  # fmt: skip
        if samples.hits_ground[fan - begin]:
            length = samples.length[fan - begin]
            for q in range(count):
                mu_s = (r * fans.rays[i + q, 2] + length * fans.rays[i + q, 3]) / medium.r_bottom
                fill_ground_irradiance(field, mu_s, weights[q], sky)
                for k in range(wavelengths):
                    reflected = medium.ground_albedo[k] / math.pi * sky[k]
                    out[i + q, k] += samples.transmittance[fan - begin, k] * reflected


@kernel
def _fill_scattering(field, samples, n, weight, out):
    """Write weight * scattering coefficient * chi_l of a step's samples, (degree, wavelength)."""
    out[...] = 0.0
    for c in range(field.source.shape[0]):
        low, high = samples.density[n, c], samples.density[n + 1, c]
        if low + high == 0.0:
            continue
        for k in range(weight.size):
            weight[k] = low * samples.weight[n, k] + high * samples.weight[n + 1, k]
        for degree in range(out.shape[0]):
            for k in range(weight.size):
                out[degree, k] += np.float32(field.source[c, degree, k]) * weight[k]


@kernel
def _fill_peaks(peaks, scaled, samples, n, radius, mu, polar, emitted):
    """Write what a step scatters in peaks and weights of its elevation, whose node is returned.

    It is -1 where there is nothing of either.
    """
    node = fill_elevation_weights(peaks, scaled.medium.r_bottom, radius, mu, polar)
    if node >= 0 and fill_peak_emission(scaled, samples, n, emitted) < 0.0:
        return -1
    return node


@kernel
def _second_share(field, samples, n):
    """Share of a step's scattering, over all wavelengths, that its second sample has."""
    first = second = 0.0
    for c in range(field.source.shape[0]):
        low, high = samples.density[n, c], samples.density[n + 1, c]
        for k in range(samples.weight.shape[1]):
            first += field.source[c, 0, k] * low * samples.weight[n, k]
            second += field.source[c, 0, k] * high * samples.weight[n + 1, k]
    return second / (first + second) if first + second > 0.0 else 0.5


@kernel
def _count_degrees(scattering):
    """Orders l that matter beside all that a step scatters, none where that is nothing."""
    share = np.float32(NEGLIGIBLE)
    for degree in range(scattering.shape[0] - 1, -1, -1):
        needed = 0
        for k in range(scattering.shape[1]):
            needed += abs(scattering[degree, k]) > share * scattering[0, k]
        if needed > 0:
            return degree + 1
    return 0
