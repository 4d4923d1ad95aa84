"""Linear polarisation that rays bring out of the diffuse field, of all orders of the matrices."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array
from skybake.scattering.fans import Fans
from skybake.scattering.field import altitude_weight
from skybake.scattering.spin_harmonics import (
    SpinHarmonics,
    build_spin_harmonics,
    fill_spin_harmonics,
    harmonic_count,
)
from skybake.scattering.suns import fill_suns
from skybake.transport.geometry import radius_at


class Polarisation(NamedTuple):
    """Linear polarisation of a diffuse field, as kernels read it.

    Attributes
    ----------
    harmonics : SpinHarmonics
        Recurrence of the harmonics that `moments` counts.
    source : ndarray of float64, shape (constituent, 3, order + 1, wavelength)
        Scattering coefficient times beta_l, alpha2_l and alpha3_l at density 1. [km⁻¹]
    moments : ndarray of float32, shape (altitude, sun, 2 * harmonic * wavelength)
        E_lm and then B_lm at the nodes of the field. [sr⁻¹]
    """

    harmonics: SpinHarmonics
    source: Array
    moments: npt.NDArray[np.float32]


class StokesScratch(NamedTuple):
    """Work space of `add_stokes`; each thread needs its own.

    Attributes
    ----------
    angle, node, weights, cosine : ndarray, shape (ray,), (ray,), (ray, 4) and (ray,)
        Of `fill_suns`.
    spins : ndarray, shape (2, harmonic)
        Harmonics.
    weight, scattering : ndarray of float32, shape (wavelength,) and (3, order + 1, wavelength)
        Of a step, and what it scatters.
    terms : ndarray of float32, shape (sun, 2, (order + 1) * wavelength)
        Terms of Q in cos(m psi) and of U in sin(m psi), at the nodes of the sun's angle.
    plain, turned : ndarray of float32, shape (wavelength,)
        What is scattered into E and into B.
    """

    angle: Array
    node: npt.NDArray[np.int64]
    weights: Array
    cosine: Array
    spins: Array
    weight: npt.NDArray[np.float32]
    scattering: npt.NDArray[np.float32]
    terms: npt.NDArray[np.float32]
    plain: npt.NDArray[np.float32]
    turned: npt.NDArray[np.float32]


def polarisation_of(
    scaled: ScaledMedium, order: int, moments: npt.NDArray[np.float32]
) -> Polarisation:
    """Put moments together with what scatters them."""
    source = scaled.medium.scattering[:, None, None] * scaled.matrix_moments[:, :, : order + 1]
    return Polarisation(build_spin_harmonics(order), np.ascontiguousarray(source), moments)


def allocate_stokes(polarisation: Polarisation, suns: int, fans: Fans) -> StokesScratch:
    """Make the work space for fans in a field."""
    widest = int(np.diff(fans.first).max())
    _, _, orders, wavelengths = polarisation.source.shape
    return StokesScratch(
        angle=np.empty(widest),
        node=np.empty(widest, np.int64),
        weights=np.empty((widest, 4)),
        cosine=np.empty(widest),
        spins=np.empty((2, harmonic_count(orders - 1))),
        weight=np.empty(wavelengths, np.float32),
        scattering=np.empty((3, orders, wavelengths), np.float32),
        terms=np.empty((suns, 2, orders * wavelengths), np.float32),
        plain=np.empty(wavelengths, np.float32),
        turned=np.empty(wavelengths, np.float32),
    )


@kernel
def add_stokes(field, radiance, polarisation, r_bottom, fans, begin, end, samples, scratch, out):
    """Add the polarised light that rays bring out of the diffuse field.

    Parameters
    ----------
    field, radiance : DiffuseField, ndarray
        The light to be scattered, and its moments from `side_by_side`.
    polarisation : Polarisation
        Its polarisation.
    r_bottom : float
        Radius of the ground, which polarises nothing. [km]
    fans, begin, end, samples
        As of `add_diffuse`.
    scratch : StokesScratch
        Work space.
    out : ndarray of float32, shape (ray, 2 * wavelength)
        Receives Q and U per unit irradiance, the sun to the left of the view. [sr⁻¹]
    """
    node, weights, cosine = scratch.node, scratch.weights, scratch.cosine
    for fan in range(begin, end):
        i, count = fans.first[fan], fans.first[fan + 1] - fans.first[fan]
        r, mu = fans.starts[fan, 0], fans.starts[fan, 1]
        first = samples.first[fan - begin]
        last = first + samples.number[fan - begin]
        for n in range(first, last, 2):
            share = _fill_scattering(polarisation, samples, n, scratch.weight, scratch.scattering)
            if share < 0.0:
                continue
            t = (1.0 - share) * samples.distance[n] + share * samples.distance[n + 1]
            radius = radius_at(r, mu, t)
            mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
            least, most = fill_suns(
                field, fans.rays, i, count, t, radius, mu_here, scratch.angle, node, weights, cosine
            )
            fill_spin_harmonics(polarisation.harmonics, mu_here, scratch.spins)
            low, u = altitude_weight(field, radius - r_bottom)
            for j in range(least, most):
                _sum_degrees(
                    radiance[low, j], radiance[low + 1, j], polarisation.moments[low, j],
                    polarisation.moments[low + 1, j], u, scratch, scratch.terms[j],
                )  # fmt: skip
            for q in range(count):
                _add_orders(scratch.terms, node[q], weights[q], cosine[q], out[i + q])


@kernel
def _fill_scattering(polarisation, samples, n, weight, out):
    """Write what a step scatters, (3, degree, wavelength); the second sample's share, or -1."""
    out[...] = 0.0
    first = second = 0.0
    for c in range(polarisation.source.shape[0]):
        low, high = samples.density[n, c], samples.density[n + 1, c]
        if low + high == 0.0:
            continue
        for k in range(weight.size):
            weight[k] = low * samples.weight[n, k] + high * samples.weight[n + 1, k]
            coefficient = polarisation.source[c, 1, 2, k]
            first += coefficient * low * samples.weight[n, k]
            second += coefficient * high * samples.weight[n + 1, k]
        for i in range(3):
            for degree in range(2, out.shape[1]):
                for k in range(weight.size):
                    out[i, degree, k] += (
                        np.float32(polarisation.source[c, i, degree, k]) * weight[k]
                    )
    return second / (first + second) if first + second > 0.0 else -1.0


