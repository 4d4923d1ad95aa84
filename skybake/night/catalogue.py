"""The stars that the eye can see: places, motions, magnitudes and colours."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from skybake.optics.medium import Array

FAINTEST = 6.5
"""Of the catalogue, in V. [mag]"""

_TABLE = Path(__file__).parents[1] / "data" / "night" / "stars.npy"


class Catalogue(NamedTuple):
    """Stars in the order of their brightness.

    Attributes
    ----------
    places : ndarray of float64, shape (n, 2)
        Right ascension and declination at J2000. [rad]
    motions : ndarray of float64, shape (n, 2)
        Proper motion toward east and north, 0 of all but 116 bright stars. [rad/yr]
    v, b_v : ndarray of float64, shape (n,)
        Magnitude and colour of Johnson's system. [mag]
    """

    places: Array
    motions: Array
    v: Array
    b_v: Array

    def brighter_than(self, faintest: float) -> Catalogue:
        """Return the stars up to a magnitude V."""
        count = int(np.searchsorted(self.v, faintest, side="right"))
        return Catalogue(*(column[:count] for column in self))


@cache
def load_catalogue() -> Catalogue:
    """Return all 8874 stars, see docs/derivations/stars.py for their origin."""
    table = np.load(_TABLE, allow_pickle=False)

    def columns(*names: str) -> Array:
        stacked: Array = np.stack([table[name].astype(np.float64) for name in names], axis=-1)
        stacked.flags.writeable = False
        return stacked

    return Catalogue(
        columns("right_ascension", "declination"),
        columns("proper_motion_east", "proper_motion_north"),
        columns("v")[:, 0],
        columns("b_v")[:, 0],
    )
