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

CELLS_PER_RADIUS = 12
MIN_CELLS_PER_TEXEL = 4


class Cells(NamedTuple):
    """Cells, finer than texels, that cover a disc on a map.

    Attributes
    ----------
    zenith, distance, solid_angle : ndarray of float64, shape (cell,)
        Zenith angles, angles from the disc's centre [rad], and sizes [sr].
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
    """Unit vectors of all texels, shape (height, width, 3); +Y up, -Z north, +X east."""
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
    first = max(0, math.floor((zenith - radius) / row_step))
    last = min(height, math.ceil((zenith + radius) / row_step))
    rows = _subdivide(first, last, row_step, radius)
    theta = rows * row_step
    if math.sin(zenith) <= math.sin(radius):
        column_first, column_last = 0, width
    else:
        reach = math.asin(math.sin(radius) / math.sin(zenith))
        column_first = math.floor((bearing - reach) / column_step)
        column_last = math.ceil((bearing + reach) / column_step)
    columns = _subdivide(
        column_first, column_last, column_step, radius / max(math.sin(zenith), math.sin(radius))
    )
    sub_row = row_step * (last - first) / rows.size
    sub_column = column_step * (column_last - column_first) / columns.size
    size = 2.0 * np.sin(theta) * math.sin(0.5 * sub_row) * sub_column
    row, column = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
    half_sine_squared = (
        np.sin(0.5 * (row * row_step - zenith)) ** 2
        + np.sin(row * row_step)
        * math.sin(zenith)
        * np.sin(0.5 * (column * column_step - bearing)) ** 2
    )
    distance = 2.0 * np.arcsin(np.minimum(np.sqrt(half_sine_squared), 1.0))
    inside = distance < radius
    row, column, distance = row[inside], column[inside], distance[inside]
    texel, weight = _bilinear(width, height, row, column)
    return Cells(
        zenith=row * row_step,
        distance=distance,
        solid_angle=np.repeat(size, columns.size)[inside],
        texel=texel,
        weight=weight,
    )


def _subdivide(first: int, last: int, step: float, radius: float) -> Array:
    """Centres of cells in texel units, at least `CELLS_PER_RADIUS` to the disc's radius."""
    count = max(MIN_CELLS_PER_TEXEL, math.ceil(step * CELLS_PER_RADIUS / radius))
    return first + (np.arange((last - first) * count) + 0.5) / count


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
        [top * width + left, top * width + next_left]
        + [(top + 1) * width + left, (top + 1) * width + next_left],
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
