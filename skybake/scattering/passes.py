"""Single passes of the solver: light is scattered once and transported to the grid's nodes."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.angles import cosine_between
from skybake.jit.arguments import Flat, flatten
from skybake.jit.workers import ONE_CPU, Workers
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.legendre import legendre_polynomials
from skybake.optics.matrix import scattering_plane
from skybake.optics.medium import Array
from skybake.optics.wigner import wigner
from skybake.scattering.fans import group_rays
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import (
    ORDER,
    Grid,
    empty_field,
    no_field,
    project,
    project_polarised,
)
from skybake.scattering.horizon_peaks import HorizonPeaks, no_horizon_peaks
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.scattering.ray import trace_rays
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import allocate_samples
from skybake.transport.shells import altitude_shells
from skybake.transport.trace import trace

FIRST_SHELLS = 22
SHELLS = 20
ARC = math.radians(2.0)
FIRST_ARC = math.radians(2.0)


def scatter_sunlight(
    atmosphere: Atmosphere,
    grid: Grid,
    workers: Workers,
    radiance: npt.NDArray[np.float32] | None = None,
) -> DiffuseField:
    """Moments of the light scattered or reflected exactly once.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns.
    grid : Grid
        Nodes.
    workers : Workers
        Who does the work.
    radiance : ndarray of float32, shape (altitude, polar, sun, azimuth, wavelength), optional
        Receives the radiance at the nodes. [sr⁻¹]
    """
    scaled, without_peaks = atmosphere.scaled, _without_peaks(atmosphere)
    field = empty_field(scaled, grid.altitude, grid.sun_angle, ORDER)
    degree = np.arange(ORDER + 1)
    series = scaled.moments * ((2 * degree + 1) / (4.0 * math.pi))[:, None]
    scattering = np.flatnonzero(scaled.medium.scattering.any(axis=1))

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            rays = rays_at(scaled, grid, i)
            light = trace_rays(without_peaks, *rays.T, max_arc=FIRST_ARC, workers=ONE_CPU)
            polynomials = legendre_polynomials(rays[:, 3], ORDER)
            here = light.diffuse
            for c in scattering:
                here += light.single[:, c] * (polynomials.T @ series[c])
            here = here.reshape(*_shape(grid), -1)
            project(grid, i, here, field)
            if radiance is not None:
                radiance[i] = here
            if len(scaled.matrix_moments):
                stokes = _polarise(scaled, rays, light.single)
                project_polarised(grid, i, stokes.reshape(*_shape(grid), 2, -1), field)

    workers.run_rows(grid.altitude.size, work)
    return field


def empty_radiance(scaled: ScaledMedium, grid: Grid) -> npt.NDArray[np.float32]:
    """Room for the radiance at a grid's nodes, which is left as it is."""
    return np.empty((grid.altitude.size, *_shape(grid), scaled.mixture.size), np.float32)


def _without_peaks(atmosphere: Atmosphere) -> Atmosphere:
    """Keep of an atmosphere what sunlight is scattered in once, as the solver has it."""
    scaled = atmosphere.scaled
    return atmosphere._replace(
        scaled=scaled._replace(peaked=scaled.peaked[:0], phase=scaled.medium.phase),
        shells=altitude_shells(scaled.medium, FIRST_SHELLS),
        field=no_field(scaled),
    )


def polarise_sunlight(
    atmosphere: Atmosphere, grid: Grid, workers: Workers
) -> npt.NDArray[np.float32]:
    """Q and U at a grid's nodes of light scattered once.

    The shape is (altitude, polar, sun, azimuth, 2, wavelength).
    """
    scaled, without_peaks = atmosphere.scaled, _without_peaks(atmosphere)
    shape = grid.altitude.size, *_shape(grid), 2, scaled.mixture.size
    stokes = np.empty(shape, np.float32)

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            rays = rays_at(scaled, grid, i)
            light = trace_rays(without_peaks, *rays.T, max_arc=FIRST_ARC, workers=ONE_CPU)
            stokes[i] = _polarise(scaled, rays, light.single).reshape(shape[1:])

    workers.run_rows(grid.altitude.size, work)
    return stokes


def _polarise(scaled: ScaledMedium, rays: Array, single: Array) -> npt.NDArray[np.float32]:
    """Q and U of light scattered once, the sun to the left, shape (ray, 2, wavelength)."""
    degree = np.arange(ORDER + 1)
    scale = ((2 * degree + 1) / (4.0 * math.pi))[:, None]
    functions = wigner(0, 2, ORDER, rays[:, 3]).T
    across = np.zeros((len(rays), single.shape[2]))
    for c, moments in enumerate(scaled.matrix_moments[:, 0]):
        if not (moments.any() and scaled.medium.scattering[c].any()):
            continue
        across += single[:, c] * (functions @ (scale * moments))
    turn = scattering_plane(*rays[:, 1:].T)
    return (across[:, None] * turn[..., None]).astype(np.float32)


