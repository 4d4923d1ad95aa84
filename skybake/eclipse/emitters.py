"""What air and ground around a place send to it, with nothing in front of the sun."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.eclipse.diffuse import SLOPES
from skybake.eclipse.rescattering import fill_scattered_again, nearest_slope, scatter_by_slope
from skybake.jit.kernel import kernel
from skybake.optics.phase import eval_phase
from skybake.scattering.field import fill_ground_irradiance
from skybake.scattering.tables import Atmosphere
from skybake.scattering.transmittance import fill_sun_column, fill_transmittance
from skybake.transport.samples import MAX_SAMPLES, allocate_samples
from skybake.transport.trace import MAX_ARC, trace

Array = npt.NDArray[np.float64]

ABOVE, BELOW, AROUND = 11, 5, 8
"""Zenith angles above the horizon and below it, and azimuths, of the rays that look around."""

SHORTEST, LONGER = 2.0, 0.1
"""Steps count as one emitter up to this length [km], and to this share of their distance."""


class Emitters(NamedTuple):
    """Places that send light to a receiver.

    Attributes
    ----------
    place : ndarray of float64, shape (emitter, 4)
        From the planet's centre: toward the sun's bearing at the receiver, to the right of it,
        and up [km]; and the cosine of the zenith angle there of the ray from the receiver, the
        nearest of `SLOPES`.
    bundle : ndarray of int64, shape (emitter,)
        Which of the zenith angles at the receiver it is seen at.
    on_ground : ndarray of bool, shape (emitter,)
        Whether it is ground.
    sunlight, diffuse : ndarray of float64, shape (emitter, wavelength)
        What is sent of sunlight, and of light that was scattered before, per unit irradiance.
    scatter : ndarray of float64, shape (slope, bundle, wavelength)
        How much of the light of a bundle the receiver scatters on, to an observer whose ray has a
        slope of `SLOPES`, over the same of all directions.
    """

    place: Array
    bundle: npt.NDArray[np.int64]
    on_ground: npt.NDArray[np.bool_]
    sunlight: Array
    diffuse: Array
    scatter: Array


def look_around(
    atmosphere: Atmosphere, altitude: float, mu_s: float, *, horizontally: bool
) -> Emitters:
    """Return what is sent to a place.

    Parameters
    ----------
    atmosphere : Atmosphere
        What scatters.
    altitude : float
        Of the place. [km]
    mu_s : float
        Cosine of the sun's zenith angle there.
    horizontally : bool
        Weigh directions for the irradiance of the horizontal from above; else for the mean
        radiance.
    """
    scaled, field = atmosphere.scaled, atmosphere.field
    r = scaled.medium.r_bottom + altitude
    mu, weight = _zeniths(r, scaled.medium.r_bottom, horizontally=horizontally)
    azimuth = 2.0 * math.pi * (np.arange(AROUND) + 0.5) / AROUND
    sine, sine_s = np.sqrt(1.0 - mu * mu), math.sqrt(max(1.0 - mu_s * mu_s, 0.0))
    nu = mu[:, None] * mu_s + sine[:, None] * sine_s * np.cos(azimuth)
    nu = np.clip(nu, -1.0, 1.0)
    constituents = len(scaled.medium.extinction)
    phase = eval_phase(scaled.phase[:constituents], nu.ravel())
    phase = np.maximum(phase, 0.0).reshape(*nu.shape, constituents, -1)
    samples = allocate_samples(scaled.medium)
    starts = np.stack([np.full(mu.size, r), mu], axis=1)
    wavelengths = scaled.mixture.size
    orders = field.harmonics.order + 1
    scratch = (
        *(np.empty(constituents), np.empty(wavelengths), np.empty(4)),
        *(np.empty(field.harmonics.degree.size), np.empty((orders, wavelengths))),
        np.empty(wavelengths),
    )
    most = MAX_SAMPLES // 2 + 1
    parts = []
    for i in range(mu.size):
        trace(scaled.medium, atmosphere.shells, MAX_ARC, starts, i, i + 1, samples)
        for q in range(AROUND):
            place, sunlight, diffuse = (np.empty((most, n)) for n in (4, wavelengths, wavelengths))
            count = _emit(
                scaled.medium,
                atmosphere.columns,
                field,
                samples,
                np.array([r, mu[i], mu_s, nu[i, q]]),
                float(azimuth[q]),
                SLOPES,
                np.ascontiguousarray(phase[i, q]),
                *scratch,
                place,
                sunlight,
                diffuse,
            )
            on_ground = np.zeros(count, np.bool_)
            on_ground[count - int(samples.hits_ground[0]) :] = True
            size = weight[i] / AROUND
            bundle = np.full(count, i)
            light = size * sunlight[:count], size * diffuse[:count]
            parts.append((place[:count], bundle, on_ground, *light))
    place, bundle, on_ground, sunlight, diffuse = (
        np.concatenate(each) for each in zip(*parts, strict=True)
    )
    scatter = np.ones((SLOPES.size, ABOVE + BELOW, wavelengths))
    if not horizontally:
        scatter = scatter_by_slope(scaled, altitude, mu)
    return Emitters(place, bundle, on_ground, sunlight, diffuse, scatter)


def _zeniths(r: float, r_bottom: float, *, horizontally: bool) -> tuple[Array, Array]:
    """Cosines of zenith angles, which crowd at the horizon, and their weights."""
    horizon = math.pi - math.asin(min(1.0, r_bottom / r))
    node, share = np.polynomial.legendre.leggauss(ABOVE)
    x = 0.5 * (node + 1.0)
    zenith = horizon * (1.0 - x * x)
    weight = horizon * x * share * np.sin(zenith)
    if horizontally:
        weight = weight * np.maximum(np.cos(zenith), 0.0)
    else:
        node, share = np.polynomial.legendre.leggauss(BELOW)
        x = 0.5 * (node + 1.0)
        below = horizon + (math.pi - horizon) * x * x
        zenith = np.concatenate([zenith, below])
        weight = np.concatenate([weight, (math.pi - horizon) * x * share * np.sin(below)])
    return np.cos(zenith), weight


@kernel
def _emit(
    medium, columns, field, samples, ray, azimuth, slopes, phase, column, through, four, harmonic,
    chi, again, place, sunlight, diffuse,
):  # fmt: skip
    """Write where a ray's steps and its end on the ground are, and what they send back."""
    r, mu, mu_s, nu = ray[0], ray[1], ray[2], ray[3]
    sine = math.sqrt(max(1.0 - mu * mu, 0.0))
    ahead, right = sine * math.cos(azimuth), sine * math.sin(azimuth)
    count = np.int64(-1)
    begin, moment, mass = 0.0, 0.0, 0.0
    for n in range(0, samples.number[0], 2):
        t = 0.5 * (samples.distance[n] + samples.distance[n + 1])
        if count < 0 or t - begin > max(SHORTEST, LONGER * t):
            count += 1
            begin, moment, mass = t, 0.0, 0.0
            sunlight[count] = 0.0
            diffuse[count] = 0.0
        radius = 0.5 * (samples.radius[n] + samples.radius[n + 1])
        mu_s_here = min(max((r * mu_s + t * nu) / radius, -1.0), 1.0)
        is_lit = fill_sun_column(columns, medium.r_bottom, medium.r_top, radius, mu_s_here, column)
        fill_transmittance(medium.extinction, column, through)
        mu_here = min(max((r * mu + t) / radius, -1.0), 1.0)
        flat = math.sqrt((1.0 - mu_here * mu_here) * (1.0 - mu_s_here * mu_s_here))
        cosine = (nu - mu_here * mu_s_here) / max(flat, 1e-9)
        cosine = min(max(cosine, -1.0), 1.0)
        fill_scattered_again(
            field, samples, n, radius - medium.r_bottom, mu_here, mu_s_here, cosine,
            harmonic, chi, four, again,
        )  # fmt: skip
        for k in range(through.size):
            once = 0.0
            for c in range(column.size):
                amount = 0.0
                for i in range(2):
                    amount += samples.weight[n + i, k] * samples.density[n + i, c]
                once += amount * medium.scattering[c, k] * phase[c, k]
            once = once * through[k] if is_lit else 0.0
            sunlight[count, k] += once
            diffuse[count, k] += again[k]
            mass += once + again[k]
            moment += (once + again[k]) * t
        middle = moment / mass if mass > 0.0 else t
        _put(place[count], middle * ahead, middle * right, r + middle * mu)
        place[count, 3] = nearest_slope(slopes, mu_here)
    count += 1
    if samples.hits_ground[0]:
        t = samples.length[0]
        mu_s_here = (r * mu_s + t * nu) / medium.r_bottom
        is_lit = mu_s_here > 0.0
        fill_sun_column(columns, medium.r_bottom, medium.r_top, medium.r_bottom, mu_s_here, column)
        fill_transmittance(medium.extinction, column, through)
        for k in range(through.size):
            behind = medium.ground_albedo[k] / math.pi * samples.transmittance[0, k]
            sunlight[count, k] = behind * mu_s_here * through[k] if is_lit else 0.0
            diffuse[count, k] = behind
        fill_ground_irradiance(field, mu_s_here, four, through)
        for k in range(through.size):
            diffuse[count, k] *= through[k]
        _put(place[count], t * ahead, t * right, r + t * mu)
        count += 1
    return count


@kernel
def _put(out, x, y, z):
    out[0], out[1], out[2], out[3] = x, y, z, -1.0
