"""Discs on maps, cut into cells finer than pixels, that keep their flux."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.angles import zenith_azimuth

Array = npt.NDArray[np.float64]

CELLS_PER_RADIUS = 48
"""Cells to a disc's radius, or one to a texel where texels are smaller."""


class Cells(NamedTuple):
    """Cells, finer than texels, that cover a disc on a map.

    Attributes
    ----------
    zenith, azimuth : ndarray of float64, shape (cell,)
        Where they are. [rad]
    distance, solid_angle : ndarray of float64, shape (cell,)
        Angles from the disc's centre [rad], and sizes [sr] of what the disc covers of them.
    texel : ndarray of int, shape (cell, 4)
        Rows of `weight` in a flat image that each cell adds to.
    weight : ndarray of float64, shape (cell, 4)
        Shares of the cell's flux, over the texels' solid angles. [sr⁻¹]
    """

    zenith: Array
    azimuth: Array
    distance: Array
    solid_angle: Array
    texel: npt.NDArray[np.int64]
    weight: Array


def cells_of_one_texel(
    vectors: Array,
    centre: Array,
    radius: float,
    solid_angle: Array,
    texel: npt.NDArray[np.int64],
    texel_solid_angle: Array,
) -> Cells:
    """Cells of a disc, each of which adds to the one texel that it lies in.

    Parameters
    ----------
    vectors : ndarray of float64, shape (cell, 3)
        Unit vectors of the cells' centres.
    centre, radius : ndarray of float64, shape (3,), float
        Unit vector of the disc's centre, and its angular radius. [rad]
    solid_angle : ndarray of float64, shape (cell,)
        Of the cells, which are nearly square. [sr]
    texel : ndarray of int64, shape (cell,)
        Indices in a flat image.
    texel_solid_angle : ndarray of float64, shape (cell,)
        Of these texels; cells in those of 0 are left out. [sr]
    """
    distance = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(vectors - centre, axis=-1), 1.0))
    distance, covered = cover(distance, radius, np.sqrt(solid_angle), solid_angle)
    inside = (covered > 0.0) & (texel_solid_angle > 0.0)
    zenith, azimuth = zenith_azimuth(vectors[inside])
    texels = np.zeros((np.count_nonzero(inside), 4), np.int64)
    texels[:, 0] = texel[inside]
    weight = np.zeros(texels.shape)
    weight[:, 0] = 1.0 / texel_solid_angle[inside]
    return Cells(zenith, azimuth, distance[inside], covered[inside], texels, weight)


def cover(distance: Array, radius: float, extent: Array, solid_angle: Array) -> tuple[Array, Array]:
    """Parts of cells that a disc covers.

    Parameters
    ----------
    distance, radius : ndarray of float64, float
        Angles of the cells' centres from the disc's centre, and the disc's radius. [rad]
    extent, solid_angle : ndarray of float64, of the shape of `distance`
        Widths of the cells in the direction of the centre [rad], and their sizes [sr].

    Returns
    -------
    distance, solid_angle : ndarray of float64
        Of the covered parts. A cell that the edge cuts counts by its share: all or
        nothing would leave up to 2 % too much or too little in sum.
    """
    near, far = distance - 0.5 * extent, distance + 0.5 * extent
    share = np.clip((radius - near) / np.maximum(extent, 1e-12), 0.0, 1.0)
    # Limb darkening falls with the root of the distance from the edge, whose mean over
    # a stretch that ends there is its value at 4/9 of the stretch.
    middle: Array = np.where(far <= radius, distance, radius - 4.0 / 9.0 * (radius - near))
    covered: Array = share * solid_angle
    return middle, covered


def subdivide(
    low: float,
    high: float,
    step: float,
    radius: float,
    borders: tuple[float, float],
) -> tuple[Array, float]:
    """Cut a span into cells that are whole parts of texels.

    Parameters
    ----------
    low, high, step : float
        Ends of the span and width of a texel.
    radius : float
        The disc's, in the same unit; `CELLS_PER_RADIUS` cells or more make it up.
    borders : (float, float)
        First and last border of texels, between which the cells stay.

    Returns
    -------
    centres : ndarray of float64
        In texels.
    width : float
        Of a cell, in the unit of `step`.
    """
    count = math.ceil(step * CELLS_PER_RADIUS / radius)
    first = math.floor(max(low / step, borders[0]) * count)
    last = math.ceil(min(high / step, borders[1]) * count)
    return (np.arange(first, last) + 0.5) / count, step / count