def rays_at(scaled: ScaledMedium, grid: Grid, node: int) -> Array:
    """Rays in all directions of an altitude's node for all suns, shape (ray, 4)."""
    mu, sun, azimuth = np.meshgrid(grid.mu[node], grid.sun_angle, grid.azimuth, indexing="ij")
    mu_s = np.cos(sun)
    nu = cosine_between(mu, np.sqrt(1.0 - mu**2), mu_s, np.sin(sun), azimuth)
    # A ray that starts on the ground itself must still see the sky.
    r = np.full(mu.shape, scaled.medium.r_bottom + max(grid.altitude[node], 1e-8))
    return np.stack([r, mu, mu_s, nu], axis=-1).reshape(-1, 4)


def _shape(grid: Grid) -> tuple[int, int, int]:
    """Numbers of directions, suns and azimuths that the rays of an altitude stand for."""
    return grid.mu.shape[1], grid.sun_angle.size, grid.azimuth.size


class Batch(NamedTuple):
    """Directions `begin` to `end` of a grid's altitude `node`, as `Fans`, and their `Samples`."""

    node: int
    fans: Flat
    begin: int
    end: int
    samples: Flat


def trace_grid(scaled: ScaledMedium, grid: Grid) -> list[Batch]:
    """Trace the grid's directions; their samples serve every pass and every sun."""
    shells = altitude_shells(scaled.medium, SHELLS)
    batches = []
    for node in range(grid.altitude.size):
        fans = group_rays(rays_at(scaled, grid, node))
        begin, end = 0, len(fans.starts)
        while begin < end:
            samples = allocate_samples(scaled.medium)
            stop = trace(scaled.medium, shells, ARC, fans.starts, begin, end, samples)
            batches.append(Batch(node, flatten(fans), begin, stop, flatten(samples)))
            begin = stop
    return batches


def scatter_field(
    scaled: ScaledMedium,
    field: DiffuseField,
    grid: Grid,
    batches: list[Batch],
    workers: Workers,
    radiance: npt.NDArray[np.float32] | None = None,
) -> DiffuseField:
    """Scatter a field once more and transport it; the ground reflects its irradiance.

    Returns moments, and writes radiance as `scatter_sunlight` does. Each altitude's light is
    projected before the next is transported, so that it never leaves a processor's cache.
    """
    light = _flat_light(scaled, field, no_horizon_peaks(scaled))
    scattered = field._replace(
        radiance=np.empty_like(field.radiance), ground=np.empty_like(field.ground)
    )
    rays, wavelengths = math.prod(_shape(grid)), field.ground.shape[1]
    polarised_rays = rays if len(field.polarised) else 0

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            out = np.zeros((rays, wavelengths), np.float32)
            stokes = np.zeros((polarised_rays, 2 * wavelengths), np.float32)
            for batch in batches:
                if batch.node == i:
                    _add_batch(light, field, batch, out, stokes)
            here = out.reshape(*_shape(grid), wavelengths)
            project(grid, i, here, scattered)
            if radiance is not None:
                radiance[i] = here
            if polarised_rays:
                project_polarised(grid, i, stokes.reshape(*_shape(grid), 2, wavelengths), scattered)

    workers.run_rows(grid.altitude.size, work)
    return scattered


def transport_field(
    scaled: ScaledMedium,
    field: DiffuseField,
    peaks: HorizonPeaks,
    grid: Grid,
    batches: list[Batch],
    workers: Workers,
) -> npt.NDArray[np.float32]:
    """Radiance at a grid's nodes of a field that is scattered once, as `scatter_sunlight`'s."""
    shape = grid.altitude.size, *_shape(grid), field.ground.shape[1]
    out = np.zeros((shape[0], math.prod(shape[1:-1]), shape[-1]), np.float32)
    stokes = np.zeros((0, 2 * shape[-1]), np.float32)
    light = _flat_light(scaled, field, peaks)

    def work(first: int, last: int) -> None:
        for batch in batches[first:last]:
            _add_batch(light, field, batch, out[batch.node], stokes)

    workers.run_rows(len(batches), work)
    return out.reshape(shape)


def _flat_light(scaled: ScaledMedium, field: DiffuseField, peaks: HorizonPeaks) -> list[Flat]:
    return [flatten(each) for each in (field, side_by_side(field), peaks, scaled)]


def _add_batch(
    light: list[Flat],
    field: DiffuseField,
    batch: Batch,
    out: npt.NDArray[np.float32],
    stokes: npt.NDArray[np.float32],
) -> None:
    """Add the diffuse light that rays of a batch bring, and Q and U if there are rows for them."""
    scratch = allocate_scratch(field, batch.fans.value)
    rays = batch.fans, batch.begin, batch.end, batch.samples
    add_diffuse(*light, *rays, scratch, out, stokes)
