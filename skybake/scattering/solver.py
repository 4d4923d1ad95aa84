"""All orders of scattering: the diffuse field by iteration of one scattering after another."""

from __future__ import annotations

import math

import numpy as np

from skybake.errors import TooThickError
from skybake.jit.workers import ALL_CPUS, Workers
from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array
from skybake.scattering.anderson import Anderson
from skybake.scattering.aureole_solver import has_aureole, solve_aureole
from skybake.scattering.field import DiffuseField, lower_order, raise_order, sum_fields
from skybake.scattering.grid import ORDER, Grid, build_grid, coarsen_grid, empty_field
from skybake.scattering.horizon_peaks_solver import solve_horizon_peaks
from skybake.scattering.limits import check_medium
from skybake.scattering.passes import (
    Batch,
    empty_radiance,
    scatter_field,
    scatter_sunlight,
    trace_grid,
)
from skybake.scattering.tables import Atmosphere

TOLERANCE = 5e-3
"""Relative change by the scatterings that follow the last pass, at which iteration ends; of
these, the next passes would change a tenth."""

COARSE_TOLERANCE = 1e-3
LEAST_CHANGE = 3e-5
"""Relative change below which single precision tells no more."""

DARKEST = 1e-7
"""Of the field under the brightest sun: the least that a change is compared with. Where light falls
faster than this from one sun to the next, rounding of the brighter is all that is left."""

FAINTEST = 1e-9
"""Of the field under the brightest sun: the least that passes are mixed in units of."""

MAX_PASSES = 20
MAX_COARSE_PASSES = 400

COARSE_ORDER = 3
"""Highest harmonic of the field in which light is followed through further scatterings."""

DIVERGED = 0.5
"""Relative change that no iteration which will converge shows after `SURE_PASSES`."""

SINGLE, BENT, SETTLED, SCATTERED = 0.25, 0.35, 0.45, 0.6
"""Shares of the work that are usually done with sunlight scattered once, its aureole, the light of
few harmonics, and the first scattering of all."""

SURE_PASSES = 40
"""Passes after which what is left, such as twilight far darker than the day, is mixed by itself."""


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
        With its field, which holds all orders of scattering and reflection, its aureole and what
        peaks scatter across the horizon.

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
    takes many scatterings to settle is smooth. What is not, passes settle one by one, which are
    mixed (Anderson) with each sun's light in units of its own, so that twilight counts as day does.

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
    coarse_rays, rays = trace_grid(scaled, coarse_grid), trace_grid(scaled, grid)
    # Radiance itself is needed only for what peaks scatter across the horizon.
    is_peaked = has_aureole(atmosphere)
    of_first, radiance = (empty_radiance(scaled, grid) if is_peaked else None for _ in range(2))
    first = scatter_sunlight(atmosphere, grid, workers, of_first)
    workers.tell(SINGLE)
    if is_peaked:
        aureole, bent = solve_aureole(atmosphere, grid, dark, workers)
        atmosphere, first = atmosphere._replace(aureole=aureole), sum_fields(first, bent, 1.0)
        workers.tell(BENT)

    def settle(new: DiffuseField, total: DiffuseField) -> DiffuseField:
        return _settle(scaled, new, total, coarse_grid, coarse_rays, workers)

    new = lower_order(first, COARSE_ORDER)
    field = raise_order(settle(new, new), new, first)
    workers.tell(SETTLED)
    scattered = scatter_field(scaled, field, grid, rays, workers)
    workers.tell(SCATTERED)
    field = sum_fields(first, scattered, 1.0)
    mixing, unit = Anderson(scaled.mixture.size), _brightness(field)
    for turn in range(MAX_PASSES):
        scattered = scatter_field(scaled, field, grid, rays, workers, radiance)
        image = sum_fields(first, scattered, 1.0)
        total = lower_order(image, COARSE_ORDER)
        new = sum_fields(total, lower_order(field, COARSE_ORDER), -1.0)
        settled = settle(new, total)
        image = raise_order(settled, new, image)
        field = _field(image, mixing.step(_state(field) / unit, _state(image) / unit) * unit)
        change = _relative(_state(settled) - _state(new), _state(total), grid)
        # Each pass may be the last.
        workers.tell(1.0 - (1.0 - SCATTERED) / (turn + 2.0))
        if change.max() < TOLERANCE:
            if of_first is not None and radiance is not None:
                # The field's moments are settled since, which changes the difference little.
                radiance += of_first
                peaks = solve_horizon_peaks(atmosphere, grid, radiance, workers)
                atmosphere = atmosphere._replace(horizon_peaks=peaks)
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
        scattered = scatter_field(scaled, _field(new, state), grid, rays, workers)
        image = start + _state(scattered)
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


def _brightness(field: DiffuseField) -> Array:
    """Size of a field's state under each sun and at each wavelength, (row, 1); never 0."""
    size = np.linalg.norm(_state(field), axis=1)[:, None]
    brightness: Array = np.maximum(size, max(FAINTEST * float(size.max()), 1e-30))
    return brightness


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
