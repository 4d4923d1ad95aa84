"""All orders of scattering: the diffuse field by iteration of one scattering after another."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.angles import cosine_between
from skybake.errors import TooThickError
from skybake.jit.arguments import Flat, flatten
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.legendre import legendre_polynomials
from skybake.optics.medium import Array
from skybake.scattering.anderson import Anderson
from skybake.scattering.aureole_solver import has_aureole, solve_aureole
from skybake.scattering.fans import group_rays
from skybake.scattering.field import DiffuseField, lower_order, raise_order, sum_fields
from skybake.scattering.grid import (
    ORDER,
    Grid,
    build_grid,
    coarsen_grid,
    empty_field,
    no_field,
    project,
)
from skybake.scattering.limits import check_medium
from skybake.scattering.multiple import add_diffuse, allocate_scratch, side_by_side
from skybake.scattering.ray import trace_rays
from skybake.scattering.tables import Atmosphere
from skybake.transport.samples import allocate_samples
from skybake.transport.shells import altitude_shells
from skybake.transport.trace import trace

FIRST_SHELLS = 22
SHELLS = 20
TOLERANCE = 5e-3
"""Relative change by the scatterings that follow the last pass, at which iteration ends; of
these, the next passes would change a tenth."""

COARSE_TOLERANCE = 1e-3
LEAST_CHANGE = 3e-5
"""Relative change below which single precision tells no more."""

DARKEST = 1e-7
"""Of the field under the brightest sun: the least that a change is compared with. Where light falls
faster than this from one sun to the next, rounding of the brighter is all that is left."""

MAX_PASSES = 20
MAX_COARSE_PASSES = 400

COARSE_ORDER = 3
"""Highest harmonic of the field in which light is followed through further scatterings."""

DIVERGED = 0.5
"""Relative change that no iteration which will converge shows after `SURE_PASSES`."""

SURE_PASSES = 40
"""Passes after which what is left, such as twilight far darker than the day, is mixed by itself."""

ARC = math.radians(2.0)
FIRST_ARC = math.radians(2.0)


def solve_light(atmosphere: Atmosphere, workers: Workers = ALL_CPUS) -> Atmosphere:
    """Solve for the light that was scattered at least once.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium, without forward peaks beyond `ORDER`, and its columns.
    workers : Workers, optional
        Who does the work.

    Returns
    -------
    Atmosphere
        With its field, which holds all orders of scattering and reflection, and its aureole.

    Raises
    ------
    TooThickError
        If the atmosphere is optically too thick, or the iteration does not converge.
    UnsolvableError
        If a phase function has a peak that is too strong.

    Notes
    -----
    L = L1 + K L, with K one transport and one scattering in the truncated medium,
    is iterated. The light that the last pass changed is followed through all its
    further scatterings in a field of few harmonics, where a pass costs a quarter
    (diffusion synthetic acceleration, with `COARSE_ORDER` for the diffusion): what
    takes many scatterings to settle is smooth. Two passes in between settle what is
    not.

    References
    ----------
    M. L. Adams and E. W. Larsen, "Fast iterative methods for discrete-ordinates
    particle transport calculations", Prog. Nucl. Energy 40, 2002, section II.
    """
    scaled = atmosphere.scaled
    check_medium(scaled)
    grid = build_grid(scaled)
    dark = empty_field(scaled, grid.altitude, grid.sun_angle, ORDER)
    coarse_grid = coarsen_grid(grid, scaled.medium.r_bottom, COARSE_ORDER)
    coarse_rays, rays = _trace_grid(scaled, coarse_grid), _trace_grid(scaled, grid)
    first = _first_order(atmosphere, grid, workers)
    if has_aureole(atmosphere):
        aureole, bent = solve_aureole(atmosphere, grid, dark, workers)
        atmosphere, first = atmosphere._replace(aureole=aureole), sum_fields(first, bent, 1.0)

    def scatter(field: DiffuseField) -> DiffuseField:
        return _scatter(scaled, field, grid, rays, workers)

    def settle(new: DiffuseField, total: DiffuseField) -> DiffuseField:
        return _settle(scaled, new, total, coarse_grid, coarse_rays, workers)

    new = lower_order(first, COARSE_ORDER)
    field = raise_order(settle(new, new), new, first)
    for _ in range(MAX_PASSES // 2):
        once = sum_fields(first, scatter(field), 1.0)
        twice = sum_fields(first, scatter(once), 1.0)
        total = lower_order(twice, COARSE_ORDER)
        new = sum_fields(total, lower_order(once, COARSE_ORDER), -1.0)
        settled = settle(new, total)
        field = raise_order(settled, new, twice)
        change = _relative(_state(settled) - _state(new), _state(total), grid)
        if change.max() < TOLERANCE:
            return atmosphere._replace(field=field)
        if not np.isfinite(change).all():
            break
    raise _no_convergence(MAX_PASSES, TOLERANCE, float(change.max()))


def _settle(
    scaled: ScaledMedium,
    new: DiffuseField,
    total: DiffuseField,
    grid: Grid,
    rays: list[Batch],
    workers: Workers,
) -> DiffuseField:
    """Follow light of few harmonics through all its scatterings, to a small part of `total`."""
    wavelengths = new.ground.shape[1]
    mixing = Anderson(wavelengths)
    start, scale = _state(new), _state(total)
    sunlit = wavelengths * np.count_nonzero(grid.sun_angle < 0.5 * math.pi)
    state, previous, left = start, 0.0, 0.0
    for turn in range(MAX_COARSE_PASSES):
        image = start + _state(_scatter(scaled, _field(new, state), grid, rays, workers))
        change = _relative(image - state, np.maximum(abs(image), abs(scale)), grid)
        if turn == 1:
            # The first step is not mixed yet: the ratio is what one scattering leaves.
            left = float(change[:sunlit].max()) / max(previous, 1e-30)
            left = min(max(left, 1e-3), 0.9999)
        # In a thick atmosphere a small change is not a small error.
        least = max(COARSE_TOLERANCE * (1.0 - left) / left, LEAST_CHANGE) if turn > 0 else 0.0
        if turn == SURE_PASSES:
            mixing = Anderson(wavelengths)
        weight = _unsettled(image - state, change, 0.5 * least) if turn >= SURE_PASSES else None
        state = mixing.step(state, image, weight)
        if change.max() < least:
            return _field(new, state)
        if not np.isfinite(change).all() or (turn >= SURE_PASSES and change.max() > DIVERGED):
            break
        previous = float(change[:sunlit].max())
    raise _no_convergence(turn + 1, COARSE_TOLERANCE, float(change.max()))


def _relative(change: Array, state: Array, grid: Grid) -> Array:
    """Relative size of a change, for each sun angle that is judged and each wavelength."""
    judged = np.repeat(grid.sun_angle < grid.last_judged, len(state) // grid.sun_angle.size)
    size = np.linalg.norm(state[judged], axis=1)
    wavelengths = len(state) // grid.sun_angle.size
    brightest = size.reshape(-1, wavelengths).max(axis=0)
    least = np.tile(np.maximum(DARKEST * brightest, 1e-30), len(size) // wavelengths)
    relative: Array = np.linalg.norm(change[judged], axis=1) / np.maximum(size, least)
    return relative


def _unsettled(change: Array, relative: Array, least: float) -> Array:
    """Weights of the rows whose relative change is above the least, by which all count the same."""
    weight = np.zeros(len(change))
    size = np.linalg.norm(change[: len(relative)], axis=1).astype(float)
    is_left = relative > least
    weight[: len(relative)][is_left] = (relative[is_left] / size[is_left]) ** 2
    return weight


def _no_convergence(passes: int, tolerance: float, change: float) -> TooThickError:
    return TooThickError(
        f"multiple scattering: must converge to a relative change of {tolerance:g}, "
        f"got {change:.2g} after {passes} passes"
    )


def _first_order(atmosphere: Atmosphere, grid: Grid, workers: Workers) -> DiffuseField:
    """Moments of the light scattered or reflected exactly once."""
    scaled = atmosphere.scaled
    without_peaks = atmosphere._replace(
        scaled=scaled._replace(peaked=scaled.peaked[:0], phase=scaled.medium.phase),
        shells=altitude_shells(scaled.medium, FIRST_SHELLS),
        field=no_field(scaled),
    )
    constituents = scaled.medium.phase.shape[0]
    field = empty_field(scaled, grid.altitude, grid.sun_angle, ORDER)
    degree = np.arange(ORDER + 1)
    series = scaled.moments * ((2 * degree + 1) / (4.0 * math.pi))[:, None]
    for i in range(grid.altitude.size):
        rays = _rays_at(scaled, grid, i)
        light = trace_rays(without_peaks, *rays.T, max_arc=FIRST_ARC, workers=workers)
        polynomials = legendre_polynomials(rays[:, 3], ORDER)
        radiance = light.diffuse
        for c in range(constituents):
            radiance += light.single[:, c] * (polynomials.T @ series[c])
        project(grid, i, radiance.reshape(*_shape(grid), -1), field)
    return field


def _rays_at(scaled: ScaledMedium, grid: Grid, node: int) -> Array:
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


def _trace_grid(scaled: ScaledMedium, grid: Grid) -> list[Batch]:
    """Trace the grid's directions; their samples serve every pass and every sun."""
    shells = altitude_shells(scaled.medium, SHELLS)
    batches = []
    for node in range(grid.altitude.size):
        fans = group_rays(_rays_at(scaled, grid, node))
        begin, end = 0, len(fans.starts)
        while begin < end:
            samples = allocate_samples(scaled.medium)
            stop = trace(scaled.medium, shells, ARC, fans.starts, begin, end, samples)
            batches.append(Batch(node, flatten(fans), begin, stop, flatten(samples)))
            begin = stop
    return batches


