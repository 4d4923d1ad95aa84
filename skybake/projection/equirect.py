"""Equirectangular maps in OpenEXR's and USD's orientation.

Row 0 looks up. Columns run clockwise as seen from above, from north at the
left edge over east, south in the middle, and west. Texel centres are at
(i + 1/2) / width.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from skybake.angles import direction_from_angles, zenith_azimuth
from skybake.errors import InputError
from skybake.projection.cells import CELLS_PER_RADIUS, Array, Cells, cover, subdivide
from skybake.projection.chart import Canvas, Chart, Projection, check_edge, size_text, whole

EVERYWHERE = (-math.inf, math.inf)


def row_zeniths(height: int) -> Array:
    """Zenith angles of the rows' centres, shape (height,). [rad]"""
    return math.pi * (np.arange(height) + 0.5) / height


def column_bearings(width: int) -> Array:
    """Compass bearings of the columns' centres, shape (width,). [rad]"""
    return 2.0 * math.pi * (np.arange(width) + 0.5) / width


def directions(width: int, height: int) -> Array:
    """Return unit vectors of all texels, shape (height, width, 3); +Y up, -Z north, +X east."""
    elevation = math.pi / 2.0 - row_zeniths(height)
    return direction_from_angles(column_bearings(width), elevation[:, None])


def solid_angles(width: int, height: int) -> Array:
    """Solid angle of a texel in each row, shape (height,); width times their sum is 4 pi. [sr]"""
    edge = np.cos(math.pi * np.arange(height + 1) / height)
    return 2.0 * math.pi / width * (edge[:-1] - edge[1:])


class EquirectChart(Chart):
    """Pixels of an equirect map.

    Parameters
    ----------
    width : int
        Twice the height. [pixel]
    """

    wraps: ClassVar[bool] = True

    def __init__(self, width: int) -> None:
        self.width, self.height = width, width // 2

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the texels: rows share zenith angles, columns bearings."""
        return row_zeniths(self.height)[first:last, None], column_bearings(self.width)[None]

    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Where the map shows directions."""
        zenith, bearing = zenith_azimuth(vectors)
        turns = bearing / (2.0 * math.pi)
        return zenith / math.pi * self.height, (turns - np.floor(turns)) * self.width

    def footprints(self, _first: int, _last: int) -> Array:
        """Extent of a texel in zenith angle."""
        return np.full((1, 1), math.pi / self.height)

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angle of a texel in each row, shape (row, 1). [sr]"""
        return solid_angles(self.width, self.height)[first:last, None]

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the four nearest texels.

        Notes
        -----
        A cell's flux is shared by the two nearest rows and columns. Rows share it in
        proportion to the sine of the latitude, so that a map keeps both the flux and
        its vertical component (the illuminance of the ground) at any size, and a sun
        that moves through a sequence does not flicker from texel to texel.
        """
        width, height = self.width, self.height
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
        along = (
            np.sin(theta - zenith) + 2.0 * np.cos(theta) * math.sin(zenith) * np.sin(0.5 * phi) ** 2
        )
        extent = np.abs(along) * sub_row + np.abs(across) * np.sin(theta) * sub_column
        extent /= np.maximum(np.sin(distance), 1e-12)
        distance, covered = cover(distance, radius, extent, np.repeat(size, columns.size))
        inside = covered > 0.0
        row, column = row[inside], column[inside]
        texel, weight = _bilinear(width, height, row, column)
        return Cells(
            zenith=theta[inside],
            azimuth=phi[inside] + bearing,
            distance=distance[inside],
            solid_angle=covered[inside],
            texel=texel,
            weight=weight,
        )


@dataclass(frozen=True)
class Equirect(Projection):
    """The whole sphere by bearing and zenith angle.

    Attributes
    ----------
    width : int
        Twice the height. [pixel]
    """

    name: ClassVar[str] = "equirect"
    lights_a_dome: ClassVar[bool] = True
    width: int = 2048

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        check_edge(self.width, smallest=4)
        if self.width % 2:
            raise InputError(f"size: width must be twice the height, got an odd width {self.width}")

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of a width, with or without the height that is half of it."""
        if size is None:
            return cls(**options)
        if len(size) == 2 and size[0] != 2 * size[1]:
            raise InputError(f"size: width must be twice the height, got {size_text(size)}")
        return cls(width=size[0], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return the one picture."""
        return (whole(EquirectChart(self.width), envmap="latlong"),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        return self.name

    def recipe(self) -> dict[str, Any]:
        """Name and width."""
        return {"projection": self.name, "width": self.width, "cube_layout": None}

    def smaller(self, width: int) -> Projection:
        """Return a map of at most this width."""
        return Equirect(min(self.width, width))

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)


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
