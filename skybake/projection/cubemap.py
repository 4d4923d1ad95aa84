"""Cubemaps in the axes of the world, or mirrored for programs that negate one of them.

Faces come in the order +X -X +Y -Y +Z -Z with row 0 at v = -1::

    px (1,-v,-u)  nx (-1,-v,u)  py (u,1,v)  ny (u,-1,-v)  pz (u,-v,1)  nz (-u,-v,-1)

OpenGL, Vulkan and D3D sample them so with a direction c of the cube, and cmgen writes them so.
In the space ``world`` they are east, west, up, down, south, north, and a texel holds the light
from c itself; in ``flip-x`` that from (-x, y, z), for programs that negate x before they sample a
cube, as three.js; in ``flip-z`` that from (x, y, -z), for those that negate z, as Bevy, and for
left-handed worlds whose +Z is north, as Unity's. Texel centres are at (i + 1/2) / edge.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.projection.cells import Array
from skybake.projection.chart import Canvas, Part, Projection, check_edge, size_text, whole
from skybake.projection.equirect import Equirect
from skybake.projection.frame import PictureAxes
from skybake.projection.gnomonic import GnomonicChart

FACES = ("px", "nx", "py", "ny", "pz", "nz")
LAYOUTS = ("faces", "cross", "vertical-cross", "row", "column", "exr")

SPACES = {"world": (1, 1, 1), "flip-x": (-1, 1, 1), "flip-z": (1, 1, -1)}
"""Factors from a direction of the cube to that in the world which its texel shows."""

FACE_NAMES = {
    "px": FACES,
    "posx": ("posx", "negx", "posy", "negy", "posz", "negz"),
    "+X": ("+X", "-X", "+Y", "-Y", "+Z", "-Z"),
    "right": ("right", "left", "top", "bottom", "front", "back"),
}
"""Names of the faces in the order of `FACES`, by the first of them."""

_FACE_NAME = re.compile(r"[A-Za-z0-9+-]{1,32}")

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
    space : {"world", "flip-x", "flip-z"}, optional
        A key of `SPACES`.
    """

    def __init__(self, face: str, edge: int, space: str = "world") -> None:
        signs = SPACES[space]
        self._axes = tuple(
            tuple(sign * each for sign, each in zip(signs, axis, strict=True))
            for axis in _FRAMES[face]
        )
        frame = PictureAxes(*(np.array(axis, dtype=float) for axis in self._axes))
        super().__init__(frame, 1.0, 1.0, edge, edge)

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

    def looks(self, first: int, last: int) -> tuple[Array, Array, Array]:
        """Return `angles` and `footprints`."""
        return (*self.angles(first, last), self.footprints(first, last))


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
    space : {"world", "flip-x", "flip-z"}
        A key of `SPACES`. OpenEXR's cube environment is always in that of the world.
    face_names : str
        How files name six faces: a key of `FACE_NAMES`, or six names of one's own with commas
        between, in the order of `FACES`.
    """

    name: ClassVar[str] = "cubemap"
    edge: int = 1024
    layout: str = "faces"
    space: str = "world"
    face_names: str = "px"

    def __post_init__(self) -> None:
        """Refuse what cannot be baked."""
        if self.layout not in LAYOUTS:
            raise InputError(
                f"cube layout: must be one of {', '.join(LAYOUTS)}, got {self.layout!r}"
            )
        if self.space not in SPACES:
            raise InputError(f"cube-space: must be one of {', '.join(SPACES)}, got {self.space!r}")
        if self.layout == "exr" and self.space != "world":
            raise InputError(
                f"cube-space: must be world for the cube layout exr, got {self.space!r}"
            )
        names = parse_face_names(self.face_names)
        if self.layout != "faces" and names != FACES:
            raise InputError(
                f"face-names: must belong to the cube layout faces, got {self.layout!r}"
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
        charts = {face: FaceChart(face, edge, self.space) for face in FACES}
        if self.layout == "faces":
            names = parse_face_names(self.face_names)
            return tuple(
                whole(chart, name) for name, chart in zip(names, charts.values(), strict=True)
            )
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
        layout = "" if self.layout == LAYOUTS[0] else self.layout
        space = "" if self.space == "world" else self.space
        return "_".join(filter(None, (self.name, layout, space)))

    def recipe(self) -> dict[str, Any]:
        """Name, edge and layout, and the space and the faces' names if they are not the usual."""
        return {
            "projection": self.name,
            "width": self.edge,
            "cube_layout": self.layout,
            **({} if self.space == "world" else {"cube_space": self.space}),
            **({} if self.face_names == FACES[0] else {"face_names": self.face_names}),
        }

    def smaller(self, width: int) -> Projection:
        """Return a cross, upright if this is one."""
        if self.layout == "vertical-cross":
            return Cubemap(min(self.edge, width // 3), self.layout, self.space)
        return Cubemap(min(self.edge, width // 4), "cross", self.space)

    def glance(self, width: int) -> Projection:
        """Return the whole sphere."""
        return Equirect(width)


def parse_face_names(text: str) -> tuple[str, ...]:
    """Read how six faces are named.

    Parameters
    ----------
    text : str
        A key of `FACE_NAMES`, or six different names with commas between, of letters, digits,
        plus and minus.

    Returns
    -------
    tuple of 6 str
        In the order of `FACES`.

    Raises
    ------
    InputError
        If it is neither.
    """
    names = FACE_NAMES.get(text) or tuple(text.split(","))
    # On some file systems names that differ only in their case are one.
    is_fine = len({name.casefold() for name in names}) == len(names) == len(FACES)
    if not is_fine or not all(map(_FACE_NAME.fullmatch, names)):
        raise InputError(
            f"face-names: must be {', '.join(FACE_NAMES)} or six different names with commas "
            f"between, got {text!r}"
        )
    return names


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
