"""Cubemaps whose texels look in the world's own directions.

Faces come in the order +X -X +Y -Y +Z -Z (east, west, up, down, south, north)
with row 0 at v = -1::

    px (1,-v,-u)  nx (-1,-v,u)  py (u,1,v)  ny (u,-1,-v)  pz (u,-v,1)  nz (-u,-v,-1)

That is what OpenGL, Vulkan and D3D sample with a world direction, and what
cmgen writes. Texel centres are at (i + 1/2) / edge.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.projection.cells import Array
from skybake.projection.chart import Canvas, Part, Projection, check_edge, size_text, whole
from skybake.projection.equirect import Equirect
from skybake.projection.frame import Frame
from skybake.projection.gnomonic import GnomonicChart

FACES = ("px", "nx", "py", "ny", "pz", "nz")
LAYOUTS = ("faces", "cross", "vertical-cross", "row", "column", "exr")

# Right, up and forward of each face: direction = forward + u * right - v * up.
_FRAMES = {
    "px": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "nx": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "py": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "ny": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "pz": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "nz": ((-1, 0, 0), (0, 1, 0), (0, 0, -1)),
}

CROSS_ORIGINS = {"py": (0, 1), "nx": (1, 0), "pz": (1, 1), "px": (1, 2), "nz": (1, 3), "ny": (2, 1)}
"""Row and column, in edges, of each face in a horizontal cross of 3 by 4."""

VERTICAL_ORIGINS = {**CROSS_ORIGINS, "nz": (3, 1)}
"""The same of a vertical cross of 4 by 3, in which the last face is turned by 180 degrees."""


class FaceChart(GnomonicChart):
    """One face of a cube.

    Parameters
    ----------
    face, edge : str, int
        One of `FACES`, and its width and height. [pixel]
    """

    def __init__(self, face: str, edge: int) -> None:
        frame = Frame(*(np.array(axis, dtype=float) for axis in _FRAMES[face]))
        super().__init__(frame, 1.0, 1.0, edge, edge)
        self._axes = _FRAMES[face]

    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the texels; bearings of one row where the face is upright."""
        u = ((2.0 * np.arange(self.width) + 1.0) / self.width - 1.0)[None]
        v = u[0, first:last, None]
        x, y, z = (
            forward + (right * u if right else 0.0) - (up * v if up else 0.0)
            for right, up, forward in zip(*self._axes, strict=True)
        )
        return np.arctan2(np.hypot(x, z), y), np.arctan2(x, -z)

    def footprints(self, _first: int, _last: int) -> Array:
        """Extent of a texel in zenith angle, the mean over a face."""
        return np.full((1, 1), math.pi / 2.0 / self.width)


@dataclass(frozen=True)
class Cubemap(Projection):
    """Six faces of a cube.

    Attributes
    ----------
    edge : int
        Width and height of a face. [pixel]
    layout : {"faces", "cross", "vertical-cross", "row", "column", "exr"}
        Six files, one horizontal or vertical cross, the faces side by side or one below the other,
        or one OpenEXR cube environment, which is a column of faces that are flipped.
    """

    name: ClassVar[str] = "cubemap"
    edge: int = 1024
    layout: str = "faces"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        if self.layout not in LAYOUTS:
            raise InputError(
                f"cube layout: must be one of {', '.join(LAYOUTS)}, got {self.layout!r}"
            )
        check_edge(self.edge)

    @classmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of an edge."""
        if size is None:
            return cls(**options)
        if len(size) != 1:
            raise InputError(f"size: a cubemap needs the edge of a face, got {size_text(size)}")
        return cls(edge=size[0], **options)

    def canvases(self) -> tuple[Canvas, ...]:
        """Return a picture of each face, or one of all."""
        edge = self.edge
        charts = {face: FaceChart(face, edge) for face in FACES}
        if self.layout == "faces":
            return tuple(whole(chart, face) for face, chart in charts.items())
        if self.layout == "cross":
            crossed = tuple(
                Part(charts[face], row * edge, column * edge)
                for face, (row, column) in CROSS_ORIGINS.items()
            )
            return (Canvas(4 * edge, 3 * edge, crossed),)
        if self.layout == "vertical-cross":
            upright = tuple(
                Part(charts[face], row * edge, column * edge, "both" if face == "nz" else None)
                for face, (row, column) in VERTICAL_ORIGINS.items()
            )
            return (Canvas(3 * edge, 4 * edge, upright),)
        if self.layout == "row":
            beside = tuple(Part(chart, 0, i * edge) for i, chart in enumerate(charts.values()))
            return (Canvas(6 * edge, edge, beside),)
        if self.layout == "column":
            below = tuple(Part(chart, i * edge) for i, chart in enumerate(charts.values()))
            return (Canvas(edge, 6 * edge, below),)
        stacked = tuple(
            Part(chart, i * edge, flip=openexr_flip(face))
            for i, (face, chart) in enumerate(charts.items())
        )
        return (Canvas(edge, 6 * edge, stacked, envmap="cube"),)

    @property
    def label(self) -> str:
        """How file names denote it."""
        return self.name if self.layout == LAYOUTS[0] else f"{self.name}_{self.layout}"

    def recipe(self) -> dict[str, Any]:
        """Name, edge and layout."""
        return {"projection": self.name, "width": self.edge, "cube_layout": self.layout}

    def smaller(self, width: int) -> Projection:
        """Return a cross, upright if this is one."""
        if self.layout == "vertical-cross":
            return Cubemap(min(self.edge, width // 3), self.layout)
        return Cubemap(min(self.edge, width // 4), "cross")

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)


def openexr_flip(face: str) -> Literal["rows", "columns"]:
    """How OpenEXR's cube environment flips a face of this module.

    ImfEnvmap.cpp, CubeMap: X and Z faces are mirrored left to right against the
    order of this module, Y faces top to bottom.
    """
    return "rows" if face in ("py", "ny") else "columns"


def openexr_face(face: str, rows: npt.NDArray[np.generic]) -> npt.NDArray[np.generic]:
    """Turn a face, shape (edge, edge, ...), as OpenEXR's cube environment has it, or back."""
    return rows[::-1] if openexr_flip(face) == "rows" else rows[:, ::-1]


def face_directions(face: str, edge: int) -> Array:
    """Return unit vectors of a face's texels, shape (edge, edge, 3)."""
    return FaceChart(face, edge).vectors(0, edge)


def solid_angles(edge: int) -> Array:
    """Solid angles of a face's texels, shape (edge, edge); six faces make 4 pi. [sr]"""
    return FaceChart("pz", edge).solid_angles(0, edge)
