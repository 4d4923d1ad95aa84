"""Discs in polar coordinates: angles from an axis, and around it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from skybake.projection.cells import CELLS_PER_RADIUS, Array, cover, subdivide

EVERYWHERE = (-math.inf, math.inf)


class PolarCells(NamedTuple):
    """Cells of a disc between circles and half-planes around an axis.

    Attributes
    ----------
    row, column : ndarray of float64, shape (cell,)
        Angles from the axis and around it, in steps of a map's rows and columns.
    distance, solid_angle : ndarray of float64, shape (cell,)
        As of `skybake.projection.cells.Cells`. [rad], [sr]
    """

    row: Array
    column: Array
    distance: Array
    solid_angle: Array


def polar_cells(
    polar: float,
    around: float,
    radius: float,
    *,
    row_step: float,
    column_step: float,
    last_row: float,
) -> PolarCells:
    """Cut a disc into cells.

    Parameters
    ----------
    polar, around, radius : float
        Angles of its centre from the axis and around it, and its angular radius. [rad]
    row_step, column_step : float
        Steps of the two angles, of which cells are whole parts. [rad]
    last_row : float
        The angle pi from the axis, in rows.
    """
    # Cells that the edge cuts may have their centres outside it.
    reach = radius * (1.0 + 2.0 / CELLS_PER_RADIUS)
    rows, sub_row = subdivide(polar - reach, polar + reach, row_step, radius, (0, last_row))
    if math.sin(polar) <= math.sin(reach):
        low, high, borders = 0.0, 2.0 * math.pi, (0.0, 2.0 * math.pi / column_step)
    else:
        half_width = math.asin(math.sin(reach) / math.sin(polar))
        low, high, borders = around - half_width, around + half_width, EVERYWHERE
    columns, sub_column = subdivide(
        low, high, column_step, radius / max(math.sin(polar), math.sin(radius)), borders
    )
    size = 2.0 * np.sin(rows * row_step) * math.sin(0.5 * sub_row) * sub_column
    row, column = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
    theta, phi = row * row_step, column * column_step - around
    chord = np.sin(theta) * math.sin(polar) * np.sin(0.5 * phi) ** 2
    half_sine_squared = np.sin(0.5 * (theta - polar)) ** 2 + chord
    distance = 2.0 * np.arcsin(np.minimum(np.sqrt(half_sine_squared), 1.0))
    # Cells are far from square near the poles. Across the edge they measure their
    # height and width times the slopes of the distance along each.
    across = math.sin(polar) * np.sin(phi)
    along = np.sin(theta - polar) + 2.0 * np.cos(theta) * math.sin(polar) * np.sin(0.5 * phi) ** 2
    extent = np.abs(along) * sub_row + np.abs(across) * np.sin(theta) * sub_column
    extent /= np.maximum(np.sin(distance), 1e-12)
    distance, covered = cover(distance, radius, extent, np.repeat(size, columns.size))
    inside = covered > 0.0
    return PolarCells(row[inside], column[inside], distance[inside], covered[inside])
