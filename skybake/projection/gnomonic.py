"""Flat pictures: pixels on a plane before the observer, as of a camera or a cube's face."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles
from skybake.projection.cells import (
    CELLS_PER_RADIUS,
    Array,
    Cells,
    cells_of_one_texel,
    subdivide,
)
from skybake.projection.chart import Chart
from skybake.projection.frame import PictureAxes

# A direction on the edge of a cube belongs to one of two faces, or by rounding to neither.
_ROUNDING = 1e-9


class GnomonicChart(Chart):
    """Pixels evenly spaced on a plane at distance 1.

    Parameters
    ----------
    frame : PictureAxes
        Where the picture's right, its top and its middle look.
    half_width, half_height : float
        Tangents of half the angles that the picture covers.
    width, height : int
        [pixel]
    shift : tuple of float, optional
        Where on the plane the middle of the picture is: right of the axis, and above it.
    """

    def __init__(
        self,
        frame: PictureAxes,
        half_width: float,
        half_height: float,
        width: int,
        height: int,
        shift: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.frame = frame
        self.shift = shift
        self.width, self.height = width, height
        self.half_width, self.half_height = half_width, half_height

    def vectors(self, first: int, last: int) -> Array:
        """Return unit vectors of the pixels in rows first..last, shape (row, column, 3)."""
        column, row = np.arange(self.width), np.arange(first, last)[:, None]
        return self._vectors(*np.broadcast_arrays(*self._plane(column + 0.5, row + 0.5)))

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the pixels in rows first..last."""
        column, row = np.arange(self.width), np.arange(first, last)[:, None]
        x, y, z = self._components(*self._plane(column + 0.5, row + 0.5))
        return np.arctan2(np.hypot(x, z), y), np.arctan2(x, -z)

    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Where the picture shows directions."""
        frame = self.frame
        before = vectors @ frame.forward
        with np.errstate(divide="ignore", invalid="ignore"):
            u = vectors @ frame.right / before - self.shift[0]
            v = self.shift[1] - vectors @ frame.up / before
            column = 0.5 * self.width * (u / self.half_width + 1.0)
            row = 0.5 * self.height * (v / self.half_height + 1.0)
        shown = (before > 0.0) & (np.abs(2.0 * column / self.width - 1.0) <= 1.0 + _ROUNDING)
        shown &= np.abs(2.0 * row / self.height - 1.0) <= 1.0 + _ROUNDING
        return np.where(shown, row, np.nan), np.where(shown, column, np.nan)

    def footprints(self, first: int, last: int) -> Array:
        """Extents of pixels in zenith angle."""
        return self.looks(first, last)[2]

    def looks(self, first: int, last: int) -> tuple[Array, Array, Array]:
        """Return `angles` and `footprints`."""
        column, row = np.arange(self.width), np.arange(first, last)[:, None]
        u, v = self._plane(column + 0.5, row + 0.5)
        x, y, z = self._components(u, v)
        flat = np.hypot(x, z)
        nearer = 1.0 / np.sqrt(1.0 + u * u + v * v)
        right, up = self.frame.right, self.frame.up
        across = 2.0 * self.half_width / self.width * nearer
        along = 2.0 * self.half_height / self.height * nearer
        # In the zenith and the nadir, away from the north, as the bearing has it.
        is_upright = flat == 0.0
        steep = y / np.where(is_upright, 1.0, flat)
        downward = x * steep, -flat, np.where(is_upright, y, z * steep)
        extent = np.hypot(_along(downward, across, right), _along(downward, along, up))
        return np.arctan2(flat, y), np.arctan2(x, -z), extent

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angles of pixels, shape (row, column). [sr]"""
        return self._solid_angles(np.arange(first, last)[:, None], np.arange(self.width))

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the one pixel that it is in."""
        frame, width, height = self.frame, self.width, self.height
        centre = direction_from_angles(bearing, math.pi / 2.0 - zenith)
        # Cells that the edge cuts may have their centres outside it.
        reach = radius * (1.0 + 2.0 / CELLS_PER_RADIUS)
        bounds = self._disc_bounds(
            float(frame.right @ centre),
            float(frame.up @ centre),
            float(frame.forward @ centre),
            reach,
        )
        (left, right), (top, bottom) = bounds
        half_width, half_height = self.half_width, self.half_height
        # Of the picture's left and top on the plane.
        first_u, first_v = self.shift[0] - half_width, -self.shift[1] - half_height
        columns, cell_width = subdivide(
            left - first_u, right - first_u, 2.0 * half_width / width, radius, (0, width)
        )
        rows, cell_height = subdivide(
            top - first_v, bottom - first_v, 2.0 * half_height / height, radius, (0, height)
        )
        column, row = (grid.ravel() for grid in np.meshgrid(columns, rows))
        u, v = self._plane(column, row)
        vectors = self._vectors(u, v)
        size = cell_width * cell_height / (1.0 + u * u + v * v) ** 1.5
        texel_row, texel_column = row.astype(np.int64), column.astype(np.int64)
        texel_size = self._solid_angles(texel_row, texel_column)
        texel = texel_row * width + texel_column
        return cells_of_one_texel(vectors, centre, radius, size, texel, texel_size)

    def _plane(self, column: npt.NDArray[Any], row: npt.NDArray[Any]) -> tuple[Array, Array]:
        """Places on the plane, right and down of its axis, given in pixels."""
        return (
            2.0 * self.half_width * column / self.width - self.half_width + self.shift[0],
            2.0 * self.half_height * row / self.height - self.half_height - self.shift[1],
        )

    def _vectors(self, u: Array, v: Array) -> Array:
        return np.stack(self._components(u, v), axis=-1)

    def _components(self, u: Array, v: Array) -> tuple[Array, Array, Array]:
        """Return x, y and z of unit vectors, by themselves, which is several times as fast."""
        x, y, z = (ahead + u * right - v * up for right, up, ahead in zip(*self.frame, strict=True))
        length = np.sqrt(x * x + y * y + z * z)
        return x / length, y / length, z / length

    def _solid_angles(self, row: npt.NDArray[np.int64], column: npt.NDArray[np.int64]) -> Array:
        u, v = self._plane(column, row)
        width = 2.0 * self.half_width / self.width
        height = 2.0 * self.half_height / self.height
        size: Array = (
            _corner_solid_angle(u + width, v + height)
            - _corner_solid_angle(u, v + height)
            - _corner_solid_angle(u + width, v)
            + _corner_solid_angle(u, v)
        )
        return size

    def _disc_bounds(
        self, x: float, y: float, z: float, radius: float
    ) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ranges of u and v that hold a disc around (x, y, z); empty if the picture misses it."""
        across, along = map(abs, self.shift)
        nowhere = (across + 2.0 * self.half_width,) * 2, (along + 2.0 * self.half_height,) * 2
        corner = math.atan(math.hypot(self.half_width + across, self.half_height + along))
        if z < math.cos(min(corner + radius, math.pi / 2.0 - radius)):
            return nowhere
        from_middle = math.acos(min(z, 1.0))
        stretched = math.tan(radius) * (1.0 + (x * x + y * y) / (z * z)) * 1.1
        outward = math.tan(min(from_middle + radius, math.pi / 2.0 - 1e-3)) - math.tan(from_middle)
        reach = max(stretched, outward)
        return (x / z - reach, x / z + reach), (-y / z - reach, -y / z + reach)


def _along(direction: tuple[Array, Array, Array], length: Array, unit: Array) -> Array:
    """Product of a direction with a vector that is given by its length and a unit vector."""
    x, y, z = (length * part * other for part, other in zip(unit, direction, strict=True))
    product: Array = x + y + z
    return product


def _corner_solid_angle(u: Array, v: Array) -> Array:
    """Solid angle of the rectangle from the middle of the plane to a corner, with its sign. [sr]"""
    area: Array = np.arctan2(u * v, np.sqrt(u * u + v * v + 1.0))
    return area
