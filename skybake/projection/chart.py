"""What every projection offers: pixels that look in directions, and how discs fall on them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal, Self

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError
from skybake.projection.cells import Array, Cells

LARGEST = 65536
"""Width and height of the largest image. [pixel]"""


class Chart(ABC):
    """A rectangle of pixels whose directions vary smoothly from one to the next.

    Attributes
    ----------
    width, height : int
        [pixel]
    wraps : bool
        Whether the last column is the neighbour of the first.
    is_separable : bool
        Whether rows share their zenith angles, and columns their bearings.
    """

    width: int
    height: int
    wraps: ClassVar[bool] = False
    is_separable: ClassVar[bool] = False

    @abstractmethod
    def angles(self, first: int, last: int) -> tuple[Array, Array]:
        """Directions of the centres of the pixels in rows first..last.

        Returns
        -------
        zenith : ndarray of float64, shape (row, 1) or (row, column)
            Zenith angles; one column if a row shares its. [rad]
        bearing : ndarray of float64, shape (1, column) or (row, column)
            Compass bearings; one row if all rows share it. [rad]
        """

    @abstractmethod
    def footprints(self, first: int, last: int) -> Array:
        """Extents of pixels in zenith angle, over which the planet's edges are smoothed.

        Returns
        -------
        ndarray of float64, shape (1, 1), (row, 1) or (row, column)
            [rad]
        """

    def looks(self, first: int, last: int) -> tuple[Array, Array, Array]:
        """Return `angles` and `footprints`."""
        return (*self.angles(first, last), self.footprints(first, last))

    @abstractmethod
    def solid_angles(self, first: int, last: int) -> Array:
        """Solid angles of pixels, shape (row, 1) or (row, column). [sr]"""

    @abstractmethod
    def disc_cells(self, zenith: float, bearing: float, radius: float) -> Cells:
        """Cut the part of a disc that falls on the pixels into cells that keep its flux.

        Parameters
        ----------
        zenith, bearing, radius : float
            Centre of the disc and its angular radius. [rad]
        """

    @abstractmethod
    def places(self, vectors: Array) -> tuple[Array, Array]:
        """Where the chart shows directions, the inverse of `angles`.

        Parameters
        ----------
        vectors : ndarray of float64, shape (..., 3)
            Unit vectors.

        Returns
        -------
        row, column : ndarray of float64, shape (...)
            In pixels from the upper left corner, so that centres are at a half; NaN for
            directions that it does not show.
        """

    def stretch(self, row: Array) -> Array:
        """How many times as narrow as high pixels are, at rows as of `places`, at least 1."""
        return np.ones_like(row)

    def looks_nowhere(self, _first: int, _last: int) -> npt.NDArray[np.bool_] | None:
        """Pixels in rows first..last that stay black; None if there are none."""
        return None


@dataclass(frozen=True)
class Part:
    """Place of a chart in a picture.

    Attributes
    ----------
    chart : Chart
        The pixels.
    row, column : int
        Of its first pixel in the picture.
    flip : {None, "rows", "columns", "both"}
        Whether it is upside down, or mirrored left to right.
    """

    chart: Chart
    row: int = 0
    column: int = 0
    flip: Literal["rows", "columns", "both"] | None = None


@dataclass(frozen=True)
class Canvas:
    """The picture that one file holds: charts side by side, black between them.

    Attributes
    ----------
    width, height : int
        [pixel]
    parts : tuple of Part
        Which do not overlap.
    face : str or None
        Which of several files of one map it is.
    envmap : {"latlong", "cube", None}
        What OpenEXR calls the mapping.
    """

    width: int
    height: int
    parts: tuple[Part, ...]
    face: str | None = None
    envmap: Literal["latlong", "cube"] | None = None


def whole(
    chart: Chart, face: str | None = None, envmap: Literal["latlong", "cube"] | None = None
) -> Canvas:
    """Canvas that a single chart fills."""
    return Canvas(chart.width, chart.height, (Part(chart),), face, envmap)


class Projection(ABC):
    """How the sphere of directions is laid out in the pictures of one map.

    Attributes
    ----------
    name : str
        By which users select it.
    """

    name: ClassVar[str]

    @classmethod
    @abstractmethod
    def of_size(cls, size: tuple[int, ...] | None, options: Mapping[str, Any]) -> Self:
        """Make one of a size in pixels.

        Parameters
        ----------
        size : tuple of int, or None
            Width and height, or a single number, as a user gives it; None for the usual size.
        options : mapping
            What else the class takes, by the names of its attributes.

        Raises
        ------
        InputError
            If the projection has no such shape.
        """

    @abstractmethod
    def canvases(self) -> tuple[Canvas, ...]:
        """Return the pictures of a map, one for each file."""

    @property
    @abstractmethod
    def label(self) -> str:
        """How file names denote it."""

    @abstractmethod
    def recipe(self) -> dict[str, Any]:
        """All that decides where pixels look, in human-readable units, fit for JSON."""

    @abstractmethod
    def smaller(self, width: int) -> Projection:
        """Return the same view in a single picture of at most this width, or one that suits it."""

    @abstractmethod
    def glance(self, width: int) -> Projection:
        """Return a single picture of this width, for thumbnails and automatic exposure.

        It is an equirect map of the whole sphere if the map covers it, else the same view.
        """

    def check_file(self, path: Path) -> None:
        """Raise an `InputError` if the format of a file cannot hold the layout."""
        for canvas in self.canvases():
            if canvas.envmap == "cube" and path.suffix.lower() != ".exr":
                raise InputError(f"{path}: suffix must be .exr for the cube layout exr")


def check_edge(edge: int, smallest: int = 1) -> None:
    """Refuse a width or height that no picture has."""
    if not smallest <= edge <= LARGEST:
        raise InputError(f"size: must be from {smallest} to {LARGEST}, got {edge}")


def size_text(size: tuple[int, ...]) -> str:
    """Write a size as users do."""
    return "x".join(map(str, size))
