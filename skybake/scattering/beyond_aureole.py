"""Light that peaks alone have scattered farther from the sun than the aureole reaches.

The final ray takes the last scattering of such light for the place where it turned. Where
peaks scatter it once more along a line of sight, as they do for a long way at the horizon, it
turned before; what is missing is the difference between true paths and straight ones, as in
the aureole. Azimuthal orders of the diffuse field hold that difference only for high suns: around
a low one its ripples are as fine in azimuth as in angle.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.angles import cosine_between
from skybake.jit.workers import ONE_CPU, Workers
from skybake.optics.delta_m import PEAK_NODES
from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.scattering.aureole_solver import straight_light
from skybake.scattering.grid import Grid, azimuths, no_field
from skybake.scattering.passes import rays_at
from skybake.scattering.ray import trace_rays
from skybake.scattering.rings import FADES_FROM, fade
from skybake.scattering.tables import Atmosphere
from skybake.transport.shells import altitude_shells

SHELLS = 15
ARC = math.radians(2.0)

TRACED = azimuths(7)
"""Azimuths at which rays are traced: before its phase function light is smooth. [rad]"""

FINE = azimuths(23)
"""Azimuths at which phase functions are applied, whose ripples are finer than a grid's. [rad]"""

NODES = 0, 3, 7
"""Of `PEAK_NODES`, those between which phase functions are interpolated."""

HIGHEST, LOWEST = math.radians(45.0), math.radians(70.0)
"""Zenith angles of the sun between which the difference is given up. [rad]"""

ANGLES = 146
"""Angles from the sun at which straight light is tabulated."""


def light_beyond_aureole(
    atmosphere: Atmosphere, grid: Grid, moments: Array, workers: Workers
) -> npt.NDArray[np.float32]:
    """Radiance that peaks alone have scattered, less what goes straight, beyond the aureole.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns.
    grid : Grid
        Nodes of altitude, sun and direction.
    moments : ndarray, shape (constituent, `SERIES_ORDER` + 1, wavelength)
        Of the peaks.
    workers : Workers
        Who does the work.

    Returns
    -------
    ndarray of float32, shape (altitude, polar, sun, azimuth, wavelength)
        Only azimuthal orders that the grid resolves, and none under low suns. [sr⁻¹]
    """
    scaled = atmosphere.scaled
    high = grid.sun_angle[grid.sun_angle < LOWEST]
    shape = *grid.mu.shape, grid.sun_angle.size, grid.azimuth.size, scaled.mixture.size
    out = np.zeros(shape, np.float32)
    grid = grid._replace(sun_angle=high)
    coarse = atmosphere._replace(
        shells=altitude_shells(scaled.medium, SHELLS), field=no_field(scaled)
    )
    phases = scaled.phase[scaled.medium.phase.shape[0] :]
    phases = phases.reshape(-1, PEAK_NODES.size, *phases.shape[1:])[:, NODES]
    phases = phases.reshape(-1, *phases.shape[2:])
    angles = np.linspace(FADES_FROM, math.pi, ANGLES)
    straight = straight_light(atmosphere, grid, np.cos(angles), moments, workers)
    to_fine = _cosine_series(TRACED, FINE, TRACED.size)
    to_grid = _cosine_series(FINE, grid.azimuth, grid.azimuth.size)
    traced = grid._replace(azimuth=TRACED)
    mu_s, sines = np.cos(grid.sun_angle)[:, None], np.sin(grid.sun_angle)[:, None]
    kept = _kept(high)[:, None, None]

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            mu = grid.mu[i, :, None, None]
            light = trace_rays(coarse, *rays_at(scaled, traced, i).T, max_arc=ARC, workers=ONE_CPU)
            single = _between_nodes(light.single, len(phases)).reshape(
                len(mu), high.size, TRACED.size, -1
            )
            nu = cosine_between(mu, np.sqrt(1.0 - mu**2), mu_s, sines, FINE)
            nu = np.clip(nu, -1.0, 1.0)
            at_fine = np.matmul(to_fine, single).reshape(nu.size, len(phases), -1)
            radiance = (at_fine * eval_phase(phases, nu.ravel())).sum(axis=1).reshape(*nu.shape, -1)
            angle = np.arccos(nu)
            radiance -= _at_angles(straight[i], angle)
            radiance *= (1.0 - fade(angle))[..., None]
            out[i, :, : high.size] = np.matmul(to_grid, radiance * kept)

    workers.run_rows(len(grid.mu), work)
    return out


def _kept(sun_angle: Array) -> Array:
    """Share of the difference that is kept at zenith angles of the sun."""
    fading = np.clip((sun_angle - HIGHEST) / (LOWEST - HIGHEST), 0.0, 1.0)
    share: Array = np.cos(0.5 * math.pi * fading) ** 2
    return share


def _between_nodes(single: Array, functions: int) -> Array:
    """Light of peaks for the phase functions at `NODES`, shape (ray, function, wavelength)."""
    rays, _, wavelengths = single.shape
    peaked = functions // len(NODES)
    light = single[:, -peaked * PEAK_NODES.size :].reshape(rays, peaked, PEAK_NODES.size, -1)
    at = PEAK_NODES[list(NODES)]
    share = np.stack([np.interp(PEAK_NODES, at, each) for each in np.eye(len(NODES))])
    between: Array = np.matmul(share, light).reshape(rays, functions, wavelengths)
    return between


def _at_angles(straight: npt.NDArray[np.float32], angle: Array) -> Array:
    """Interpolate straight light, (sun, angle, wavelength), at angles (polar, sun, azimuth)."""
    position = (angle - FADES_FROM) * ((ANGLES - 1) / (math.pi - FADES_FROM))
    position = np.maximum(position, 0.0)
    low = np.minimum(position.astype(int), ANGLES - 2)
    share = (position - low)[..., None]
    sun = np.arange(len(straight))[:, None]
    between: Array = (1.0 - share) * straight[sun, low] + share * straight[sun, low + 1]
    return between


def _cosine_series(known: Array, wanted: Array, orders: int) -> Array:
    """Weights by which values at midpoints of azimuths give those at others, (wanted, known)."""
    order = np.arange(orders)
    weight = np.where(order > 0, 2.0, 1.0)[:, None] / known.size
    series: Array = np.cos(np.outer(wanted, order)) @ (weight * np.cos(np.outer(order, known)))
    return series
