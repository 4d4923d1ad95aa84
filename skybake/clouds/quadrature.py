"""Directions in which light travels through a layer."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.optics.medium import Array

SAMPLES = 4
"""Samples of a direction's cell, in each of its two angles."""


class Quadrature(NamedTuple):
    """Directions of travel; those that go down come first.

    Attributes
    ----------
    direction : ndarray of float64, shape (direction, 3)
        Unit vectors: x east, y north, z up.
    weight : ndarray of float64, shape (direction,)
        Solid angles, which add up to 4 pi. [sr]
    polar, azimuths : int
        Cosines in a hemisphere, and directions at each.
    """

    direction: Array
    weight: Array
    polar: int
    azimuths: int

    @property
    def downward(self) -> slice:
        """Directions that go down."""
        return slice(0, len(self.weight) // 2)

    @property
    def upward(self) -> slice:
        """Directions that go up."""
        return slice(len(self.weight) // 2, None)

    def flux(self, radiance: Array) -> Array:
        """Sum radiances of one hemisphere, (direction, ...), to the irradiance of a level plane."""
        half = len(self.weight) // 2
        weight = self.weight[:half] * np.abs(self.direction[:half, 2])
        flux: Array = np.tensordot(weight, radiance, axes=1)
        return flux

    def flux_scattered(self, radiance: Array, depth: Array) -> Array:
        """Irradiance of a level plane by equal radiances that air scatters as much of.

        Parameters
        ----------
        radiance : ndarray of float64, shape (direction, channel)
            Of one hemisphere.
        depth : ndarray of float64, shape (channel,)
            Vertical optical depth of the air that light comes into. Of what is nearly level it
            scatters more.
        """
        half = len(self.weight) // 2
        slope = np.abs(self.direction[:half, 2])[:, None]
        weight = self.weight[:half, None] * slope * -np.expm1(-depth / slope)
        flux: Array = math.pi * (weight * radiance).sum(axis=0) / weight.sum(axis=0)
        return flux


def double_gauss(order: int, turn: float) -> Quadrature:
    """Directions that integrate harmonics up to an order, in each hemisphere by itself.

    Parameters
    ----------
    order : int
        Highest degree of the phase function.
    turn : float
        Azimuth of the first direction, from east to north. [rad]

    Notes
    -----
    A quadrature over the whole sphere would be poor for fluxes, which are integrals over halves of
    it (Sykes 1951). Azimuths of neighbouring cosines are staggered.
    """
    polar, azimuths = order // 2 + 1, 2 * (order + 1)
    node, weight = np.polynomial.legendre.leggauss(polar)
    node, weight = 0.5 * (node + 1.0), 0.5 * weight
    directions, weights = [], []
    for sign in (-1.0, 1.0):
        for p in range(polar):
            for a in range(azimuths):
                phi = turn + 2.0 * math.pi * (a + 0.5 * (p % 2)) / azimuths
                sine = math.sqrt(1.0 - node[p] ** 2)
                directions.append((sine * math.cos(phi), sine * math.sin(phi), sign * node[p]))
                weights.append(2.0 * math.pi * weight[p] / azimuths)
    return Quadrature(np.array(directions), np.array(weights), polar, azimuths)


def cell_samples(quadrature: Quadrature, turn: float, hemisphere: slice) -> tuple[Array, Array]:
    """Directions of travel within the cell of each direction of a hemisphere, and their weights.

    Returns
    -------
    direction : ndarray of float64, shape (direction, sample, 3)
        Cells divide the hemisphere.
    weight : ndarray of float64, shape (direction, sample)
        Shares of the cell's flux that equal radiances would bring; they add up to 1.
    """
    downward = hemisphere.start == 0
    sign = -1.0 if downward else 1.0
    chosen = quadrature.weight[hemisphere].reshape(quadrature.polar, -1)
    edges = np.concatenate([[0.0], np.cumsum(chosen.sum(axis=1)) / (2.0 * math.pi)])
    share = (np.arange(SAMPLES) + 0.5) / SAMPLES
    out, weights = [], []
    for p in range(quadrature.polar):
        mu = edges[p] + (edges[p + 1] - edges[p]) * share
        for a in range(quadrature.azimuths):
            step = 2.0 * math.pi / quadrature.azimuths
            phi = turn + step * (a + 0.5 * (p % 2) + share - 0.5)
            cosine, azimuth = (each.ravel() for each in np.meshgrid(mu, phi, indexing="ij"))
            sine = np.sqrt(1.0 - cosine**2)
            out.append(
                np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), sign * cosine], axis=1)
            )
            weights.append(cosine / cosine.sum())
    return np.array(out), np.array(weights)
