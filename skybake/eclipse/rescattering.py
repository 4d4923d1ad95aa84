"""Light that air scatters once more, by the direction in which it leaves."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.eclipse.diffuse import SLOPES
from skybake.jit.kernel import kernel
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.phase import eval_phase
from skybake.scattering.field import altitude_weight, sun_weights
from skybake.scattering.harmonics import fill_harmonics

Array = npt.NDArray[np.float64]

TURNS = 16
"""Azimuths, on one side, over which phase functions are averaged."""


def scatter_by_slope(scaled: ScaledMedium, altitude: float, mu: Array) -> Array:
    """Return how much of light from each zenith angle a place scatters on, by the slope of a ray.

    Parameters
    ----------
    scaled : ScaledMedium
        What scatters.
    altitude : float
        Of the place. [km]
    mu : ndarray of float64, shape (bundle,)
        Cosines of zenith angles, where light comes from evenly in azimuth.

    Returns
    -------
    ndarray of float64, shape (slope, bundle, wavelength)
        Over the same of all directions; slopes are `SLOPES`, of the ray that looks at the place.
    """
    medium = scaled.medium
    constituents = len(medium.extinction)
    turn = math.pi * (np.arange(TURNS) + 0.5) / TURNS
    sine, sine_in = np.sqrt(1.0 - SLOPES**2), np.sqrt(np.maximum(1.0 - mu**2, 0.0))
    flat = (sine[:, None] * sine_in)[..., None] * np.cos(turn)
    nu = np.clip((SLOPES[:, None] * mu)[..., None] + flat, -1.0, 1.0)
    phase = eval_phase(scaled.phase[:constituents], nu.ravel())
    phase = np.maximum(phase, 0.0).reshape(*nu.shape, constituents, -1).mean(axis=2)
    place = math.sqrt(altitude / (medium.r_top - medium.r_bottom)) * (len(medium.density) - 1)
    nodes = np.arange(len(medium.density))
    density = np.array([np.interp(place, nodes, each) for each in medium.density.T])
    amount = density[:, None] * medium.scattering
    total = np.maximum(amount.sum(axis=0), np.finfo(float).tiny)
    scattered: Array = 4.0 * math.pi * (phase * amount).sum(axis=2) / total
    return scattered


@kernel
def fill_scattered_again(
    field, samples, n, altitude, mu, mu_s, cosine, harmonic, chi, four, out
):  # fmt: skip
    """Write what a step scatters along a ray of light that was scattered before, by a whole sun.

    Parameters
    ----------
    field : DiffuseField
        That light.
    samples : Samples
        Of the ray.
    n : int
        First sample of the step.
    altitude : float
        Of the step. [km]
    mu, mu_s, cosine : float
        Cosines of the zenith angles there of the ray and of the sun, and of their azimuths'
        difference.
    harmonic, chi, four : ndarray of float64, shape (harmonic,), (degree, wavelength) and (4,)
        Work space.
    out : ndarray of float64, shape (wavelength,)
        Receives it, at least 0.
    """
    j = sun_weights(field, mu_s, four)
    low, u = altitude_weight(field, altitude)
    fill_harmonics(field.harmonics, mu, harmonic)
    for k in range(out.size):
        out[k] = 0.0
        for degree in range(chi.shape[0]):
            chi[degree, k] = 0.0
            for c in range(field.source.shape[0]):
                amount = samples.weight[n, k] * samples.density[n, c]
                amount += samples.weight[n + 1, k] * samples.density[n + 1, c]
                chi[degree, k] += amount * field.source[c, degree, k]
    for p in range(harmonic.size):
        m = field.harmonics.azimuthal[p]
        # The Chebyshev polynomial of the azimuth's cosine.
        before, value = cosine, 1.0
        for _ in range(m):
            before, value = value, 2.0 * cosine * value - before
        value *= harmonic[p]
        degree = field.harmonics.degree[p]
        for q in range(4):
            below, above = field.radiance[low, j + q, p], field.radiance[low + 1, j + q, p]
            weight = four[q] * value
            for k in range(out.size):
                out[k] += weight * chi[degree, k] * (below[k] + u * (above[k] - below[k]))
    for k in range(out.size):
        out[k] = max(out[k], 0.0)


@kernel
def nearest_slope(slopes, mu):
    """Return the one of `SLOPES` that is nearest to a cosine."""
    nearest = slopes[0]
    for each in slopes:
        if abs(each - mu) < abs(nearest - mu):
            nearest = each
    return nearest
