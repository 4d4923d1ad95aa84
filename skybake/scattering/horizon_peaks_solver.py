"""Solving for what peaks scatter across the horizon, from the solver's radiance around it."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.workers import Workers
from skybake.optics.delta_m import ScaledMedium, peak_moments, peaked_shares
from skybake.optics.medium import Array
from skybake.scattering.beyond_aureole import light_beyond_aureole
from skybake.scattering.grid import ORDER, Grid, empty_field
from skybake.scattering.horizon_peaks import LAST_SINE, SIDE, HorizonPeaks
from skybake.scattering.passes import trace_grid, transport_field
from skybake.scattering.tables import Atmosphere

SERIES = 100
"""Highest Legendre order of the peaks that is resolved."""

FINE = 64
"""Directions on either side of the horizon at which radiance is interpolated."""


EVERY = 3
"""Step through the grid's altitudes at which light is traced that the truncated medium lacks."""


def solve_horizon_peaks(
    atmosphere: Atmosphere, grid: Grid, radiance: npt.NDArray[np.float32], workers: Workers
) -> HorizonPeaks:
    """Solve for what peaks scatter around the horizon.

    Parameters
    ----------
    atmosphere : Atmosphere
        Its medium and columns.
    grid : Grid
        Nodes of altitude, sun and direction.
    radiance : ndarray of float32, shape (altitude, polar, sun, azimuth, wavelength)
        Diffuse radiance at the nodes, as the truncated medium has it. [sr⁻¹]
    workers : Workers
        Who does the work.

    Notes
    -----
    With N the scattering in peaks, f its straight share and T the transport in the whole medium,
    diffuse light L lacks T (N - f) L, and light that peaks alone have scattered lacks D beyond the
    aureole. Both are scattered in peaks once more, as T N (T (N - f) L + D). On Mars D takes up to
    1.7 % from the limb under a high sun, the further scattering 0.4 %, and the next term 0.05 %.
    """
    scaled = atmosphere.scaled
    moments = peak_moments(atmosphere.medium, scaled)
    sparse, spread = _sparse_altitudes(grid)
    source = scatter_around_horizon(scaled, grid, moments, radiance, 1.0, workers)

    def add(unknown: npt.NDArray[np.float32]) -> None:
        scattered = scatter_around_horizon(scaled, sparse, moments, unknown, 0.0, workers)
        source[...] += np.tensordot(spread, scattered, axes=1)

    add(light_beyond_aureole(atmosphere, sparse, moments, workers))
    dark = empty_field(scaled, grid.altitude, grid.sun_angle, ORDER)
    dark = dark._replace(polarised=dark.polarised[:0])
    rays = trace_grid(scaled, sparse)
    peaks = HorizonPeaks(source.copy())
    add(transport_field(scaled, dark, peaks, sparse, rays, workers))
    return HorizonPeaks(source)


def _sparse_altitudes(grid: Grid) -> tuple[Grid, npt.NDArray[np.float32]]:
    """Keep every few altitudes and the last, with weights for those of the grid between them."""
    last = grid.altitude.size - 1
    kept = np.append(np.arange(0, last, EVERY), last)
    at = np.arange(last + 1)
    spread = np.stack([np.interp(at, kept, each) for each in np.eye(kept.size)], axis=1)
    sparse = grid._replace(altitude=grid.altitude[kept], mu=grid.mu[kept], weight=grid.weight[kept])
    return sparse, _single(spread)


def scatter_around_horizon(
    scaled: ScaledMedium,
    grid: Grid,
    moments: Array,
    radiance: npt.NDArray[np.float32],
    straight: float,
    workers: Workers,
) -> npt.NDArray[np.float32]:
    """Scatter light in peaks around the horizon, less what goes straight on.

    Parameters
    ----------
    scaled : ScaledMedium
        The atmosphere.
    grid : Grid
        Nodes of altitude, sun and direction.
    moments : ndarray, shape (constituent, order + 1, wavelength)
        Legendre moments of each constituent's peak, at least up to `SERIES`.
    radiance : ndarray of float32, shape (altitude, polar, sun, azimuth, wavelength)
        At the nodes. [sr⁻¹]
    straight : float
        Share of what peaks scatter of this light that goes straight on already: 1 for light that
        the truncated medium transports, 0 for light that it does not know.
    workers : Workers
        Who does the work.

    Returns
    -------
    ndarray of float32
        The source of `HorizonPeaks`.
    """
    r_bottom = scaled.medium.r_bottom
    share = peaked_shares(scaled, grid.altitude)
    mixed = _single(np.einsum("acw,clw->awl", share, moments[:, : SERIES + 1]))[:, :, None]
    fraction = np.einsum("acw,cw->aw", share, scaled.fraction)[..., None, None]
    mu_horizon = -np.sqrt(np.maximum(1.0 - (r_bottom / (r_bottom + grid.altitude)) ** 2, 0.0))
    fine, spread = _fine_directions(grid, mu_horizon)
    mu, interpolation = _elevations(grid, mu_horizon)
    kept = _single(straight * fraction * interpolation[:, None])
    fourier, fade = _fourier_terms(grid.azimuth), _fade()
    altitudes, polar, suns, azimuths, wavelengths = radiance.shape
    source = np.empty((altitudes, suns, mu.shape[1], azimuths, wavelengths), np.float32)
    orders = range(azimuths)
    at_fine = [_associated_legendre(m, fine) for m in orders]
    at_elevations = [_single(_associated_legendre(m, mu).transpose(1, 2, 0)) for m in orders]

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            terms = np.matmul(fourier, radiance[i])
            for m in orders:
                there = _single(at_fine[m][:, i] @ spread[i])
                here = (mixed[i, ..., m:] * at_elevations[m][i]).reshape(-1, len(there))
                peaked = (here @ there).reshape(wavelengths, -1, polar)
                peaked = (peaked - kept[i]) * fade
                term = np.ascontiguousarray(terms[:, :, m].transpose(2, 0, 1))
                source[i, :, :, m] = (peaked @ term).transpose(2, 1, 0)

    workers.run_rows(altitudes, work)
    return source.reshape(*source.shape[:3], -1)


