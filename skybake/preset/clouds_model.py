"""Layers of clouds, as a preset describes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from skybake.preset.optics_model import Phase

TILE = "tile"
KINDS = ("stratus", "stratocumulus", "cumulus", "altocumulus", "cirrus", TILE)


@dataclass(frozen=True, slots=True)
class Tile:
    """Voxels of extinction in a file.

    Attributes
    ----------
    path : str
        Of the ``.npz``.
    digest : str
        SHA-256 of its content.
    interpolation : {"constant", "linear"}
        Within a voxel.
    origin : tuple of float
        The tile's coordinates x (east) and y (north) under the observer. [km]
    """

    path: str
    digest: str
    interpolation: Literal["constant", "linear"]
    origin: tuple[float, float]


@dataclass(frozen=True, slots=True)
class CloudLayer:
    """A layer of clouds.

    Attributes
    ----------
    name : str
        Its table's name in the preset.
    kind : str
        One of `KINDS`.
    base, depth : float
        Altitude of the clouds' base; height of a cloud of this size. [km]
    size : float
        Diameter of large clouds, or of the cells of a deck. [km]
    cover : float
        Share of the sky that clouds cover, seen from below, in [0, 1].
    optical_depth : float
        Vertical, at 550 nm, mean where there is cloud; 0 for a tile, which has its own.
    phase : Phase
        Of the particles, which do not absorb.
    seed : int
        Another one, another sky.
    wind_speed, wind_from : float
        At which clouds drift [km s⁻¹], and the bearing from which it blows [rad].
    tile : Tile or None
        What a layer of the kind ``"tile"`` consists of.
    """

    name: str
    kind: str
    base: float
    depth: float
    size: float
    cover: float
    optical_depth: float
    phase: Phase
    seed: int
    wind_speed: float
    wind_from: float
    tile: Tile | None = None

    @property
    def is_empty(self) -> bool:
        """Whether the layer has no clouds by what the preset says of it."""
        return self.tile is None and (self.cover <= 0.0 or self.optical_depth <= 0.0)
