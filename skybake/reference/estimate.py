"""What the path tracer computes: radiances, their first order, irradiances."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.jit.workers import ALL_CPUS
from skybake.optics.medium import Medium
from skybake.optics.phase import eval_phase
from skybake.reference.air import Air, air_at
from skybake.reference.batches import estimate_means, samples_per_batch
from skybake.reference.directions import Direction
from skybake.reference.guide import Guide, make_guide
from skybake.reference.occultation import Occultation, no_occultation, uncovered_share
from skybake.reference.paths import mean_irradiance, mean_radiance
from skybake.reference.rays import transmittance_to_space
from skybake.reference.single import trace_single

Array = npt.NDArray[np.float64]

_ENDLESS = np.iinfo(np.int64).max


class Irradiance(NamedTuple):
    """Irradiances on horizontal planes, per unit solar irradiance; each of shape (wavelength,).

    Attributes
    ----------
    transmittance : ndarray of float64
        From the observer toward the sun's centre.
    direct : ndarray of float64
        Of sunlight on the upper side of the plane.
    down, down_stderr : ndarray of float64
        Of scattered light on the upper side, and its standard error.
    up, up_stderr : ndarray of float64
        Of scattered and reflected light on the lower side.
    """

    transmittance: Array
    direct: Array
    down: Array
    down_stderr: Array
    up: Array
    up_stderr: Array


def radiance(
    medium: Medium,
    altitude: float,
    sun_elevation: float,
    view_zenith: npt.ArrayLike,
    relative_azimuth: npt.ArrayLike,
    *,
    samples: int,
    seed: int = 0,
    orders: tuple[int, float] | None = None,
    occultations: Sequence[Occultation] | None = None,
) -> tuple[Array, Array]:
    """Radiance of the sky by backward Monte Carlo, unbiased, with its standard error.

    Scalar radiative transfer in a spherical atmosphere over a Lambertian ground,
    straight rays, the sun as a point whose direct view is excluded.

    Parameters
    ----------
    medium : Medium
    altitude : float
        Of the observer, also above the atmosphere, >= 0. [km]
    sun_elevation : float
        At the observer. [rad]
    view_zenith, relative_azimuth : array_like, broadcast to shape (direction,)
        Zenith angle of the view, 0 = up, and its azimuth from the sun's. [rad]
    samples : int
        Paths for each direction and wavelength, rounded up to a multiple of
        `BATCHES`.
    seed : int, optional
        Same seed, same result, for any number of threads.
    orders : (int, float), optional
        First and last order of scattering, a reflection being one; the last may
        be ``math.inf``. All of them are then sampled. Without it the first order
        comes from `single_scattering` and paths carry the others, which is
        much less noisy.
    occultations : sequence of Occultation, optional
        What is in front of the sun, at each wavelength; all orders are then sampled.

    Returns
    -------
    mean, stderr : ndarray of float64, shape (direction, wavelength)
        Per unit solar irradiance at the top of the atmosphere. [sr⁻¹]

    Raises
    ------
    InputError
        If an argument is out of range.

    Notes
    -----
    A path's vertices are drawn on each of its rays by what a rough light field
    promises there, and are lit by the sun through exact transmittances; its
    directions are drawn around the last one, around the sun, or by the light
    field, and weighted by the balance heuristic (Veach 1997, eq. 9.8). In deep
    twilight and in a thick atmosphere with a narrow phase function the error's distribution
    has a long tail: trust a standard error only if it halves with four times
    the samples.
    """
    if occultations is not None and orders is None:
        orders = 1, math.inf
    first, last = (2, math.inf) if orders is None else orders
    if first < 1 or last < first:
        message = f"orders: must be 1 <= first <= last, got {orders}"
        raise InputError(message)
    last = _ENDLESS if math.isinf(last) else int(last)
    sun, views = directions_of(altitude, sun_elevation, view_zenith, relative_azimuth)
    models = models_of(medium)
    per_batch = samples_per_batch(samples)

    def mean_of(view: int, wavelength: int, batch: np.uint64) -> float:
        air, guide = models[wavelength]
        veil = no_occultation() if occultations is None else occultations[wavelength]
        rays = sun, veil, altitude, views[view]
        return mean_radiance(air, guide, *rays, first, last, per_batch, batch)

    mean, stderr = estimate_means(len(views), len(models), seed, mean_of)
    if orders is None:
        mean += single_scattering(medium, altitude, sun_elevation, view_zenith, relative_azimuth)
    return mean, stderr


def single_scattering(
    medium: Medium,
    altitude: float,
    sun_elevation: float,
    view_zenith: npt.ArrayLike,
    relative_azimuth: npt.ArrayLike,
) -> Array:
    """Radiance of light scattered or reflected exactly once, by quadrature.

    Parameters and errors are those of `radiance`.

    Returns
    -------
    ndarray of float64, shape (direction, wavelength)
        Per unit solar irradiance at the top of the atmosphere. [sr⁻¹]
    """
    sun, views = directions_of(altitude, sun_elevation, view_zenith, relative_azimuth)
    direction = np.array(views)
    mu, nu = direction[:, 2].copy(), np.clip(direction @ sun, -1.0, 1.0)
    r, mu_s = np.full(mu.shape, medium.r_bottom + altitude), np.full(mu.shape, sun[2])
    light = trace_single(medium, r, mu, mu_s, nu)
    radiance: Array = (light.single * eval_phase(medium.phase, nu)).sum(axis=1) + light.ground
    return radiance


def irradiance(
    medium: Medium,
    altitude: float,
    sun_elevation: float,
    *,
    samples: int,
    seed: int = 0,
    occultations: Sequence[Occultation] | None = None,
) -> Irradiance:
    """Direct and diffuse irradiance on a horizontal plane, by backward Monte Carlo.

    Parameters and errors are those of `radiance`; every order is sampled. An occultation leaves
    the transmittance as it is.
    """
    sun, _ = directions_of(altitude, sun_elevation, 0.0, 0.0)
    models = models_of(medium)
    per_batch = samples_per_batch(samples)

    def mean_of(side: int, wavelength: int, batch: np.uint64) -> float:
        air, guide = models[wavelength]
        veil = no_occultation() if occultations is None else occultations[wavelength]
        return mean_irradiance(air, guide, sun, veil, altitude, 1.0 - 2.0 * side, per_batch, batch)

    mean, stderr = estimate_means(2, len(models), seed, mean_of)
    transmittance = np.array([transmittance_to_space(air, altitude, sun[2]) for air, _ in models])
    shares = np.ones(len(models))
    for i, veil in enumerate(occultations or ()):
        shares[i] = uncovered_share(veil, 0.0, 0.0, 0.0)
    direct = shares * transmittance * max(0.0, sun[2])
    return Irradiance(transmittance, direct, mean[0], stderr[0], mean[1], stderr[1])


def models_of(medium: Medium) -> list[tuple[Air, Guide]]:
    """Air and guide of each wavelength."""
    airs = [air_at(medium, wavelength) for wavelength in range(len(medium.ground_albedo))]
    guides: list[Guide] = [None] * len(airs)  # type: ignore[list-item]

    def build(begin: int, end: int) -> None:
        for i in range(begin, end):
            guides[i] = make_guide(airs[i])

    ALL_CPUS.run_rows(len(airs), build)
    return list(zip(airs, guides, strict=True))


def directions_of(
    altitude: float,
    sun_elevation: float,
    view_zenith: npt.ArrayLike,
    relative_azimuth: npt.ArrayLike,
) -> tuple[Direction, list[Direction]]:
    """Sun and views as unit vectors, +Z up and the sun's azimuth along +X."""
    zenith, azimuth = np.broadcast_arrays(
        np.atleast_1d(np.asarray(view_zenith, dtype=np.float64)), relative_azimuth
    )
    for name, values in (
        ("altitude", altitude),
        ("sun_elevation", sun_elevation),
        ("view_zenith", zenith),
        ("relative_azimuth", azimuth),
    ):
        if not np.all(np.isfinite(values)):
            message = f"{name}: must be finite, got {values}"
            raise InputError(message)
    if altitude < 0.0:
        message = f"altitude: must be >= 0 km, got {altitude}"
        raise InputError(message)
    sun = (math.cos(sun_elevation), 0.0, math.sin(sun_elevation))
    x, y, z = np.sin(zenith) * np.cos(azimuth), np.sin(zenith) * np.sin(azimuth), np.cos(zenith)
    return sun, [(float(a), float(b), float(c)) for a, b, c in zip(x, y, z, strict=True)]
