"""Stokes vectors by the path tracer."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.optics.matrix import scattering_plane
from skybake.optics.medium import Medium
from skybake.optics.phase import eval_phase
from skybake.reference.batches import estimate_means, samples_per_batch
from skybake.reference.estimate import Array, directions_of, models_of
from skybake.reference.paths import mean_stokes
from skybake.reference.single import trace_single


def stokes(
    medium: Medium,
    altitude: float,
    sun_elevation: float,
    view_zenith: npt.ArrayLike,
    relative_azimuth: npt.ArrayLike,
    *,
    samples: int,
    seed: int = 0,
) -> tuple[Array, Array]:
    """Stokes vectors of the sky by backward Monte Carlo, unbiased, with their standard errors.

    Vector radiative transfer without circular polarisation; all else, parameters and errors are
    those of `skybake.reference.estimate.radiance`. Azimuths count clockwise from the sun's, as of
    `skybake.sky.stokes`.

    Returns
    -------
    mean, stderr : ndarray of float64, shape (direction, 4, wavelength)
        As `skybake.sky.stokes` defines them, per unit solar irradiance at the top of the
        atmosphere. [sr⁻¹]

    Raises
    ------
    InputError
        If an argument is out of range, or the medium has no matrices.
    """
    if not medium.extinction.any():
        raise InputError("polarisation: world must have something that scatters light, got none")
    if not len(medium.matrix):
        raise InputError("polarisation: medium must have scattering matrices, got none")
    sun, views = directions_of(altitude, sun_elevation, view_zenith, relative_azimuth)
    # Seen from above, x to y is counter-clockwise.
    views = [(x, -y, z) for x, y, z in views]
    models, per_batch = models_of(medium), samples_per_batch(samples)

    def mean_of(view: int, wavelength: int, batch: np.uint64) -> Array:
        air, guide = models[wavelength]
        return mean_stokes(air, guide, sun, altitude, views[view], 2, per_batch, batch)

    mean, stderr = (
        np.pad(each, ((0, 0), (0, 0), (0, 1))).transpose(0, 2, 1)
        for each in estimate_means(len(views), len(models), seed, mean_of, (3,))
    )
    mean = mean + _single(medium, altitude, np.array(views), np.array(sun))
    return mean, stderr


def _single(medium: Medium, altitude: float, views: Array, sun: Array) -> Array:
    """Stokes vectors of light scattered or reflected once, (direction, 4, wavelength)."""
    mu, nu = views[:, 2].copy(), np.clip(views @ sun, -1.0, 1.0)
    r, mu_s = np.full(mu.shape, medium.r_bottom + altitude), np.full(mu.shape, sun[2])
    light = trace_single(medium, r, mu, mu_s, nu)
    whole = (light.single * eval_phase(medium.phase, nu)).sum(axis=1) + light.ground
    across = (light.single * eval_phase(medium.matrix[:, 0], nu)).sum(axis=1)
    even, odd = scattering_plane(mu, mu_s, nu).T
    # The sun is to the right where the view is to the left of the sun's plane.
    odd = np.where(views[:, 1] > 0.0, -odd, odd)
    zero = np.zeros_like(whole)
    return np.stack([whole, across * even[:, None], across * odd[:, None], zero], axis=1)
