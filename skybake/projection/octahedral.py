"""Octahedral maps: the sphere on an octahedron that is unfolded into a square.

With u to the right and v downward, both in [-1, 1], a pixel looks along::

    (u, 1 - |u| - |v|, v)                                          where |u| + |v| <= 1
    (sign(u) (1 - |v|), 1 - |u| - |v|, sign(v) (1 - |u|))          beyond

Up is in the middle, the horizon a square on its corner, east to the right, south at the bottom, and
all four corners look down. Texel centres are at (i + 1/2) / edge.
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
from skybake.projection.cells import Array, Cells, cells_of_one_texel
from skybake.projection.chart import Canvas, Chart, Projection, check_edge, size_text, whole
from skybake.projection.equirect import Equirect
from skybake.projection.frame import zenith_extent
from skybake.projection.quarters import quarters

_STEEPEST = 3.0
"""Largest change of direction with the place (u, v), in the middle of a side. [rad]"""

_PARTS_PER_RADIUS = 24


class OctahedralChart(Chart):
    """The square of an unfolded octahedron.

    Parameters
    ----------
    edge : int
        Width and height. [pixel]
    """

    def __init__(self, edge: int) -> None:
        self.width = self.height = edge

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the pixels in rows first..last."""
        return zenith_azimuth(_points(*self._plane(first, last)))

    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Rows and columns, in pixels from the upper left corner, at which directions are shown.

        Parameters
        ----------
        vectors : ndarray of float64, shape (..., 3)
            Directions of any length but 0.
        """
        x, y, z = np.moveaxis(vectors / np.abs(vectors).sum(axis=-1, keepdims=True), -1, 0)
        u = np.where(y < 0.0, np.copysign(1.0 - np.abs(z), x), x)
        v = np.where(y < 0.0, np.copysign(1.0 - np.abs(x), z), z)
        return 0.5 * (v + 1.0) * self.height, 0.5 * (u + 1.0) * self.width

    def footprints(self, first: int, last: int) -> Array:
        """Extents of pixels in zenith angle."""
        u, v = self._plane(first, last)
        points = _points(u, v)
        distance = np.linalg.norm(points, axis=-1)[..., None]
        right, down = np.copysign(1.0, u), np.copysign(1.0, v)
        upper = np.abs(u) + np.abs(v) <= 1.0
        zero, one, both = np.zeros_like(u), np.ones_like(u), -right * down
        across = np.stack([np.where(upper, one, zero), -right, np.where(upper, zero, both)], -1)
        along = np.stack([np.where(upper, zero, both), -down, np.where(upper, one, zero)], -1)
        step = 2.0 / self.width / distance
        return zenith_extent(points / distance, step * across, step * along)

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angles of pixels, shape (row, column). [sr]"""
        return self._sizes(*self._plane(first, last))

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the one pixel that it is in."""
        edge = self.width
        centre = direction_from_angles(bearing, math.pi / 2.0 - zenith)
        column, row, side = quarters(
            edge,
            self._directions,
            centre,
            radius,
            steepest=2.0 / edge * _STEEPEST,
            finest=radius / _PARTS_PER_RADIUS,
        )
        size = (2.0 * side / edge) ** 2 * _density(*self._places(column, row))
        texel_column, texel_row = column.astype(np.int64), row.astype(np.int64)
        texel_size = self._sizes(*self._places(texel_column + 0.5, texel_row + 0.5))
        texel = texel_row * edge + texel_column
        vectors = self._directions(column, row)
        return cells_of_one_texel(vectors, centre, radius, size, texel, texel_size)

    def _places(self, column: npt.NDArray[Any], row: npt.NDArray[Any]) -> tuple[Array, Array]:
        """Places (u, v) in the square that are nearest to some around it, given in pixels."""
        u, v = (np.minimum(2.0 * place / self.width - 1.0, 1.0) for place in (column, row))
        return u, v

    def _directions(self, column: Array, row: Array) -> Array:
        points = _points(*self._places(column, row))
        unit: Array = points / np.linalg.norm(points, axis=-1, keepdims=True)
        return unit

    def _plane(self, first: int, last: int) -> tuple[Array, Array]:
        """Places (u, v) of the pixels in rows first..last."""
        column, row = np.arange(self.width) + 0.5, np.arange(first, last)[:, None] + 0.5
        u, v = np.broadcast_arrays(*self._places(column, row))
        return u, v

    def _sizes(self, u: Array, v: Array) -> Array:
        """Solid angles of pixels around places, by quadrature. [sr]"""
        node, weight = np.polynomial.legendre.leggauss(3)
        size = np.zeros(u.shape)
        for across, share in zip(node, weight, strict=True):
            for along, part in zip(node, weight, strict=True):
                around = u + across / self.width, v + along / self.width
                size += share * part / self.width**2 * _density(*around)
        return size


def _points(u: Array, v: Array) -> Array:
    """Points of the octahedron at places of the square, shape (..., 3)."""
    height = 1.0 - np.abs(u) - np.abs(v)
    below = height < 0.0
    x = np.where(below, np.copysign(1.0 - np.abs(v), u), u)
    z = np.where(below, np.copysign(1.0 - np.abs(u), v), v)
    return np.stack([x, height, z], axis=-1)


def _density(u: Array, v: Array) -> Array:
    """Solid angle to an area of the square. [sr]"""
    density: Array = np.linalg.norm(_points(u, v), axis=-1) ** -3
    return density


@dataclass(frozen=True)
class Octahedral(Projection):
    """The whole sphere in a square without corners left black.

    Attributes
    ----------
    edge : int
        Width and height. [pixel]
    """

    name: ClassVar[str] = "octahedral"
    edge: int = 1024

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        check_edge(self.edge, smallest=2)

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of an edge."""
        if size is None:
            return cls(**options)
        if len(set(size)) != 1:
            raise InputError(f"size: an octahedral map is square, got {size_text(size)}")
        return cls(edge=size[0], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return the one picture."""
        return (whole(OctahedralChart(self.edge)),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        return self.name

    def recipe(self) -> dict[str, Any]:
        """Name and edge."""
        return {"projection": self.name, "width": self.edge}

    def smaller(self, width: int) -> Projection:
        """Return the same map, at most of this width."""
        return Octahedral(min(self.edge, width))

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)
