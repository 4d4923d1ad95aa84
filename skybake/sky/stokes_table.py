"""The polarised light around an observer as a table, and its folding into a colour space.

Held are S1, and S2 over the sine of the azimuth from the source, since both are even in that
azimuth and smooth. What is polarised has no peaks, so that no phase function is left for pixels.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.scattering.polarisation_tables import load_polarisation
from skybake.scattering.stokes_solver import trace_stokes
from skybake.sky.skylight import Skylight
from skybake.sky.source import Source
from skybake.sky.spectral_table import SpectralTable, TableGeometry, resample_azimuths
from skybake.sky.stokes import sun_matrix
from skybake.sky.table import AZIMUTHS, FoldedTable, table_directions

UPRIGHT = 1e-4
"""Angle from zenith and nadir, where azimuths meet, at which rays are traced instead. [rad]"""


@dataclass(frozen=True, eq=False)
class StokesTable:
    """The polarised light of one source around one observer, in all wavelengths.

    Attributes
    ----------
    geometry : TableGeometry
        Where the rays are from which it is interpolated.
    values : ndarray of float64, shape (2, side, latitude, azimuth, wavelength)
        S1, and S2 over the sine of the azimuth from the source to the view, which for compass
        bearings has the sign of S2 in both halves, per unit irradiance. [sr⁻¹]
    """

    geometry: TableGeometry
    values: Array


class FoldedStokes(NamedTuple):
    """Polarised light around one observer, folded into a colour space.

    Attributes
    ----------
    even : FoldedTable
        S1, for `skybake.sky.pixels.fill_directions`.
    odd : FoldedTable
        S2 over the sine of the azimuth from the source, by which pixels are multiplied.
    """

    even: FoldedTable
    odd: FoldedTable


def stokes_table(skylight: Skylight, source: Source, table: SpectralTable) -> StokesTable:
    """Trace the polarised light of one source.

    Parameters
    ----------
    skylight : Skylight
        The observer and the atmosphere.
    source : Source
        What lights it.
    table : SpectralTable
        The light itself, `Skylight.spectral_table` of the source.
    """
    geometry, atmosphere = table.geometry, skylight.atmosphere
    count, shape = atmosphere.medium.ground_albedo.size, geometry.mu.shape
    zenith, azimuth = table_directions(
        source.zenith, geometry.zenith_first, geometry.zenith_horizon, shape[2]
    )
    theta = np.clip(zenith, UPRIGHT, math.pi - UPRIGHT)[:, :, None]
    mu_s, sine_s = source.mu, math.sin(source.zenith)
    mu = np.broadcast_to(np.cos(theta), shape).ravel()
    nu = (np.cos(theta) * mu_s + np.sin(theta) * sine_s * np.cos(azimuth)).ravel()
    rays = np.stack([np.full(mu.shape, skylight.radius), mu, np.full(mu.shape, mu_s), nu], axis=1)
    polarisation = load_polarisation(atmosphere, skylight.workers)
    diffuse = trace_stokes(atmosphere, polarisation, rays, skylight.workers)[..., :count]
    each = diffuse.reshape(*shape, 2, count).astype(np.float64)
    single = table.light.single[:, : len(atmosphere.medium.matrix)].reshape(*shape, -1, count)
    even, odd = each[..., 0, :], each[..., 1, :]
    if geometry.zenith_first == 0.0:
        even, odd = resample_azimuths(even, AZIMUTHS), _resample_odd(odd, AZIMUTHS)
        flat = resample_azimuths(single.reshape(*shape, -1), AZIMUTHS)
        single = flat.reshape(*flat.shape[:-1], -1, count)
        azimuth = np.broadcast_to(np.linspace(0.0, math.pi, AZIMUTHS), single.shape[:3])
    else:
        odd = _over_sine(odd, azimuth)
    across, turn = _across_and_turn(skylight, source, single, zenith[:, :, None], azimuth)
    even, odd = even + across * turn[0], odd + across * turn[1]
    return StokesTable(geometry, np.stack([even, odd]))


def fold_stokes(table: StokesTable, weights: Array) -> FoldedStokes:
    """Fold polarised light into a colour space; no ray is traced for that.

    Parameters
    ----------
    table : StokesTable
        The light.
    weights : ndarray of float64, shape (wavelength, 3)
        As of `fold_table`: R, G and B are the light per unit irradiance times these.
    """
    geometry = table.geometry
    folded = (table.values @ weights).astype(np.float32)
    return FoldedStokes(
        *(
            FoldedTable(
                zenith_first=geometry.zenith_first,
                zenith_horizon=geometry.zenith_horizon,
                source_zenith=geometry.source_zenith,
                values=values.reshape(*values.shape[:2], -1),
                curves=np.ones((2, 1), np.float32),
                is_linear=False,
            )
            for values in folded
        )
    )


def _across_and_turn(
    skylight: Skylight, source: Source, single: Array, theta: Array, azimuth: Array
) -> tuple[Array, tuple[Array, Array]]:
    """P12 of light scattered once; its shares of S1 and of S2 over the sine of the azimuth."""
    mu_s, sine_s = source.mu, math.sin(source.zenith)
    upward = mu_s * np.sin(theta) - sine_s * np.cos(theta) * np.cos(azimuth)
    leftward = sine_s * np.sin(azimuth)
    squared = np.maximum(upward**2 + leftward**2, 1e-12)
    nu = np.cos(theta) * mu_s + np.sin(theta) * sine_s * np.cos(azimuth)
    matrix = eval_phase(sun_matrix(skylight), np.clip(nu, -1.0, 1.0).ravel())
    across = (single * matrix.reshape(single.shape)).sum(axis=-2)
    even = (upward**2 - leftward**2) / squared
    odd = 2.0 * upward * sine_s / squared
    return across, (even[..., None], odd[..., None])


def _resample_odd(values: Array, azimuths: int) -> Array:
    """Evaluate the sine series through values at azimuths, over the sine, at others."""
    last = values.shape[2] - 1
    order = np.arange(1, last)
    analysis = 2.0 / last * np.sin(math.pi / last * np.outer(order, np.arange(last + 1)))
    # sin(m x) / sin(x), by the recurrence of Chebyshev's polynomials of the second kind.
    twice = 2.0 * np.cos(np.linspace(0.0, math.pi, azimuths))
    ratios = [np.ones(azimuths), twice]
    while len(ratios) < order.size:
        ratios.append(twice * ratios[-1] - ratios[-2])
    resampled: Array = np.stack(ratios[: order.size], axis=1) @ analysis @ values
    return resampled


def _over_sine(values: Array, azimuth: Array) -> Array:
    """Divide values by the sine of their azimuths, (side, latitude, azimuth, wavelength)."""
    sine = np.sin(azimuth)
    ratio = values / np.maximum(sine, 1e-9)[..., None]
    # Even about both ends: the parabola through the two nodes next to each.
    for end, first, second in ((0, 1, 2), (-1, -2, -3)):
        a = (azimuth[..., first] - azimuth[..., end])[..., None] ** 2
        b = (azimuth[..., second] - azimuth[..., end])[..., None] ** 2
        ratio[:, :, end] = (b * ratio[:, :, first] - a * ratio[:, :, second]) / (b - a)
    return ratio
