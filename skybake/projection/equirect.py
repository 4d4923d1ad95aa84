"""Equirectangular maps in OpenEXR's and USD's orientation.

Row 0 looks up. Columns run clockwise as seen from above, from north at the
left edge over east, south in the middle, and west. Texel centres are at
(i + 1/2) / width; rows can be on the poles instead, as the letter of OpenEXR has it.
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
from skybake.projection.cells import Array, Cells
from skybake.projection.chart import Canvas, Chart, Projection, check_edge, size_text, whole
from skybake.projection.polar import polar_cells

ROWS = ("centres", "poles")
"""Where rows are: their centres at (i + 1/2) / height of the way from the zenith to the nadir, or
at i / (height - 1), such that the first row is the zenith and the last one the nadir."""


def row_zeniths(height: int, rows: str = "centres") -> Array:
    """Zenith angles of the rows, one of `ROWS`, shape (height,). [rad]"""
    if rows == "poles":
        return np.linspace(0.0, math.pi, height)
    return math.pi * (np.arange(height) + 0.5) / height


def column_bearings(width: int) -> Array:
    """Compass bearings of the columns' centres, shape (width,). [rad]"""
    return 2.0 * math.pi * (np.arange(width) + 0.5) / width


def directions(width: int, height: int) -> Array:
    """Return unit vectors of all texels, shape (height, width, 3); +Y up, -Z north, +X east."""
    elevation = math.pi / 2.0 - row_zeniths(height)
    return direction_from_angles(column_bearings(width), elevation[:, None])


def solid_angles(width: int, height: int, rows: str = "centres") -> Array:
    """Solid angle of a texel in each row, shape (height,); width times their sum is 4 pi. [sr]

    Rows at the poles count with what they add to a map that is interpolated between rows.
    """
    if rows == "poles":
        step = _row_step(height, rows)
        weight = np.sin(row_zeniths(height, rows)) * 4.0 * math.sin(0.5 * step) ** 2 / step
        weight[[0, -1]] = _pole(step)[0]
        size: Array = 2.0 * math.pi / width * weight
        return size
    edge = np.cos(math.pi * np.arange(height + 1) / height)
    return 2.0 * math.pi / width * (edge[:-1] - edge[1:])


def _row_step(height: int, rows: str) -> float:
    return math.pi / (height - 1 if rows == "poles" else height)


def _mean_cosines(height: int) -> Array:
    """Mean cosine of the zenith angle by which rows at the poles light a map that is interpolated.

    Each row fades linearly to its neighbours, which is integrated over the sphere.
    """
    step = _row_step(height, "poles")
    cosine: Array = np.cos(row_zeniths(height, "poles")) * math.cos(0.5 * step) ** 2
    _, pole = _pole(step)
    cosine[[0, -1]] = pole, -pole
    return cosine


def _pole(step: float) -> tuple[float, float]:
    """Height of the zone that a row at the pole makes up, and its mean cosine, see above.

    By quadrature, since closed forms cancel.
    """
    node, weight = np.polynomial.legendre.leggauss(16)
    theta = 0.5 * step * (node + 1.0)
    share = 0.5 * step * weight * (1.0 - theta / step) * np.sin(theta)
    height = float(share.sum())
    return height, 1.0 - float((share * 2.0 * np.sin(0.5 * theta) ** 2).sum()) / height


