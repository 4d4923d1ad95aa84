"""Scenes that every program builds, and what they must look like by quadrature of the map.

All are in the axes of the maps: right-handed, +Y up, -Z north. Cameras look either straight down
with north at the top, or level to the north.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from skybake.projection import equirect

ALBEDO = 0.5
POLE_HEIGHT, POLE_RADIUS = 1.0, 0.02

# Of the views that are measured: half their width, and their edge in pixels.
PLANE = (1.0, 32)
BALL = (1.05, 96)
POLE = (3.0, 384)

SQUARE_VIEWS = {"plane": PLANE, "ball": BALL, "pole": POLE}

NORMALS_AT_ONCE = 64

FOLDER = Path(__file__).parent

PICTURE = (400, 225)
"""Width and height of the picture for readers."""


class Views(NamedTuple):
    """What a program rendered, as linear pixels in the unit of the map.

    Attributes
    ----------
    plane : ndarray, shape (row, column, 3)
        A level plane of `ALBEDO` from above.
    sphere, mirror : ndarray, shape (row, column, 3)
        A diffuse and a perfectly reflecting unit sphere, alone under the sky, from the south.
    pole : ndarray, shape (row, column, 3)
        An upright pole at the origin of the plane from above.
    picture : ndarray, shape (row, column, 3)
        All of them together.
    """

    plane: np.ndarray
    sphere: np.ndarray
    mirror: np.ndarray
    pole: np.ndarray
    picture: np.ndarray


@dataclass(frozen=True)
class Sky:
    """A map with the sun's disc in it, by which files without it are judged.

    Attributes
    ----------
    pixels : ndarray, shape (row, column, 3)
        Equirect, +Z in the middle.
    sun : ndarray, shape (3,)
        Direction toward the sun.
    """

    pixels: np.ndarray
    sun: np.ndarray

    def irradiance(self, normals, *, above_plane=False):
        """Irradiance of planes by all texels, or by those above the horizontal; (normal, 3)."""
        height, width, _ = self.pixels.shape
        vectors = equirect.directions(width, height).reshape(-1, 3)
        size = np.repeat(equirect.solid_angles(width, height), width)
        flux = self.pixels.reshape(-1, 3).astype(float) * size[:, None]
        if above_plane:
            flux *= (vectors[:, 1] > 0.0)[:, None]
        parts = np.array_split(normals, -(-len(normals) // NORMALS_AT_ONCE))
        return np.concatenate([np.maximum(part @ vectors.T, 0.0) @ flux for part in parts])

    def seen(self, directions):
        """Pixel values in directions, interpolated, shape (..., 3)."""
        height, width, _ = self.pixels.shape
        x, y, z = np.moveaxis(directions, -1, 0)
        column = (np.pi - np.arctan2(x, z)) / (2.0 * np.pi) * width - 0.5
        row = np.clip(np.arccos(np.clip(y, -1.0, 1.0)) / np.pi * height - 0.5, 0, height - 1)
        left, top = np.floor(column).astype(int), np.minimum(row.astype(int), height - 2)
        across, down = (column - left)[..., None], (row - top)[..., None]
        corner = [
            [self.pixels[top + j, (left + i) % width].astype(float) for i in (0, 1)] for j in (0, 1)
        ]
        upper, lower = (one + across * (other - one) for one, other in corner)
        return upper + down * (lower - upper)


def grid(half_width, edge):
    """Coordinates to the right and upward of the pixels of a square view, (row, column)."""
    across = half_width * ((np.arange(edge) + 0.5) * 2.0 / edge - 1.0)
    return np.broadcast_arrays(across[None, :], -across[:, None])


def ball_normals():
    """Normals of the unit sphere at the pixels of its view; NaN beside it."""
    right, up = grid(*BALL)
    with np.errstate(invalid="ignore"):
        toward = np.sqrt(1.0 - right**2 - up**2)
    return np.stack([right, up, toward], axis=-1)
