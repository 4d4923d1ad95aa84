"""Linear polarisation of the diffuse field, and what it adds to the light that is scattered.

Of the polarised light, in which Q is even about the sun's plane and U odd, the field holds the
moments E_2m = integral (Q W_m cos(m psi) + U X_m sin(m psi)), psi being the sun's azimuth to
the left of the view's. Molecules scatter no others, and their light is most of what is polarised.
They follow the moments of the radiance in the field's array.
"""

from __future__ import annotations

import math

import numpy as np

from skybake.jit.kernel import kernel
from skybake.optics.medium import Array

ORDERS = 3
"""m = 0, 1 and 2."""

FIRST = 3
"""Place among the harmonics of the first of degree 2."""

_ZERO = math.sqrt(15.0 / (32.0 * math.pi))
_OTHER = math.sqrt(5.0 / (8.0 * math.pi))


def spin_functions(mu: Array) -> tuple[Array, Array]:
    """W_m and X_m of several mu, each of shape (mu, ORDERS)."""
    sine = np.sqrt(np.maximum(1.0 - mu**2, 0.0))
    even = np.stack([_ZERO * sine**2, -_OTHER * mu * sine, 0.5 * _OTHER * (1.0 + mu**2)], axis=1)
    odd = np.stack([np.zeros_like(mu), _OTHER * sine, -_OTHER * mu], axis=1)
    return even, odd


@kernel
def fill_spin_functions(mu, out):
    """Write W_m and X_m to `out`, shape (2, ORDERS)."""
    sine = math.sqrt(max(0.0, 1.0 - mu * mu))
    out[0, 0] = _ZERO * sine * sine
    out[0, 1] = -_OTHER * mu * sine
    out[0, 2] = 0.5 * _OTHER * (1.0 + mu * mu)
    out[1, 0] = 0.0
    out[1, 1] = _OTHER * sine
    out[1, 2] = -_OTHER * mu


@kernel
def fill_polarised_scattering(field, samples, n, weight, out):
    """Write weight * coefficient * (beta_2, alpha2_2) of a step's samples, (2, wavelength).

    Returns whether the field is polarised at all.
    """
    if field.polarised.shape[0] == 0:
        return False
    out[...] = 0.0
    for c in range(field.polarised.shape[0]):
        low, high = samples.density[n, c], samples.density[n + 1, c]
        if low + high == 0.0:
            continue
        for k in range(weight.size):
            weight[k] = low * samples.weight[n, k] + high * samples.weight[n + 1, k]
        for i in range(2):
            for k in range(weight.size):
                out[i, k] += np.float32(field.polarised[c, i, k]) * weight[k]
    return True


@kernel
def add_polarised_source(below, above, u, harmonic, scattering, fourier, twist):
    """Add what polarised light adds to the scattered radiance; what is scattered polarised.

    Parameters
    ----------
    below, above, u : ndarray, ndarray, float
        Moments at the altitudes around a sample, and the share of the upper.
    harmonic : ndarray
        Harmonics at the sample.
    scattering : ndarray of float32, shape (2, wavelength)
        Result of `fill_polarised_scattering`.
    fourier : ndarray of float32, shape (order * wavelength,)
        Terms of the radiance, which are added to.
    twist : ndarray of float32, shape (ORDERS * wavelength,)
        Receives the moments of the polarised light that is scattered.
    """
    wavelengths, upper = scattering.shape[1], np.float32(u)
    last = below.size - ORDERS * wavelengths
    for m in range(ORDERS):
        value = np.float32(harmonic[FIRST + m])
        for k in range(wavelengths):
            p, q = (FIRST + m) * wavelengths + k, last + m * wavelengths + k
            plain = below[p] + upper * (above[p] - below[p])
            polarised = below[q] + upper * (above[q] - below[q])
            fourier[m * wavelengths + k] += value * scattering[0, k] * polarised
            twist[m * wavelengths + k] = scattering[0, k] * plain + scattering[1, k] * polarised


@kernel
def add_twists(twist, node, weights, cosine, spins, series, out):
    """Add Q and U of scattered light to the rays of a fan, (ray, 2 * wavelength).

    Rays are interpolated between four suns as `node` and `weights` say; the sun is to the left.
    Indices are unsigned as those of `skybake.scattering.field_sums.add_orders`.
    """
    lanes = np.uint64(out.shape[1] // 2)
    third = lanes + lanes
    for i in range(out.shape[0]):
        j, cos = node[i], cosine[i]
        a, b = np.float32(weights[i, 0]), np.float32(weights[i, 1])
        c, d = np.float32(weights[i, 2]), np.float32(weights[i, 3])
        for p in range(series.size):
            series[p] = (
                a * twist[j, p] + b * twist[j + 1, p] + c * twist[j + 2, p] + d * twist[j + 3, p]
            )
        sine = math.sqrt(max(0.0, 1.0 - cos * cos))
        even_0, even_1 = np.float32(spins[0, 0]), np.float32(spins[0, 1] * cos)
        even_2 = np.float32(spins[0, 2] * (2.0 * cos * cos - 1.0))
        odd_1, odd_2 = np.float32(spins[1, 1] * sine), np.float32(spins[1, 2] * 2.0 * sine * cos)
        for k in range(lanes):
            first, second = series[k], series[lanes + k]
            out[i, k] += even_0 * first + even_1 * second + even_2 * series[third + k]
        for k in range(lanes):
            out[i, lanes + k] += odd_1 * series[lanes + k] + odd_2 * series[third + k]