def _fourier_terms(azimuth: Array) -> npt.NDArray[np.float32]:
    """Weights of values at `azimuths` in the terms cos(m * azimuth), shape (order, azimuth)."""
    orders = np.arange(azimuth.size)
    weights = np.cos(np.outer(orders, azimuth)) * np.where(orders > 0, 2.0, 1.0)[:, None]
    return _single(weights / azimuth.size)


def _single(values: Array) -> npt.NDArray[np.float32]:
    """Round to single precision."""
    rounded: npt.NDArray[np.float32] = values.astype(np.float32)
    return rounded


def _fade() -> npt.NDArray[np.float32]:
    """Share of the difference that is kept at each elevation, none at the last, (elevation, 1)."""
    fading = np.clip(2.0 * np.arange(SIDE) / (SIDE - 1.0) - 1.0, 0.0, 1.0)
    share = np.cos(0.5 * math.pi * fading) ** 2
    return _single(np.concatenate([share, share])[:, None])


def _fine_directions(grid: Grid, mu_horizon: Array) -> tuple[Array, Array]:
    """Cosines, and their share of d mu times the interpolation from the grid's directions.

    Shapes (altitude, fine) and (altitude, fine, polar).
    """
    x, weight = np.polynomial.legendre.leggauss(FINE)
    x, weight = 0.5 * (x + 1.0), 0.5 * weight
    at_horizon = mu_horizon[:, None]
    spans = 1.0 - at_horizon, -1.0 - at_horizon
    mu = np.concatenate([at_horizon + span * x**1.5 for span in spans], axis=1)
    share = np.concatenate([abs(span) * 1.5 * np.sqrt(x) * weight for span in spans], axis=1)
    spread = np.zeros((*mu.shape, grid.mu.shape[1]))
    up = grid.upward
    spread[:, :FINE, :up] = _interpolation(up, x)
    spread[:, FINE:, up:] = _interpolation(grid.mu.shape[1] - up, x)
    spread *= share[:, :, None]
    return mu, spread


def _elevations(grid: Grid, mu_horizon: Array) -> tuple[Array, Array]:
    """Cosines of `HorizonPeaks` and the interpolation to them from the grid's directions."""
    distance = LAST_SINE * (np.arange(SIDE) / (SIDE - 1.0)) ** 2
    above = np.minimum(distance, 1.0 - mu_horizon[:, None])
    below = np.minimum(distance, 1.0 + mu_horizon[:, None])
    mu = mu_horizon[:, None] + np.concatenate([above, -below], axis=1)
    straight = np.zeros((*mu.shape, grid.mu.shape[1]))
    up = grid.upward
    for i, at_horizon in enumerate(mu_horizon):
        x = (above[i] / (1.0 - at_horizon)) ** (2.0 / 3.0)
        straight[i, :SIDE, :up] = _interpolation(up, x)
        x = (below[i] / (1.0 + at_horizon)) ** (2.0 / 3.0)
        straight[i, SIDE:, up:] = _interpolation(grid.mu.shape[1] - up, x)
    return mu, straight


def _interpolation(count: int, x: Array) -> Array:
    """Weights of Gauss' nodes between 0 and 1 in the polynomial through them, (x, node)."""
    nodes = 0.5 * (np.polynomial.legendre.leggauss(count)[0] + 1.0)
    weights = np.ones((x.size, count))
    for i in range(count):
        others = np.delete(nodes, i)
        weights[:, i] = ((x[:, None] - others) / (nodes[i] - others)).prod(axis=1)
    return weights


def _associated_legendre(m: int, mu: Array) -> Array:
    """Functions of order m and degrees m to `SERIES`, orthonormal in mu, (degree, ...)."""
    values = np.empty((SERIES + 1 - m, *mu.shape))
    k = np.arange(1, m + 1)
    values[0] = np.sqrt(0.5 * ((2 * k + 1) / (2 * k)).prod()) * (1.0 - mu**2) ** (0.5 * m)
    back = 0.0
    for degree in range(m + 1, SERIES + 1):
        i = degree - m
        scale = math.sqrt((4 * degree**2 - 1) / (degree**2 - m**2))
        values[i] = mu * values[i - 1]
        if i > 1:
            values[i] -= back * values[i - 2]
        values[i] *= scale
        back = 1.0 / scale
    return values