@kernel
def _sum_degrees(below, above, spin_below, spin_above, u, scratch, out):
    """Sum over l of what is scattered at an altitude, by m and wavelength, (2, m * wavelength)."""
    scattering, plain, turned = scratch.scattering, scratch.plain, scratch.turned
    _, degrees, wavelengths = scattering.shape
    upper = np.float32(u)
    half = spin_below.size // 2
    out[...] = np.float32(0.0)
    place = 3
    for degree in range(2, degrees):
        beta, same, opposite = scattering[0, degree], scattering[1, degree], scattering[2, degree]
        for m in range(degree + 1):
            p = place * wavelengths
            low, high = below[p : p + wavelengths], above[p : p + wavelengths]
            low_e, high_e = spin_below[p : p + wavelengths], spin_above[p : p + wavelengths]
            low_b = spin_below[half + p : half + p + wavelengths]
            high_b = spin_above[half + p : half + p + wavelengths]
            even, odd = np.float32(scratch.spins[0, place]), np.float32(scratch.spins[1, place])
            q = m * wavelengths
            out_q, out_u = out[0, q : q + wavelengths], out[1, q : q + wavelengths]
            for k in range(wavelengths):
                plain[k] = beta[k] * (low[k] + upper * (high[k] - low[k])) + same[k] * (
                    low_e[k] + upper * (high_e[k] - low_e[k])
                )
                turned[k] = opposite[k] * (low_b[k] + upper * (high_b[k] - low_b[k]))
            for k in range(wavelengths):
                out_q[k] += even * plain[k] + odd * turned[k]
                out_u[k] += odd * plain[k] + even * turned[k]
            place += 1


@kernel
def _add_orders(terms, node, weights, cosine, out):
    """Add Q and U as Fourier series in azimuth, interpolated between four sun angles."""
    wavelengths = out.size // 2
    degrees = terms.shape[2] // wavelengths
    a, b = np.float32(weights[0]), np.float32(weights[1])
    c, d = np.float32(weights[2]), np.float32(weights[3])
    sine = math.sqrt(max(0.0, 1.0 - cosine * cosine))
    for i in range(2):
        at_a, at_b = terms[node, i], terms[node + 1, i]
        at_c, at_d = terms[node + 2, i], terms[node + 3, i]
        here = out[i * wavelengths : (i + 1) * wavelengths]
        # Cosines of multiples for Q, sines for U.
        before = cosine if i == 0 else -sine
        now = 1.0 if i == 0 else 0.0
        for m in range(degrees):
            factor = np.float32(now)
            for k in range(wavelengths):
                p = m * wavelengths + k
                here[k] += factor * (a * at_a[p] + b * at_b[p] + c * at_c[p] + d * at_d[p])
            before, now = now, 2.0 * cosine * now - before
