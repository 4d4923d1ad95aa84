"""Nodes of the solver: altitudes, sun angles and directions, and moments over them."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.optics.delta_m import ScaledMedium
from skybake.optics.medium import Array, Medium, vertical_optical_depth
from skybake.scattering.field import (
    DiffuseField,
    altitude_layers,
    steep_twilight,
    sun_bins,
    sun_factors,
    twilight_scale,
)
from skybake.scattering.harmonics import build_harmonics, harmonics_at
from skybake.scattering.polarised import ORDERS, spin_functions
from skybake.transport.shells import altitude_shells

ORDER = 14
"""Highest harmonic of the diffuse field; forward peaks beyond it are truncated."""

ALTITUDES = 30
THIN_DEPTH = 2.0
ALTITUDES_PER_DEPTH = 4.0
MAX_ALTITUDES = 96
"""Nodes of altitude, more of them in a thick atmosphere: light between two nodes that are an
optical depth apart is lost to interpolation, 6 % of it at depth 10 with no more than 24."""

LAST_JUDGED = math.radians(20.0)
LAST_JUDGED_THICK = math.radians(7.0)
"""Depressions of the sun beyond which it is night, and, if the atmosphere is thick, beyond which
light settles very slowly, of a `twilight_scale` of 1. [rad]"""

UPWARD = 18
DOWNWARD = 6
"""Directions above and below the horizon; in deep twilight all light comes from a low arch."""

COARSE_UPWARD = 12
COARSE_DOWNWARD = 6
"""Directions of a field of few harmonics."""

# Spacing of the sun's zenith angles by its depression: fine where the planet's shadow passes
# through the atmosphere, which is sooner in shallow air, and not too wide at the zenith, near
# which moments vary as sin(angle)**m.
_SPACING_AT = np.array([-40.0, -15.0, -4.0, 0.0, 14.0, 22.0, 35.0])
_SPACING = np.array([8.0, 5.0, 1.6, 0.8, 0.8, 1.0, 4.0])
_SPACING_AT_ZENITH = 10.0


class Grid(NamedTuple):
    """Nodes of the solver.

    Attributes
    ----------
    altitude : ndarray, shape (altitude,)
        [km]
    sun_angle : ndarray, shape (sun,)
        [rad]
    mu, weight : ndarray, shape (altitude, polar)
        Zenith cosines of the directions at each altitude and their shares of
        d mu, apart above and below the local horizon.
    upward : int
        Directions above the horizon, which are the first.
    azimuth : ndarray, shape (azimuth,)
        Midpoints of half the circle. [rad]
    last_judged : float
        Solar zenith angle up to which a solution must converge. [rad]
    """

    altitude: Array
    sun_angle: Array
    mu: Array
    weight: Array
    upward: int
    azimuth: Array
    last_judged: float


def build_grid(scaled: ScaledMedium) -> Grid:
    """Choose the solver's nodes for an atmosphere."""
    medium = scaled.medium
    depth = thickest_depth(medium)
    more = round(ALTITUDES_PER_DEPTH * max(depth - THIN_DEPTH, 0.0))
    altitude = altitude_shells(medium, min(ALTITUDES + more, MAX_ALTITUDES))
    mu, weight = _directions(medium.r_bottom, altitude, UPWARD, DOWNWARD)
    dip = math.acos(medium.r_bottom / medium.r_top)
    last = min(math.pi, math.pi / 2.0 + max(2.5 * dip, math.radians(28.0)))
    twilight = twilight_scale(medium)
    judged = LAST_JUDGED if depth <= THIN_DEPTH else LAST_JUDGED_THICK
    return Grid(
        altitude=altitude,
        sun_angle=sun_angles(last, twilight),
        mu=mu,
        weight=weight,
        upward=UPWARD,
        azimuth=azimuths(ORDER),
        last_judged=math.pi / 2.0 + judged * twilight,
    )


