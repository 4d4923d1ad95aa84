"""Depths of other programs: which are distances, and which mean that nothing is there."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.errors import InputError

Floats = npt.NDArray[np.float32]

FARTHEST = 1e6
"""Distance from which on nothing is there: some programs write 10^10 for that. [km]"""

BACKGROUNDS = {"inf": np.inf, "0": 0.0}


class Depths(NamedTuple):
    """How far what pixels show is.

    Attributes
    ----------
    values : ndarray of float32, shape (row, column)
        At least 0; infinite where nothing is.
    unit : float
        Length of 1. [km]
    is_planar : bool
        Whether they are along the camera's axis rather than along rays.
    """

    values: Floats
    unit: float
    is_planar: bool


def checked_depths(
    path: Path, channel: str, values: Floats, unit: float, background: str | None
) -> Floats:
    """Return depths that are distances from 0 to infinity.

    Parameters
    ----------
    path, channel : Path, str
        For messages.
    values : ndarray of float32, shape (row, column)
        As stored.
    unit : float
        Length of 1. [km]
    background : {"inf", "0"} or None
        What NaN and negative values become; by default they are refused.

    Raises
    ------
    InputError
        That says in which pixel a value is no distance.
    """
    is_wrong = ~(values >= 0.0)
    if is_wrong.any():
        if background is None:
            row, column = np.argwhere(is_wrong)[0].tolist()
            raise InputError(
                f"{path}: {channel}: must be at least 0, got {values[row, column]:g} at column "
                f"{column}, row {row}; --depth-background says what that is"
            )
        values = np.where(is_wrong, np.float32(BACKGROUNDS[background]), values)
    return np.where(values * unit >= FARTHEST, np.float32(np.inf), values)
