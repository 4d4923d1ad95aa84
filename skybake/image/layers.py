"""Pixels in named planes that are kept apart until a file is written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from skybake.image.settings import MapSettings

Pixels = npt.NDArray[np.float32]

RGB = ("R", "G", "B")


@dataclass(frozen=True)
class Layer:
    """One plane of a band of rows.

    Attributes
    ----------
    name : str
        What it holds, as "sky" or "sun".
    channels : tuple of str
        Names of its channels.
    first_row : int
        Where in the band its pixels begin; it is 0 in the rows before and after them.
    pixels : ndarray of float32, shape (row, column, channel)
        Scene-linear.
    """

    name: str
    channels: tuple[str, ...]
    first_row: int
    pixels: Pixels


@dataclass(frozen=True)
class Layers:
    """All planes of a band of rows.

    Attributes
    ----------
    rows, columns : int
        Size of the band. [pixel]
    planes : tuple of Layer
        In the order in which light adds up.
    """

    rows: int
    columns: int
    planes: tuple[Layer, ...]

    def names(self) -> tuple[str, ...]:
        """Return the names of the planes that hold anything here."""
        return tuple(plane.name for plane in self.planes)

    def plane(self, name: str) -> Pixels | None:
        """Return a plane over the whole band, shape (rows, columns, channel); None without it."""
        for plane in self.planes:
            if plane.name == name:
                return self._whole(plane)
        return None

    def added(self) -> Pixels:
        """Return the light of all planes together, shape (rows, columns, 3).

        The planes may be overwritten: the result may be one of them.
        """
        if not self.planes:
            return np.zeros((self.rows, self.columns, len(RGB)), np.float32)
        first, *others = self.planes
        total = self._whole(first)
        for plane in others:
            total[plane.first_row : plane.first_row + len(plane.pixels)] += plane.pixels
        return total

    def _whole(self, plane: Layer) -> Pixels:
        if len(plane.pixels) == self.rows:
            return plane.pixels
        whole = np.zeros((self.rows, self.columns, plane.pixels.shape[2]), np.float32)
        whole[plane.first_row : plane.first_row + len(plane.pixels)] = plane.pixels
        return whole


def wanted_layers(settings: MapSettings) -> tuple[str, ...]:
    """Return the names of the layers that a map may hold, in the order in which they are added."""
    disc = settings.lighting.sun_disc
    if settings.night.stars == "only":
        return ("stars",)
    if disc == "only":
        return ("sun",)
    is_there = {
        "sky": True,
        "sun": disc != "exclude" and not settings.moonlight.is_alone,
        "moon": disc != "exclude",
        "stars": True,
    }
    return tuple(name for name, there in is_there.items() if there)