def coarsen_grid(grid: Grid, r_bottom: float, order: int) -> Grid:
    """Keep the altitudes and suns, but only directions that hold a field of few harmonics."""
    mu, weight = _directions(r_bottom, grid.altitude, COARSE_UPWARD, COARSE_DOWNWARD)
    return grid._replace(mu=mu, weight=weight, upward=COARSE_UPWARD, azimuth=azimuths(order))


def thickest_depth(medium: Medium) -> float:
    """Vertical optical depth at the wavelength where it is largest."""
    return float(vertical_optical_depth(medium).sum(axis=0).max())


def azimuths(order: int) -> Array:
    """Midpoints of half the circle that resolve cosines up to an order. [rad]"""
    return math.pi * (np.arange(order + 1) + 0.5) / (order + 1)


def sun_angles(last: float, twilight: float = 1.0) -> Array:
    """Solar zenith angles of the field's nodes, from 0 to `last`. [rad]

    Parameters
    ----------
    last : float
        [rad]
    twilight : float, optional
        `twilight_scale` of the atmosphere.
    """
    at = np.concatenate([[0.0], 90.0 + twilight * _SPACING_AT, [180.0]])
    ends = [_SPACING_AT_ZENITH]
    spacing = np.concatenate([ends, twilight * _SPACING, ends])
    angles = [0.0]
    while angles[-1] < math.degrees(last):
        middle = angles[-1] + 0.5 * np.interp(angles[-1], at, spacing)
        angles.append(angles[-1] + float(np.interp(middle, at, spacing)))
    # The last node is moved to `last`, and others in proportion, but not the densest ones, which
    # shallow air has in a narrow band, away from the horizon.
    fixed = 90.0 * (1.0 - twilight**2)
    beyond = np.maximum(np.array(angles) - fixed, 0.0)
    stretched = beyond * (math.degrees(last) - fixed) / (angles[-1] - fixed)
    return np.radians(np.minimum(angles, fixed) + stretched)


def _directions(
    r_bottom: float, altitude: Array, upward: int, downward: int
) -> tuple[Array, Array]:
    """Zenith cosines at each altitude and their weights, each of shape (altitude, polar)."""
    mu, weight = zip(
        *(_split_directions(r_bottom, h, upward, downward) for h in altitude), strict=True
    )
    return np.stack(mu), np.stack(weight)


def _split_directions(r_bottom: float, h: float, upward: int, downward: int) -> tuple[Array, Array]:
    """Gauss nodes in mu, apart above and below the horizon and crowded toward it."""
    mu_horizon = -math.sqrt(max(0.0, 1.0 - (r_bottom / (r_bottom + h)) ** 2))
    mu, weight = [], []
    for count, span in ((upward, 1.0 - mu_horizon), (downward, -1.0 - mu_horizon)):
        x, w = _gauss_nodes(count)
        x, w = 0.5 * (x + 1.0), 0.5 * w
        mu.append(mu_horizon + span * x**1.5)
        weight.append(abs(span) * 1.5 * np.sqrt(x) * w)
    return np.concatenate(mu), np.concatenate(weight)


@cache
def _gauss_nodes(count: int) -> tuple[Array, Array]:
    """Nodes and weights of Gauss and Legendre, which each altitude needs."""
    x, w = np.polynomial.legendre.leggauss(count)
    x.flags.writeable = w.flags.writeable = False
    return x, w


def empty_field(
    scaled: ScaledMedium, altitude: Array, sun_angle: Array, order: int
) -> DiffuseField:
    """Field without light on given nodes."""
    harmonics = build_harmonics(order)
    twilight = twilight_scale(scaled.medium)
    wavelengths = scaled.moments.shape[2]
    moments = harmonics.degree.size + (ORDERS if len(scaled.matrix_moments) else 0)
    return DiffuseField(
        harmonics=harmonics,
        altitude=altitude,
        layer=altitude_layers(scaled.medium, altitude),
        sun_angle=sun_angle,
        sun_bin=sun_bins(sun_angle),
        sun_factor=sun_factors(sun_angle, twilight),
        twilight=twilight,
        steep_from=steep_twilight(scaled.medium),
        source=np.ascontiguousarray(
            scaled.medium.scattering[:, None] * scaled.moments[:, : order + 1]
        ),
        polarised=polarised_source(scaled),
        radiance=np.zeros((altitude.size, sun_angle.size, moments, wavelengths), np.float32),
        ground=np.zeros((sun_angle.size, wavelengths)),
    )


