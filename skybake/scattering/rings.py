"""Rings of directions around each sun at each altitude, and moments about the zenith over them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.jit.workers import Workers
from skybake.optics.medium import Array
from skybake.scattering.aureole import LAST_ANGLE
from skybake.scattering.field import DiffuseField
from skybake.scattering.grid import Grid
from skybake.scattering.harmonics import harmonics_at

RINGS = 10
"""Angles from the sun at which light is traced."""

SIDES = 2
"""Position angles on either side of the horizon at which it is."""

FADES_FROM = math.radians(35.0)
"""Angle from the sun beyond which the difference fades, so that no edge is seen at the last."""


class Rings(NamedTuple):
    """Rings around each sun at each altitude.

    Attributes
    ----------
    cosine, weight : ndarray, shape (ring,)
        Cosine of the angle from the sun, and its share of d cosine.
    position, position_weight : ndarray, shape (altitude, sun, ring, position)
        Position angle about the sun, 0 toward the zenith, to pi; apart above and below the
        horizon where that crosses a ring. [rad]
    mu : ndarray, shape (altitude, sun, ring, position)
        Cosines of the zenith angles.
    """

    cosine: Array
    weight: Array
    position: Array
    position_weight: Array
    mu: Array


def rings_around(r_bottom: float, grid: Grid) -> Rings:
    """Lay rings up to `LAST_ANGLE` around each sun of a grid; the ground has radius `r_bottom`."""
    x, share = np.polynomial.legendre.leggauss(RINGS)
    x, share = 0.5 * (x + 1.0), 0.5 * share
    versine = 1.0 - math.cos(LAST_ANGLE)
    cosine, weight = 1.0 - versine * x**2, 2.0 * versine * x * share
    mu_s, sine_s = np.cos(grid.sun_angle)[:, None], np.sin(grid.sun_angle)[:, None]
    sine = np.sqrt(1.0 - cosine**2)
    mu_horizon = -np.sqrt(np.maximum(1.0 - (r_bottom / (r_bottom + grid.altitude)) ** 2, 0.0))
    crossing = (mu_horizon[:, None, None] - cosine * mu_s) / np.maximum(sine * sine_s, 1e-12)
    edge = np.where(np.abs(crossing) < 1.0, np.arccos(np.clip(crossing, -1.0, 1.0)), math.pi / 2.0)
    edge = edge[..., None]
    y, share = np.polynomial.legendre.leggauss(SIDES)
    y, share = 0.5 * (y + 1.0), 0.5 * share
    position = np.concatenate([edge * y, edge + (math.pi - edge) * y], axis=-1)
    mu = cosine[:, None] * mu_s[..., None] + (sine * sine_s)[..., None] * np.cos(position)
    return Rings(
        cosine=cosine,
        weight=weight,
        position=position,
        position_weight=np.concatenate([edge * share, (math.pi - edge) * share], axis=-1),
        mu=mu,
    )


def fade(angle: Array) -> Array:
    """Share of the light at angles from the sun [rad] that is kept: all, then less, to none."""
    fading = np.clip((angle - FADES_FROM) / (LAST_ANGLE - FADES_FROM), 0.0, 1.0)
    share: Array = np.cos(0.5 * math.pi * fading) ** 2
    return share


def project_rings(
    grid: Grid, around: Rings, radiance: Array, field: DiffuseField, workers: Workers
) -> DiffuseField:
    """Moments about the zenith of light around the sun."""
    solid_angle = 2.0 * around.weight[:, None] * around.position_weight
    mu_s, sine_s = np.cos(grid.sun_angle), np.sin(grid.sun_angle)
    moments = np.zeros_like(field.radiance)
    plain = field.harmonics.degree.size

    def work(first: int, last: int) -> None:
        for i in range(first, last):
            mu = around.mu[i]
            sines = np.sqrt(np.maximum(1.0 - mu**2, 0.0)) * sine_s[:, None, None]
            across = (around.cosine[:, None] - mu * mu_s[:, None, None]) / np.maximum(sines, 1e-12)
            azimuth = np.arccos(np.clip(across, -1.0, 1.0))
            for j in range(mu_s.size):
                basis = harmonics_at(field.harmonics, mu[j].ravel())
                basis *= np.cos(np.outer(azimuth[j].ravel(), field.harmonics.azimuthal))
                basis *= solid_angle[i, j].reshape(-1, 1)
                moments[i, j, :plain] = basis.T @ radiance[i, j].reshape(len(basis), -1)

    workers.run_rows(len(radiance), work)
    flux = solid_angle[0] * np.maximum(around.mu[0], 0.0)
    ground = np.einsum("jqp,jqpw->jw", flux, radiance[0], optimize=True)
    return field._replace(radiance=moments, ground=ground.astype(float))
