"""Equidistant fisheye pictures, as of domes and all-sky cameras.

Straight up, the picture has south at its bottom, north at its top and east at its left, as one
sees the sky when lying on the back with the head to the north.
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
from skybake.projection.cells import (
    CELLS_PER_RADIUS,
    Array,
    Cells,
    cells_of_one_texel,
    subdivide,
)
from skybake.projection.chart import Canvas, Chart, Projection, check_edge, size_text, whole
from skybake.projection.frame import (
    PictureAxes,
    check_look,
    look_frame,
    look_label,
    zenith_extent,
)
from skybake.units import degrees

WIDEST = math.radians(270.0)

_SMALLEST = 1e-300


class FisheyeChart(Chart):
    """A square whose inscribed circle is the picture; its corners stay black.

    Parameters
    ----------
    frame : PictureAxes
        Where the picture's right, its top and its middle look.
    fov : float
        Angle that the circle's diameter covers. [rad]
    edge : int
        Width and height. [pixel]
    """

    def __init__(self, frame: PictureAxes, fov: float, edge: int) -> None:
        self.width = self.height = edge
        self.frame, self.fov = frame, fov
        self._step = fov / edge

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the pixels in rows first..last."""
        return zenith_azimuth(self._vectors(*self._plane(first, last)))

    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Where the circle shows directions."""
        frame, half = self.frame, 0.5 * self.fov
        x, y = vectors @ frame.right, -(vectors @ frame.up)
        aside = np.hypot(x, y)
        off_axis = np.arctan2(aside, vectors @ frame.forward)
        stretch = off_axis / np.maximum(aside, _SMALLEST)
        shown = off_axis <= half
        row, column = (y * stretch + half) / self._step, (x * stretch + half) / self._step
        return np.where(shown, row, np.nan), np.where(shown, column, np.nan)

    def footprints(self, first: int, last: int) -> Array:
        """Extents of pixels in zenith angle."""
        x, y = self._plane(first, last)
        off_axis = np.hypot(x, y)
        vectors = self._vectors(x, y)
        outward, around = self._steps(x, y, off_axis)
        squeezed = self._step * np.sinc(off_axis / math.pi)
        return zenith_extent(vectors, self._step * outward, squeezed[..., None] * around)

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angles of pixels, 0 outside the circle, shape (row, column). [sr]"""
        off_axis = np.hypot(*self._plane(first, last))
        return np.where(off_axis > 0.5 * self.fov, 0.0, self._size(off_axis))

    def looks_nowhere(self, first: int, last: int) -> npt.NDArray[np.bool_]:
        """Pixels outside the circle."""
        outside: npt.NDArray[np.bool_] = np.hypot(*self._plane(first, last)) > 0.5 * self.fov
        return outside

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the one pixel that it is in."""
        centre, edge, step = (
            direction_from_angles(bearing, math.pi / 2.0 - zenith),
            self.width,
            self._step,
        )
        frame, half = self.frame, 0.5 * self.fov
        off_axis = math.acos(min(max(float(frame.forward @ centre), -1.0), 1.0))
        turn = math.atan2(-float(frame.up @ centre), float(frame.right @ centre))
        x, y = off_axis * math.cos(turn), off_axis * math.sin(turn)
        # Cells that the edge cuts may have their centres outside it; circles are stretched
        # around the middle.
        reach = radius * (1.0 + 2.0 / CELLS_PER_RADIUS)
        reach /= max(np.sinc(min(off_axis + reach, WIDEST / 2.0) / math.pi), 0.1)
        (columns, width), (rows, height) = (
            subdivide(place - reach + half, place + reach + half, step, radius, (0, edge))
            for place in (x, y)
        )
        column, row = (grid.ravel() for grid in np.meshgrid(columns, rows))
        x_cell, y_cell = column * step - half, row * step - half
        vectors = self._vectors(x_cell, y_cell)
        size = width * height * np.maximum(np.sinc(np.hypot(x_cell, y_cell) / math.pi), 0.0)
        texel_row, texel_column = row.astype(np.int64), column.astype(np.int64)
        off_axis = np.hypot((texel_column + 0.5) * step - half, (texel_row + 0.5) * step - half)
        texel_size = np.where(off_axis <= half, self._size(off_axis), 0.0)
        texel = texel_row * edge + texel_column
        return cells_of_one_texel(vectors, centre, radius, size, texel, texel_size)

    def _plane(self, first: int, last: int) -> tuple[Array, Array]:
        """Angles from the middle, to the right and down, of the pixels in rows first..last."""
        half = 0.5 * self.fov
        column, row = np.arange(self.width) + 0.5, np.arange(first, last)[:, None] + 0.5
        x, y = np.broadcast_arrays(column * self._step - half, row * self._step - half)
        return x, y

    def _vectors(self, x: Array, y: Array) -> Array:
        off_axis = np.hypot(x, y)
        aside = np.sinc(off_axis / math.pi)[..., None] * self._aside(x, y)
        vectors: Array = np.cos(off_axis)[..., None] * self.frame.forward + aside
        return vectors

    def _aside(self, x: Array, y: Array) -> Array:
        aside: Array = x[..., None] * self.frame.right - y[..., None] * self.frame.up
        return aside

    def _steps(self, x: Array, y: Array, off_axis: Array) -> tuple[Array, Array]:
        """Return unit vectors across the line of sight, away from the middle and around it."""
        at_middle = off_axis == 0.0
        divisor = np.where(at_middle, 1.0, off_axis)
        cosine, sine = np.where(at_middle, 1.0, x / divisor), y / divisor
        radial = self._aside(cosine, sine)
        along_axis = np.sin(off_axis)[..., None] * self.frame.forward
        return np.cos(off_axis)[..., None] * radial - along_axis, self._aside(-sine, cosine)

    def _size(self, off_axis: Array) -> Array:
        size: Array = self._step**2 * np.sinc(off_axis / math.pi)
        return size


@dataclass(frozen=True)
class Fisheye(Projection):
    """A round picture in which the distance from the middle is the angle from it.

    Attributes
    ----------
    edge : int
        Width and height of the square around it. [pixel]
    fov : float
        Angle that its diameter covers, greater than 0 and at most `WIDEST`. [rad]
    azimuth, elevation : float
        Compass bearing and height of its middle. [rad] Straight up, the bearing is that of
        the picture's bottom.
    """

    name: ClassVar[str] = "fisheye"
    edge: int = 1024
    fov: float = math.pi
    azimuth: float = math.pi
    elevation: float = math.pi / 2.0

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        check_edge(self.edge, smallest=2)
        if not 0.0 < self.fov <= WIDEST + 1e-9:
            raise InputError(
                f"fov: must be greater than 0deg and at most {math.degrees(WIDEST):g}deg for a "
                f"fisheye picture, got {math.degrees(self.fov):g}deg"
            )
        check_look(self.azimuth, self.elevation)

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of an edge."""
        if size is None:
            return cls(**options)
        if len(set(size)) != 1:
            raise InputError(f"size: a fisheye picture is square, got {size_text(size)}")
        return cls(edge=size[0], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return the one picture."""
        frame = look_frame(self.azimuth, self.elevation)
        return (whole(FisheyeChart(frame, self.fov, self.edge)),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        label = f"{self.name}_fov{math.degrees(self.fov):g}deg"
        if (self.azimuth, self.elevation) == (math.pi, math.pi / 2.0):
            return label
        return f"{label}_{look_label(self.azimuth, self.elevation)}"

    def recipe(self) -> dict[str, Any]:
        """Size, angle of view and direction."""
        return {
            "projection": self.name,
            "width": self.edge,
            "fov_deg": degrees(self.fov),
            "look_azimuth_deg": degrees(self.azimuth),
            "look_elevation_deg": degrees(self.elevation),
        }

    def smaller(self, width: int) -> Projection:
        """Return the same picture, at most of this width."""
        return self.glance(min(self.edge, width))

    def glance(self, width: int) -> Projection:
        """Return the same picture of another width."""
        return Fisheye(width, self.fov, self.azimuth, self.elevation)
