"""Solving for the aureole of bent paths, at the nodes of the diffuse field."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS, ONE_CPU, Workers
from skybake.optics.delta_m import SERIES_ORDER, peak_moments, peaked_shares
from skybake.optics.legendre import legendre_polynomials
from skybake.optics.medium import Array, pad_wavelengths, vertical_columns
from skybake.optics.phase import eval_phase
from skybake.scattering.aureole import (
    ANGLES,
    LAST_ANGLE,
    ORDERS,
    Aureole,
    add_aureole,
    allocate_aureole_scratch,
)
from skybake.scattering.fans import group_rays
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import Grid, no_field
from skybake.scattering.harmonics import build_harmonics, harmonics_at
from skybake.scattering.ray import trace_rays
from skybake.scattering.rings import Rings, fade, project_rings, rings_around
from skybake.scattering.tables import Atmosphere
from skybake.scattering.transmittance import fill_sun_column
from skybake.transport.samples import allocate_samples
from skybake.transport.shells import altitude_shells
from skybake.transport.trace import trace

LEAST_PEAK = 0.03
"""Share of the scattered light in a peak from which its paths matter."""

SERIES = 48
"""Highest Legendre order of what a peak scatters of the difference, which is smooth."""

SHELLS = 15
ARC = math.radians(2.0)


def has_aureole(atmosphere: Atmosphere) -> bool:
    """Whether a medium has peaks whose light has to follow its true path."""
    return bool(atmosphere.scaled.fraction.max(initial=0.0) > LEAST_PEAK)


def solve_aureole(
    atmosphere: Atmosphere, grid: Grid, field: DiffuseField, workers: Workers = ALL_CPUS
) -> tuple[Aureole, DiffuseField]:
    """Solve for the light that peaks alone have scattered, less what goes straight.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns.
    grid : Grid
        Nodes of altitude and sun.
    field : DiffuseField
        Of those nodes, without light.
    workers : Workers, optional
        Who does the work.

    Returns
    -------
    aureole : Aureole
        What peaks scatter of the difference.
    moments : DiffuseField
        Its moments, which scatter as all diffuse light does, and its irradiance of the ground.

    Notes
    -----
    With B the sought light, S the straight one and P one more scattering in peaks on the true
    path, D = B - S solves D = (P S - S) + P D, of which two terms of the series are kept: the
    third changes D by 0.5 % on Mars at a dust depth of 0.5.
    """
    scaled = atmosphere.scaled
    around = rings_around(scaled.medium.r_bottom, grid)
    mu_s = np.cos(grid.sun_angle)
    radius = scaled.medium.r_bottom + np.maximum(grid.altitude, 1e-8)
    shape = around.mu.shape
    rays = np.stack(
        np.broadcast_arrays(
            radius[:, None, None, None], around.mu, mu_s[:, None, None], around.cosine[:, None]
        ),
        axis=-1,
    ).reshape(len(radius), -1, 4)
    moments = peak_moments(atmosphere.medium, scaled)
    first = _peaks_of_straight(atmosphere, rays, workers).reshape(*shape, -1)
    first -= straight_light(atmosphere, grid, around.cosine, moments, workers)[:, :, :, None]
    first *= fade(np.arccos(around.cosine))[:, None, None]
    aureole = _scattered(atmosphere, grid, around, moments, first, workers)
    difference = first + _transport(atmosphere, aureole, field, rays, workers).reshape(first.shape)
    return (
        _scattered(atmosphere, grid, around, moments, difference, workers),
        project_rings(grid, around, difference, field, workers),
    )


def _peaks_of_straight(atmosphere: Atmosphere, rays: Array, workers: Workers) -> Array:
    """Radiance that peaks scatter out of straight light, shape (node, ray, wavelength)."""
    scaled = atmosphere.scaled
    constituents = scaled.medium.phase.shape[0]
    peaks = scaled.phase[constituents:]
    coarse = atmosphere._replace(
        shells=altitude_shells(scaled.medium, SHELLS), field=no_field(scaled)
    )
    radiance = np.empty((*rays.shape[:2], scaled.mixture.size), np.float32)

    def work(first: int, last: int) -> None:
        for node in range(first, last):
            light = trace_rays(coarse, *rays[node].T, max_arc=ARC, workers=ONE_CPU)
            phase = eval_phase(peaks, rays[node, :, 3])
            radiance[node] = (light.single[:, constituents:] * phase).sum(axis=1)

    workers.run_rows(len(rays), work)
    return radiance


def straight_light(
    atmosphere: Atmosphere, grid: Grid, cosine: Array, moments: Array, workers: Workers
) -> npt.NDArray[np.float32]:
    """Radiance that peaks alone have scattered if each path went straight from the sun.

    What arrives by n scatterings within peaks on a depth y has the moments of a peak
    to the power of n, weighted by y^n / n! exp(-extinction).

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns.
    grid : Grid
        Nodes of altitude and sun.
    cosine : ndarray, shape (angle,)
        Of angles from the sun.
    moments : ndarray, shape (constituent, `SERIES_ORDER` + 1, wavelength)
        Of the peaks.
    workers : Workers
        Who does the work.

    Returns
    -------
    ndarray of float32, shape (altitude, sun, angle, wavelength)
        [sr⁻¹]
    """
    medium, scaled = pad_wavelengths(atmosphere.medium), atmosphere.scaled
    mu_s = np.cos(grid.sun_angle)
    columns = np.empty((grid.altitude.size, mu_s.size, medium.extinction.shape[0]))
    radius = medium.r_bottom + np.maximum(grid.altitude, 1e-8)
    _fill_sun_columns(atmosphere.columns, medium.r_bottom, medium.r_top, radius, mu_s, columns)
    extinction = columns @ medium.extinction
    depth = columns @ scaled.scattering
    share = vertical_columns(medium)[:, None] * scaled.scattering
    share /= np.maximum(share.sum(axis=0), 1e-300)
    mean = np.einsum("cw,clw->lw", share, moments)
    degree = np.arange(SERIES_ORDER + 1)
    polynomials = legendre_polynomials(cosine, SERIES_ORDER)
    polynomials *= ((2 * degree + 1) / (4.0 * math.pi))[:, None]
    straight = np.empty((*depth.shape[:2], cosine.size, depth.shape[2]), np.float32)

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            series = np.exp(depth[i] * mean[:, None] - extinction[i]) - np.exp(-extinction[i])
            straight[i] = np.einsum("lq,ljw->jqw", polynomials, series, optimize=True)

    workers.run_rows(len(depth), work)
    return straight


@kernel
def _fill_sun_columns(columns, r_bottom, r_top, radius, mu_s, out):
    """Write the columns toward each sun from each altitude, 0 where it has set."""
    for i in range(radius.size):
        for j in range(mu_s.size):
            fill_sun_column(columns, r_bottom, r_top, radius[i], mu_s[j], out[i, j])


def _scattered(
    atmosphere: Atmosphere,
    grid: Grid,
    around: Rings,
    moments: Array,
    radiance: Array,
    workers: Workers,
) -> Aureole:
    """Scatter light once in the peaks, in each altitude's mixture of constituents."""
    scaled = atmosphere.scaled
    share = peaked_shares(scaled, grid.altitude)
    harmonics = build_harmonics(SERIES)
    at_rings = harmonics_at(harmonics, around.cosine) * around.weight[:, None]
    angles = np.linspace(0.0, LAST_ANGLE, ANGLES)
    at_angles = harmonics_at(harmonics, np.cos(angles)) * fade(angles)[:, None]
    source = np.empty((*radiance.shape[:2], ANGLES, ORDERS, radiance.shape[-1]), np.float32)
    each = [
        np.einsum(
            "al,clw,ql->caqw",
            at_angles[:, harmonics.azimuthal == m],
            moments[:, harmonics.degree[harmonics.azimuthal == m]],
            at_rings[:, harmonics.azimuthal == m],
            optimize=True,
        )
        for m in range(ORDERS)
    ]

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            for m in range(ORDERS):
                term = np.cos(m * around.position[i]) * around.position_weight[i] * 2.0
                of_rings = np.einsum("jqp,jqpw->jqw", term, radiance[i], optimize=True)
                mixed = np.einsum("cw,caqw->aqw", share[i], each[m])
                source[i, :, :, m] = np.einsum("aqw,jqw->jaw", mixed, of_rings, optimize=True)

    workers.run_rows(len(radiance), work)
    return Aureole(source.reshape(*source.shape[:3], -1))


def _transport(
    atmosphere: Atmosphere, aureole: Aureole, field: DiffuseField, rays: Array, workers: Workers
) -> npt.NDArray[np.float32]:
    """Radiance that arrives of what an aureole's peaks scatter, shape (ray, wavelength)."""
    scaled = atmosphere.scaled
    shells = altitude_shells(scaled.medium, SHELLS)
    fans = group_rays(rays.reshape(-1, 4))
    out = np.zeros((len(fans.rays), scaled.mixture.size), np.float32)
    flat = [flatten(each) for each in (aureole, field, scaled, fans)]

    def work(begin: int, end: int) -> None:
        samples = allocate_samples(scaled.medium)
        filled, scratch = flatten(samples), flatten(allocate_aureole_scratch(scaled))
        while begin < end:
            stop = trace(scaled.medium, shells, ARC, fans.starts, begin, end, filled)
            add_aureole(*flat, begin, stop, filled, scratch, out)
            begin = stop

    workers.run_rows(len(fans.starts), work, chunk=1024)
    return out