def _scatter(
    scaled: ScaledMedium, field: DiffuseField, grid: Grid, batches: list[Batch], workers: Workers
) -> DiffuseField:
    """Scatter a field once more and transport it; the ground reflects its irradiance."""
    nodes, wavelengths = grid.altitude.size, field.ground.shape[1]
    out = np.zeros((nodes, math.prod(_shape(grid)), wavelengths), np.float32)
    light = [flatten(each) for each in (field, side_by_side(field), scaled.medium)]

    def work(first: int, last: int) -> None:
        for batch in batches[first:last]:
            scratch = allocate_scratch(field, batch.fans.value)
            rays = batch.fans, batch.begin, batch.end, batch.samples
            add_diffuse(*light, *rays, scratch, out[batch.node])

    workers.run_rows(len(batches), work)
    scattered = field._replace(
        radiance=np.empty_like(field.radiance), ground=np.empty_like(field.ground)
    )
    shape = *_shape(grid), wavelengths

    def store(first: int, last: int) -> None:
        for i in range(first, last):
            project(grid, i, out[i].reshape(shape), scattered)

    workers.run_rows(nodes, store)
    return scattered


def _state(field: DiffuseField) -> Array:
    """Field as one vector for each sun angle and wavelength, for the iteration."""
    columns = field.radiance.transpose(1, 3, 0, 2).reshape(field.ground.size, -1)
    return np.concatenate([columns, field.ground.reshape(-1, 1)], axis=1, dtype=np.float32)


def _field(like: DiffuseField, state: Array) -> DiffuseField:
    """Inverse of `_state`."""
    altitudes, suns, moments, wavelengths = like.radiance.shape
    columns = state[:, :-1].reshape(suns, wavelengths, altitudes, moments)
    return like._replace(
        radiance=np.ascontiguousarray(columns.transpose(2, 0, 3, 1), dtype=np.float32),
        ground=state[:, -1].reshape(suns, wavelengths).astype(float),
    )
