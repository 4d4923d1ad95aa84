"""Solving for the linear polarisation of a field whose intensity is known."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.arguments import flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array
from skybake.scattering.fans import group_rays
from skybake.scattering.grid import Grid, build_grid
from skybake.scattering.multiple import side_by_side
from skybake.scattering.passes import Batch, polarise_sunlight, trace_grid
from skybake.scattering.ray import chunk_of_fans
from skybake.scattering.spin_harmonics import fill_each_spin, harmonic_count
from skybake.scattering.stokes import Polarisation, add_stokes, allocate_stokes, polarisation_of
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import allocate_samples
from skybake.transport.trace import MAX_ARC, trace

DIPOLES = 2
"""Order of the matrices of molecules."""

ORDER = 8
"""Of the matrices of particles: 14 orders, as the intensity has, change Q / I by up to 0.001."""

NEGLIGIBLE = 1e-4
"""Moment of a matrix below which an order is left out."""

MAX_PASSES = 8
TOLERANCE = 3e-3
"""Change of polarised light in a pass, relative to all light, at which passes end."""


def solve_polarisation(
    atmosphere: Atmosphere, workers: Workers = ALL_CPUS, order: int = ORDER
) -> Polarisation:
    """Solve for the linear polarisation of a solved field, of all orders of the matrices.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its field holds the moments of degree 2 of its polarisation.
    workers : Workers, optional
        Who does the work.
    order : int, optional
        Highest order of the matrices of particles.

    Notes
    -----
    The field's own moments are the start; each pass scatters and transports all of them once.
    """
    scaled, field = atmosphere.scaled, atmosphere.field
    order = order if _is_beyond_dipoles(scaled) else DIPOLES
    count, wavelengths = harmonic_count(order), scaled.mixture.size
    moments = np.zeros((*field.radiance.shape[:2], 2 * count, wavelengths), np.float32)
    plain = field.harmonics.degree.size
    moments[:, :, 3:6] = field.radiance[:, :, plain:]
    if order > DIPOLES:
        grid = build_grid(scaled)
        rays = trace_grid(scaled, grid)
        first = polarise_sunlight(atmosphere, grid, workers)
        size = np.linalg.norm(field.radiance[:, :, 0], axis=0)
        for _ in range(MAX_PASSES):
            here = polarisation_of(scaled, order, _flat(moments))
            stokes = first + _transport(atmosphere, here, grid, rays, workers).reshape(first.shape)
            before = moments.copy()
            for i in range(len(moments)):
                _project(grid, i, here, stokes[i], moments[i])
            change = np.linalg.norm(moments - before, axis=(0, 2))
            judged = grid.sun_angle < grid.last_judged
            if (change[judged] < TOLERANCE * size[judged]).all():
                break
    return polarisation_of(scaled, order, _flat(moments))


def _flat(moments: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    """Put moments and wavelengths in one row."""
    return moments.reshape(*moments.shape[:2], -1)


def _is_beyond_dipoles(scaled: ScaledMedium) -> bool:
    """Whether a constituent that scatters has moments beyond those of molecules."""
    scatters = scaled.medium.scattering.max(axis=1) > 0.0
    return bool(
        np.abs(scaled.matrix_moments[scatters][:, :, DIPOLES + 1 :]).max(initial=0.0) > NEGLIGIBLE
    )


def _transport(
    atmosphere: Atmosphere,
    polarisation: Polarisation,
    grid: Grid,
    batches: list[Batch],
    workers: Workers,
) -> npt.NDArray[np.float32]:
    """Q and U at a grid's nodes of a field that is scattered once."""
    field, wavelengths = atmosphere.field, atmosphere.scaled.mixture.size
    rays = grid.mu.shape[1] * grid.sun_angle.size * grid.azimuth.size
    out = np.zeros((grid.altitude.size, rays, 2 * wavelengths), np.float32)
    light = [flatten(each) for each in (field, side_by_side(field), polarisation)]
    bottom = float(atmosphere.medium.r_bottom)

    def work(first: int, last: int) -> None:
        for batch in batches[first:last]:
            scratch = allocate_stokes(polarisation, grid.sun_angle.size, batch.fans.value)
            fans = batch.fans, batch.begin, batch.end, batch.samples
            add_stokes(*light, bottom, *fans, scratch, out[batch.node])

    workers.run_rows(len(batches), work)
    return out