class EquirectChart(Chart):
    """Pixels of an equirect map.

    Parameters
    ----------
    width : int
        Twice the height. [pixel]
    rows : {"centres", "poles"}, optional
        One of `ROWS`.
    """

    wraps: ClassVar[bool] = True
    is_separable: ClassVar[bool] = True

    def __init__(self, width: int, rows: str = "centres") -> None:
        self.width, self.height = width, width // 2
        self.rows = rows

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the texels: rows share zenith angles, columns bearings."""
        zenith = row_zeniths(self.height, self.rows)
        return zenith[first:last, None], column_bearings(self.width)[None]

    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Where the map shows directions."""
        zenith, bearing = zenith_azimuth(vectors)
        turns = bearing / (2.0 * math.pi)
        row = zenith / _row_step(self.height, self.rows)
        row = row + 0.5 if self.rows == "poles" else row
        return row, (turns - np.floor(turns)) * self.width

    def footprints(self, _first: int, _last: int) -> Array:
        """Extent of a texel in zenith angle."""
        return np.full((1, 1), _row_step(self.height, self.rows))

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angle of a texel in each row, shape (row, 1). [sr]"""
        return solid_angles(self.width, self.height, self.rows)[first:last, None]

    def stretch(self, row: Array) -> Array:
        """How many times as narrow as high pixels are: ever more toward the poles."""
        row = row - 0.5 if self.rows == "poles" else row
        sine = np.sin(row * _row_step(self.height, self.rows))
        narrow: Array = 1.0 / np.maximum(sine, 0.5 / self.width)
        return narrow

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the four nearest texels.

        Notes
        -----
        A cell's flux is shared by the two nearest rows and columns. Rows share it in
        proportion to the sine of the latitude, so that a map keeps both the flux and
        its vertical component (the illuminance of the ground) at any size, and a sun
        that moves through a sequence does not flicker from texel to texel.
        """
        width, row_step = self.width, _row_step(self.height, self.rows)
        column_step = 2.0 * math.pi / width
        row, column, distance, solid_angle = polar_cells(
            zenith,
            bearing,
            radius,
            row_step=row_step,
            column_step=column_step,
            last_row=math.pi / row_step,
        )
        theta = row * row_step
        top, down = self._nearest_rows(row, theta)
        left = np.floor(column - 0.5).astype(np.int64)
        right = column - 0.5 - left
        columns, size = (left % width, (left + 1) % width), self.solid_angles(0, self.height)[:, 0]
        return Cells(
            zenith=theta,
            azimuth=column * column_step,
            distance=distance,
            solid_angle=solid_angle,
            texel=np.stack([y * width + x for y in (top, top + 1) for x in columns], axis=1),
            weight=np.stack(
                [
                    (1.0 - down) * (1.0 - right) / size[top],
                    (1.0 - down) * right / size[top],
                    down * (1.0 - right) / size[top + 1],
                    down * right / size[top + 1],
                ],
                axis=1,
            ),
        )

    def _nearest_rows(self, row: Array, zenith: Array) -> tuple[npt.NDArray[np.int64], Array]:
        """Upper one of the two rows that share each cell's flux, and the lower one's share."""
        height = self.height
        if self.rows == "centres":
            cosine = np.cos(row_zeniths(height))
            top = np.floor(row - 0.5).astype(np.int64)
        else:
            cosine = _mean_cosines(height)
            top = np.searchsorted(-cosine, -np.cos(zenith), side="right") - 1
        top = np.clip(top, 0, height - 2)
        down = (cosine[top] - np.cos(zenith)) / (cosine[top] - cosine[top + 1])
        return top, np.clip(down, 0.0, 1.0)


@dataclass(frozen=True)
class Equirect(Projection):
    """The whole sphere by bearing and zenith angle.

    Attributes
    ----------
    width : int
        Twice the height. [pixel]
    rows : {"centres", "poles"}
        One of `ROWS`.
    """

    name: ClassVar[str] = "equirect"
    width: int = 2048
    rows: str = "centres"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        if self.rows not in ROWS:
            raise InputError(f"equirect rows: must be one of {', '.join(ROWS)}, got {self.rows!r}")
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
        return (whole(EquirectChart(self.width, self.rows), envmap="latlong"),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        return self.name if self.rows == ROWS[0] else f"{self.name}_{self.rows}"

    def recipe(self) -> dict[str, Any]:
        """Name, width and place of the rows."""
        return {
            "projection": self.name,
            "width": self.width,
            "cube_layout": None,
            "equirect_rows": self.rows,
        }

    def smaller(self, width: int) -> Projection:
        """Return a map of at most this width."""
        return Equirect(min(self.width, width))

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)
