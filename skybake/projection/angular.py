"""Angular maps: the whole sphere in a circle, as Debevec's light probes.

With u to the right and v upward, both in [-1, 1], a pixel looks at the angle pi * hypot(u, v) from
-Z, in the direction of (u, v) from there::

    (sin(a) cos(t), sin(a) sin(t), -cos(a))   with a = pi * hypot(u, v), t = atan2(v, u)

North is in the middle, east to the right, up at the top, and all of the rim looks south. Texel
centres are at (i + 1/2) / edge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Self

import numpy as np

from skybake.angles import direction_from_angles
from skybake.errors import InputError
from skybake.projection.cells import Array, Cells, cells_of_one_texel
from skybake.projection.chart import Canvas, Projection, check_edge, size_text, whole
from skybake.projection.equirect import Equirect
from skybake.projection.fisheye import FisheyeChart
from skybake.projection.frame import look_frame
from skybake.projection.quarters import quarters

_PARTS_PER_RADIUS = 24
_PARTS_AT_RIM = 8
_SAMPLES = 8
# A point this much nearer to the middle than the rim lies in a pixel whose centre is within it.
_WITHIN = math.sqrt(0.5) + 1e-6


class AngularChart(FisheyeChart):
    """A square whose inscribed circle is the whole sphere; its corners stay black.

    Parameters
    ----------
    edge : int
        Width and height. [pixel]
    """

    def __init__(self, edge: int) -> None:
        super().__init__(look_frame(0.0, 0.0), 2.0 * math.pi, edge)

    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angles of pixels, 0 outside the circle, shape (row, column). [sr]"""
        return self._sizes(*self._plane(first, last))

    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut a disc into cells, each of which adds to the one pixel that it is in.

        Notes
        -----
        Opposite the middle a disc is all along the rim, where a few cells across it are
        many around.
        """
        step, edge = self._step, self.width
        centre = direction_from_angles(bearing, math.pi / 2.0 - zenith)
        from_rim = math.acos(min(max(-float(self.frame.forward @ centre), -1.0), 1.0))
        parts = _PARTS_PER_RADIUS if from_rim > 4.0 * radius else _PARTS_AT_RIM
        column, row, side = quarters(
            edge, self._directions, centre, radius, steepest=step, finest=radius / parts
        )
        x, y = column * step - math.pi, row * step - math.pi
        inside = np.hypot(x, y) < math.pi
        column, row, x, y = column[inside], row[inside], x[inside], y[inside]
        off_axis = np.hypot(x, y)
        size = (side * step) ** 2 * np.sinc(off_axis / math.pi)
        within = np.minimum(1.0, (math.pi - _WITHIN * step) / np.maximum(off_axis, step))
        texel_column, texel_row = (
            np.floor((part * within + math.pi) / step).astype(np.int64) for part in (x, y)
        )
        texel = texel_row * edge + texel_column
        used, which = np.unique(texel, return_inverse=True)
        texel_size = self._sizes(
            *((part + 0.5) * step - math.pi for part in (used % edge, used // edge))
        )
        vectors = self._directions(column, row)
        return cells_of_one_texel(vectors, centre, radius, size, texel, texel_size[which])

    def _directions(self, column: Array, row: Array) -> Array:
        """Return unit vectors of places, given in pixels; outside the circle the sphere goes on."""
        return self._vectors(column * self._step - math.pi, row * self._step - math.pi)

    def _sizes(self, x: Array, y: Array) -> Array:
        """Solid angles of pixels whose centres are at angles to the right and down. [sr]

        At the rim, where pixels stand for ever less, it is the mean over their part inside.
        """
        off_axis = np.hypot(x, y)
        size = np.where(off_axis > math.pi, 0.0, self._size(off_axis))
        rim = (off_axis > math.pi - self._step) & (off_axis <= math.pi)
        shift = self._step * ((np.arange(_SAMPLES) + 0.5) / _SAMPLES - 0.5)
        samples = np.hypot(x[rim][:, None, None] + shift[:, None], y[rim][:, None, None] + shift)
        size[rim] = np.maximum(self._size(samples), 0.0).mean(axis=(1, 2))
        return size


@dataclass(frozen=True)
class Angular(Projection):
    """An angular map of the whole sphere, also known as a light probe.

    Attributes
    ----------
    edge : int
        Width and height of the square around it. [pixel]
    """

    name: ClassVar[str] = "angular"
    edge: int = 1024

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        check_edge(self.edge, smallest=4)

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of an edge."""
        if size is None:
            return cls(**options)
        if len(set(size)) != 1:
            raise InputError(f"size: an angular map is square, got {size_text(size)}")
        return cls(edge=size[0], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return the one picture."""
        return (whole(AngularChart(self.edge)),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        return self.name

    def recipe(self) -> dict[str, Any]:
        """Name and edge."""
        return {"projection": self.name, "width": self.edge}

    def smaller(self, width: int) -> Projection:
        """Return the same map, at most of this width."""
        return Angular(min(self.edge, width))

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)
