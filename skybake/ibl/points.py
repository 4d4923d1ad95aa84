"""Light that comes from directions, not from texels: the sun's disc, and what is as small."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

RINGS = 8
SPOKES = 24


@dataclass(frozen=True, eq=False)
class Points:
    """Points of light.

    Attributes
    ----------
    directions : ndarray of float64, shape (point, 3)
        Unit vectors toward them.
    flux : ndarray of float64, shape (point, 3)
        RGB times solid angle of each: its irradiance on a plane that faces it. [sr]
    """

    directions: Array
    flux: Array

    def __len__(self) -> int:
        """How many there are."""
        return len(self.flux)

    def joined(self, others: Points) -> Points:
        """Return these and others."""
        return Points(
            np.concatenate([self.directions, others.directions]),
            np.concatenate([self.flux, others.flux]),
        )


def no_points() -> Points:
    """Return none."""
    return Points(np.zeros((0, 3)), np.zeros((0, 3)))


def disc(direction: Array, angular_radius: float) -> tuple[Array, Array, Array]:
    """Divide a disc into parts of nearly the same size.

    Parameters
    ----------
    direction : ndarray of float64, shape (3,)
        Unit vector toward its centre.
    angular_radius : float
        [rad]

    Returns
    -------
    directions : ndarray of float64, shape (part, 3)
        Unit vectors toward the middle of each part.
    distances, sizes : ndarray of float64, shape (part,)
        Angles from the centre [rad], and solid angles [sr].
    """
    # Rings of the same solid angle, which is 4 pi sin²(t / 2) within an angle t.
    share = (np.arange(RINGS) + 0.5) / RINGS
    ring = 2.0 * np.arcsin(np.sqrt(share) * math.sin(0.5 * angular_radius))
    turn = 2.0 * math.pi * (np.arange(SPOKES) + 0.5) / SPOKES
    distances, turns = (grid.ravel() for grid in np.meshgrid(ring, turn, indexing="ij"))
    beside = np.eye(3)[np.argmin(np.abs(direction))]
    right = np.cross(direction, beside)
    right /= np.linalg.norm(right)
    up = np.cross(right, direction)
    outward = np.cos(turns)[:, None] * right + np.sin(turns)[:, None] * up
    directions = np.cos(distances)[:, None] * direction + np.sin(distances)[:, None] * outward
    size = 4.0 * math.pi * math.sin(0.5 * angular_radius) ** 2 / distances.size
    return directions, distances, np.full(distances.size, size)


def uniform_disc(direction: Array, irradiance: Array, angular_radius: float) -> Points:
    """Return the points of a disc that is equally bright all over.

    Parameters
    ----------
    direction, angular_radius
        As of `disc`.
    irradiance : ndarray of float64, shape (3,)
        RGB on a plane that faces it.
    """
    directions, _, sizes = disc(direction, angular_radius)
    return Points(directions, sizes[:, None] / sizes.sum() * irradiance)