def polarised_source(scaled: ScaledMedium) -> Array:
    """`DiffuseField.polarised` of a medium."""
    moments = scaled.matrix_moments
    if not len(moments):
        return np.zeros((0, 2, scaled.mixture.size))
    return np.ascontiguousarray(scaled.medium.scattering[:, None] * moments[:, :2, 2])


def no_field(scaled: ScaledMedium) -> DiffuseField:
    """Field of no diffuse light: rays leave out a field on one altitude."""
    return empty_field(scaled, np.zeros(1), sun_angles(math.pi), 0)


def project(
    grid: Grid, i: int, radiance: npt.NDArray[np.floating[Any]], field: DiffuseField
) -> None:
    """Write the moments of the radiance at one altitude of a field, and its ground's irradiance.

    Parameters
    ----------
    grid : Grid
        Nodes of the radiance.
    i : int
        The altitude's node.
    radiance : ndarray, shape (polar, sun, azimuth, wavelength)
        [sr⁻¹]
    field : DiffuseField
        Receives the moments.
    """
    harmonics, azimuths = field.harmonics, grid.azimuth.size
    polar = harmonics_at(harmonics, grid.mu[i]) * grid.weight[i][:, None]
    around = np.cos(np.outer(np.arange(harmonics.order + 1), grid.azimuth))
    around *= 2.0 * math.pi / azimuths
    # Azimuths first and then directions take a fifth of the work of both at once.
    terms = np.matmul(around.astype(np.float32), radiance)
    directions, suns, _, wavelengths = radiance.shape
    for m in range(harmonics.order + 1):
        order = np.flatnonzero(harmonics.azimuthal == m)
        term = terms[:, :, m].reshape(directions, -1)
        moments = polar[:, order].T.astype(np.float32) @ term
        field.radiance[i][:, order] = moments.reshape(-1, suns, wavelengths).transpose(1, 0, 2)
    if i == 0:
        up = slice(0, grid.upward)
        flux = grid.weight[0][up] * grid.mu[0][up]
        field.ground[...] = np.tensordot(flux, terms[up, :, 0], axes=1)


def project_polarised(
    grid: Grid, i: int, stokes: npt.NDArray[np.floating[Any]], field: DiffuseField
) -> None:
    """Write the moments of polarised light at one altitude of a field.

    Parameters
    ----------
    grid : Grid
        Nodes of the light.
    i : int
        The altitude's node.
    stokes : ndarray, shape (polar, sun, azimuth, 2, wavelength)
        Q and U with the sun to the left. [sr⁻¹]
    field : DiffuseField
        Receives the moments.
    """
    even, odd = (each * grid.weight[i][:, None] for each in spin_functions(grid.mu[i]))
    directions, suns, azimuths, _, wavelengths = stokes.shape
    angle = np.outer(np.arange(ORDERS), grid.azimuth)
    around = np.zeros((2, ORDERS, azimuths, 2))
    around[0, :, :, 0], around[1, :, :, 1] = np.cos(angle), np.sin(angle)
    around *= 2.0 * math.pi / azimuths
    terms = np.matmul(
        around.reshape(2 * ORDERS, -1).astype(np.float32),
        stokes.reshape(directions, suns, -1, wavelengths),
    )
    for m in range(ORDERS):
        polar = np.stack([even[:, m], odd[:, m]], axis=1).astype(np.float32)
        moments = np.tensordot(polar, terms[:, :, m::ORDERS], axes=([0, 1], [0, 2]))
        field.radiance[i, :, field.harmonics.degree.size + m] = moments
