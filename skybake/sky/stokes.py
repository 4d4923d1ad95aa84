"""Stokes vectors of the sky, and what they say of the light.

S0 is the radiance. S1 is positive if the E-vector is in the vertical plane through the view, S2
if it is turned from there by 45 degrees counter-clockwise, as seen by an observer who looks along
the view. S3, circular polarisation, is below a hundredth of S0 and taken as 0.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skybake.optics.matrix import scattering_plane
from skybake.optics.phase import eval_phase
from skybake.scattering.polarisation_tables import load_polarisation
from skybake.scattering.ray import trace_rays
from skybake.scattering.stokes_solver import trace_stokes

if TYPE_CHECKING:
    from skybake.optics.medium import Array
    from skybake.sky.skylight import Skylight
    from skybake.sky.source import Source


def stokes_of(skylight: Skylight, unit: Array) -> Array:
    """Stokes vectors by all sources of a skylight.

    Parameters
    ----------
    skylight : Skylight
        The observer, sources and atmosphere.
    unit : ndarray of float64, shape (..., 3)
        Directions of length 1, as of `Skylight.radiance`.

    Returns
    -------
    ndarray of float64, shape (..., 4, wavelength)
        [W m⁻² sr⁻¹ nm⁻¹]
    """
    flat = unit.reshape(-1, 3)
    count = skylight.atmosphere.medium.ground_albedo.size
    stokes = np.zeros((len(flat), 4, count))
    for source in skylight.sources:
        nu = np.clip(flat @ source.direction, -1.0, 1.0)
        one = stokes_per_irradiance(skylight, source, flat[:, 1], nu)
        # Left of the view is up times forward: (z, -x) of its horizontal part.
        sun = source.direction
        is_right = flat[:, 2] * sun[0] - flat[:, 0] * sun[2] < 0.0
        one[is_right, 2] *= -1.0
        stokes += one * source.irradiance
    return stokes.reshape(*unit.shape[:-1], 4, count)


def stokes_per_irradiance(skylight: Skylight, source: Source, mu: Array, nu: Array) -> Array:
    """Stokes vectors per unit irradiance of one source, which is to the left of the view.

    Parameters
    ----------
    skylight : Skylight
        The observer and the atmosphere.
    source : Source
        What lights it.
    mu, nu : ndarray of float64, shape (n,)
        Cosines of the zenith angle of a direction and of its angle to the source.

    Returns
    -------
    ndarray of float64, shape (n, 4, wavelength)
        [sr⁻¹]
    """
    atmosphere, count = skylight.atmosphere, skylight.atmosphere.medium.ground_albedo.size
    polarisation = load_polarisation(atmosphere, skylight.workers)
    mu_s = np.full(mu.shape, source.mu)
    rays = np.full(mu.shape, skylight.radius), mu, mu_s, nu
    light = trace_rays(atmosphere, *rays, workers=skylight.workers)
    single = light.single[..., :count]
    stokes = np.zeros((mu.size, 4, count))
    stokes[:, 0] = (single * eval_phase(skylight.phase, nu)).sum(axis=1) + light.diffuse[:, :count]
    across = (
        single[:, : len(atmosphere.medium.matrix)] * eval_phase(sun_matrix(skylight), nu)
    ).sum(axis=1)
    stokes[:, 1:3] = across[:, None] * scattering_plane(mu, mu_s, nu)[..., None]
    diffuse = trace_stokes(
        atmosphere, polarisation, np.stack(rays, axis=1), workers=skylight.workers
    )
    stokes[:, 1:3] += diffuse[..., :count]
    return stokes


def sun_matrix(skylight: Skylight) -> Array:
    """P12 that multiplies `RayLight.single` of each constituent, as `Skylight.phase` does. [sr⁻¹]

    What peaks scatter goes straight on first and polarises nothing.
    """
    medium, scaled = skylight.atmosphere.medium, skylight.atmosphere.scaled
    kept = 1.0 - scaled.fraction[:, : medium.ground_albedo.size]
    across: Array = medium.matrix[:, 0] / kept[:, None]
    return across


def linear_polarisation(stokes: Array) -> tuple[Array, Array]:
    """Degree and angle of linear polarisation.

    Parameters
    ----------
    stokes : ndarray, shape (..., 4, wavelength)
        Stokes vectors.

    Returns
    -------
    degree, angle : ndarray of float64, shape (..., wavelength)
        From 0 to 1; of the E-vector from the zenith's direction counter-clockwise, in
        (-pi/2, pi/2]. [rad]
    """
    whole, even, odd = stokes[..., 0, :], stokes[..., 1, :], stokes[..., 2, :]
    degree = np.hypot(even, odd) / np.where(whole > 0.0, whole, 1.0)
    return np.minimum(degree, 1.0), 0.5 * np.arctan2(odd, even)
