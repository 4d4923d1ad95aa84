"""The light around an observer in all wavelengths, and its folding into a colour space."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from skybake.angles import cosine_between
from skybake.optics.medium import Array
from skybake.optics.phase import eval_phase
from skybake.optics.phase_basis import PhaseBasis, pad_basis
from skybake.scattering.ray import RayLight
from skybake.sky.table import (
    AZIMUTHS,
    AZIMUTHS_FROM_SPACE,
    AZIMUTHS_FROM_SPACE_AUREOLE,
    RAY_AZIMUTHS,
    FoldedTable,
    horizon_angles,
    ray_azimuths,
    table_directions,
)


@dataclass(frozen=True, eq=False)
class TableGeometry:
    """Directions at which the light of one source is tabulated.

    Attributes
    ----------
    zenith_first : float
        Zenith angle at which the atmosphere begins: 0 inside it, beyond 0 from space. [rad]
    zenith_horizon : float
        Zenith angle of the planet's horizon. [rad]
    source_zenith : float
        Zenith angle of the source. [rad]
    mu, nu : ndarray of float64, shape (2, latitude, azimuth)
        Cosines of the zenith angles of the nodes and of their angles to the source; above
        the horizon and below it, azimuths from the source's to the opposite one.
    """

    zenith_first: float
    zenith_horizon: float
    source_zenith: float
    mu: Array
    nu: Array


def table_geometry(
    r: float,
    r_bottom: float,
    r_top: float,
    source_zenith: float,
    *,
    has_aureole: bool = False,
    finely: bool = False,
    coarsely: bool = False,
) -> TableGeometry:
    """Choose the nodes of a table.

    Parameters
    ----------
    r, r_bottom, r_top : float
        Radii of the observer, the ground and the top of the atmosphere. [km]
    source_zenith : float
        Zenith angle of the source. [rad]
    has_aureole : bool, optional
        Whether the light around the source is finer than the diffuse field.
    finely : bool, optional
        Trace rays at all azimuths of the table, also where few determine the others.
    coarsely : bool, optional
        Trace rays at no more azimuths than determine a clear day, for a first glance: twilight is
        right to 0.1 %, and the light beside a low sun in dust to some percent.
    """
    first, horizon = horizon_angles(r, r_bottom, r_top)
    azimuths = AZIMUTHS_FROM_SPACE_AUREOLE if has_aureole else AZIMUTHS_FROM_SPACE
    if first == 0.0:
        azimuths = (
            AZIMUTHS
            if finely
            else RAY_AZIMUTHS
            if coarsely
            else ray_azimuths(math.pi / 2.0 - source_zenith, horizon, has_aureole=has_aureole)
        )
    zenith, phi = table_directions(source_zenith, first, horizon, azimuths)
    theta = np.broadcast_to(zenith[:, :, None], phi.shape)
    mu = np.cos(theta)
    nu = cosine_between(mu, np.sin(theta), math.cos(source_zenith), math.sin(source_zenith), phi)
    return TableGeometry(first, horizon, source_zenith, mu, np.clip(nu, -1.0, 1.0))


@dataclass(frozen=True, eq=False)
class SpectralTable:
    """The light of one source around one observer, in all wavelengths.

    Attributes
    ----------
    geometry : TableGeometry
        Where its nodes are.
    light : RayLight
        Along a ray from the observer through each node, in the order of `geometry.mu`, per
        unit irradiance.
    """

    geometry: TableGeometry
    light: RayLight


def radiance_at_nodes(table: SpectralTable, phase: Array) -> Array:
    """Radiance along the rays of a table per unit irradiance, shape (node, wavelength). [sr⁻¹]

    Parameters
    ----------
    table : SpectralTable
        The light.
    phase : ndarray of float64, shape (phase function, angle, wavelength)
        Phase functions that belong to `table.light.single`, see `Skylight.phase`. [sr⁻¹]
    """
    at_nodes = eval_phase(phase, table.geometry.nu.ravel())
    radiance: Array = (table.light.single * at_nodes).sum(axis=1) + table.light.diffuse
    return radiance


def fold_table(table: SpectralTable, basis: PhaseBasis, rgb_weights: Array) -> FoldedTable:
    """Fold a spectral table into a colour space; no ray is traced for that.

    Parameters
    ----------
    table : SpectralTable
        The light.
    basis : PhaseBasis
        What the phase functions that belong to `table.light.single` are sums of.
    rgb_weights : ndarray of float64, shape (wavelength, 3)
        RGB is the radiance per unit irradiance times these.

    Returns
    -------
    FoldedTable
        For `skybake.sky.pixels.fill_directions`.
    """
    geometry = table.geometry
    padded = pad_basis(basis)
    fold = np.einsum("cwq,wk->cwkq", padded.weights, rgb_weights)
    values = np.tensordot(table.light.single, fold, axes=2)
    values[:, :, 0] += table.light.diffuse @ rgb_weights
    values = values.reshape(*geometry.mu.shape, -1)
    if geometry.zenith_first == 0.0:
        values = resample_azimuths(values, AZIMUTHS)
    return FoldedTable(
        zenith_first=geometry.zenith_first,
        zenith_horizon=geometry.zenith_horizon,
        source_zenith=geometry.source_zenith,
        values=values.astype(np.float32).reshape(*values.shape[:2], -1),
        curves=np.ascontiguousarray(padded.curves.T, dtype=np.float32),
        is_linear=False,
    )


def resample_azimuths(values: Array, azimuths: int) -> Array:
    """Evaluate the cosine series through the azimuths of a table at others.

    Parameters
    ----------
    values : ndarray of float64, shape (side, latitude, azimuth, ...)
        At equal distances from 0 to pi.
    azimuths : int
        How many to have instead, at equal distances too.
    """
    last = values.shape[2] - 1
    order = np.arange(last + 1)
    ends_halved = np.where((order == 0) | (order == last), 0.5, 1.0)
    analysis = 2.0 / last * np.cos(math.pi / last * np.outer(order, order)) * ends_halved
    synthesis = np.cos(np.outer(np.linspace(0.0, math.pi, azimuths), order)) * ends_halved
    resampled: Array = synthesis @ analysis @ values
    return resampled