def _project(
    grid: Grid,
    i: int,
    polarisation: Polarisation,
    stokes: npt.NDArray[np.float32],
    out: npt.NDArray[np.float32],
) -> None:
    """Write moments of Q and U at an altitude, (polar, sun, azimuth, 2, wavelength)."""
    harmonics = polarisation.harmonics
    directions, suns, azimuths, _, wavelengths = stokes.shape
    count = harmonics.scale.size
    spins = np.empty((directions, 2, count))
    fill_each_spin(harmonics, grid.mu[i], spins)
    spins *= grid.weight[i][:, None, None]
    angle = np.outer(np.arange(harmonics.order + 1), grid.azimuth)
    around = np.zeros((2, harmonics.order + 1, azimuths, 2))
    around[0, :, :, 0], around[1, :, :, 1] = np.cos(angle), np.sin(angle)
    around *= 2.0 * math.pi / azimuths
    terms = np.matmul(
        around.reshape(-1, 2 * azimuths).astype(np.float32),
        stokes.reshape(directions, suns, -1, wavelengths),
    ).reshape(directions, suns, 2, harmonics.order + 1, wavelengths)
    degree = np.repeat(np.arange(harmonics.order + 1), np.arange(1, harmonics.order + 2))
    azimuthal = np.arange(count) - degree * (degree + 1) // 2
    for m in range(harmonics.order + 1):
        places = np.flatnonzero(azimuthal == m)
        even, odd = spins[:, 0, places].astype(np.float32), spins[:, 1, places].astype(np.float32)
        for first, functions in ((0, (even, odd)), (count, (odd, even))):
            moments = np.tensordot(functions[0], terms[:, :, 0, m], axes=([0], [0]))
            moments += np.tensordot(functions[1], terms[:, :, 1, m], axes=([0], [0]))
            out[:, first + places] = moments.transpose(1, 0, 2)


def trace_stokes(
    atmosphere: Atmosphere,
    polarisation: Polarisation,
    rays: Array,
    workers: Workers = ALL_CPUS,
) -> npt.NDArray[np.float32]:
    """Q and U of diffuse light along rays, the sun to the left, shape (ray, 2, wavelength).

    Parameters
    ----------
    atmosphere, polarisation : Atmosphere, Polarisation
        What the rays pass through.
    rays : ndarray of float64, shape (ray, 4)
        As of `Fans`, best ordered by direction.
    workers : Workers, optional
        Threads that do the work.
    """
    scaled, field, fans = atmosphere.scaled, atmosphere.field, group_rays(rays)
    out = np.zeros((len(rays), 2 * scaled.mixture.size), np.float32)
    flat = [flatten(each) for each in (field, side_by_side(field), polarisation)]
    flat_fans, medium, starts = map(flatten, (fans, scaled.medium, fans.starts))
    bottom = float(scaled.medium.r_bottom)

    def work(begin: int, end: int) -> None:
        samples = flatten(allocate_samples(scaled.medium))
        scratch = flatten(allocate_stokes(polarisation, field.sun_angle.size, fans))
        while begin < end:
            stop = trace(medium, atmosphere.shells, MAX_ARC, starts, begin, end, samples)
            add_stokes(*flat, bottom, flat_fans, begin, stop, samples, scratch, out)
            begin = stop

    workers.run_rows(len(fans.starts), work, chunk=chunk_of_fans(len(fans.starts), workers))
    return out.reshape(len(rays), 2, -1)
