"""Equirectangular maps in OpenEXR's and USD's orientation.

Row 0 looks up. Columns run clockwise as seen from above, from north at the
left edge over east, south in the middle, and west. Texel centres lie at
(i + 1/2) / width.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

CELLS_PER_RADIUS = 48
"""Cells to a disc's radius, or one to a texel where texels are smaller."""


EVERYWHERE = (-math.inf, math.inf)


class Cells(NamedTuple):
    """Cells, finer than texels, that cover a disc on a map.

    Attributes
    ----------
    zenith, distance, solid_angle : ndarray of float64, shape (cell,)
        Zenith angles, angles from the disc's centre [rad], and sizes [sr] of what
        the disc covers of them.
    texel : ndarray of int, shape (cell, 4)
        Rows of `weight` in a flat image that each cell adds to.
    weight : ndarray of float64, shape (cell, 4)
        Shares of the cell's flux, over the texels' solid angles. [sr⁻¹]
    """

    zenith: Array
    distance: Array
    solid_angle: Array
    texel: npt.NDArray[np.int64]
    weight: Array


def row_zeniths(height: int) -> Array:
    """Zenith angles of the rows' centres, shape (height,). [rad]"""
    return math.pi * (np.arange(height) + 0.5) / height


def column_bearings(width: int) -> Array:
    """Compass bearings of the columns' centres, shape (width,). [rad]"""
    return 2.0 * math.pi * (np.arange(width) + 0.5) / width


def directions(width: int, height: int) -> Array:
    """Return unit vectors of all texels, shape (height, width, 3); +Y up, -Z north, +X east."""
    zenith = row_zeniths(height)[:, None]
    bearing = column_bearings(width)
    return np.stack(
        [
            np.sin(zenith) * np.sin(bearing),
            np.broadcast_to(np.cos(zenith), (height, width)),
            -np.sin(zenith) * np.cos(bearing),
        ],
        axis=-1,
    )


def solid_angles(width: int, height: int) -> Array:
    """Solid angle of a texel in each row, shape (height,); width times their sum is 4 pi. [sr]"""
    edge = np.cos(math.pi * np.arange(height + 1) / height)
    return 2.0 * math.pi / width * (edge[:-1] - edge[1:])


def disc_cells(width: int, height: int, zenith: float, bearing: float, radius: float) -> Cells:
    """Cut a disc into cells that share out their flux among texels.

    Parameters
    ----------
    width, height : int
        Size of the map.
    zenith, bearing, radius : float
        Centre of the disc and its angular radius. [rad]

    Returns
    -------
    Cells
        Empty cells outside the disc are left out.

    Notes
    -----
    A cell's flux goes to the two nearest rows and columns. Rows share it in
    proportion to the sine of the latitude, so that a map keeps both the flux and
    its vertical component (the illuminance of the ground) at any size, and a sun
    that moves through a sequence does not flicker from texel to texel.
    """
    row_step, column_step = math.pi / height, 2.0 * math.pi / width
    # Cells that the edge cuts may have their centres outside it.
    reach = radius * (1.0 + 2.0 / CELLS_PER_RADIUS)
    rows, sub_row = subdivide(zenith - reach, zenith + reach, row_step, radius, (0, height))
    if math.sin(zenith) <= math.sin(reach):
        low, high, borders = 0.0, 2.0 * math.pi, (0.0, float(width))
    else:
        half_width = math.asin(math.sin(reach) / math.sin(zenith))
        low, high, borders = bearing - half_width, bearing + half_width, EVERYWHERE
    columns, sub_column = subdivide(
        low, high, column_step, radius / max(math.sin(zenith), math.sin(radius)), borders
    )
    size = 2.0 * np.sin(rows * row_step) * math.sin(0.5 * sub_row) * sub_column
    row, column = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
    theta, phi = row * row_step, column * column_step - bearing
    chord = np.sin(theta) * math.sin(zenith) * np.sin(0.5 * phi) ** 2
    half_sine_squared = np.sin(0.5 * (theta - zenith)) ** 2 + chord
    distance = 2.0 * np.arcsin(np.minimum(np.sqrt(half_sine_squared), 1.0))
    # Cells are far from square near the poles. Across the edge they measure their
    # height and width times the slopes of the distance along each.
    across = math.sin(zenith) * np.sin(phi)
    along = np.sin(theta - zenith) + 2.0 * np.cos(theta) * math.sin(zenith) * np.sin(0.5 * phi) ** 2
    extent = np.abs(along) * sub_row + np.abs(across) * np.sin(theta) * sub_column
    extent /= np.maximum(np.sin(distance), 1e-12)
    distance, covered = cover(distance, radius, extent, np.repeat(size, columns.size))
    inside = covered > 0.0
    row, column = row[inside], column[inside]
    texel, weight = _bilinear(width, height, row, column)
    return Cells(
        zenith=theta[inside],
        distance=distance[inside],
        solid_angle=covered[inside],
        texel=texel,
        weight=weight,
    )


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


def _bilinear(
    width: int, height: int, row: Array, column: Array
) -> tuple[npt.NDArray[np.int64], Array]:
    """Flat indices of the four texels around points, and their weights [sr⁻¹]."""
    top = np.clip(np.floor(row - 0.5).astype(np.int64), 0, height - 2)
    cosine = np.cos(row_zeniths(height))
    down = (cosine[top] - np.cos(row * math.pi / height)) / (cosine[top] - cosine[top + 1])
    down = np.clip(down, 0.0, 1.0)
    left = np.floor(column - 0.5).astype(np.int64)
    right = column - 0.5 - left
    left, next_left = left % width, (left + 1) % width
    size = solid_angles(width, height)
    texel = np.stack(
        [y * width + x for y in (top, top + 1) for x in (left, next_left)],
        axis=1,
    )
    weight = np.stack(
        [
            (1.0 - down) * (1.0 - right) / size[top],
            (1.0 - down) * right / size[top],
            down * (1.0 - right) / size[top + 1],
            down * right / size[top + 1],
        ],
        axis=1,
    )
    return texel, weight
