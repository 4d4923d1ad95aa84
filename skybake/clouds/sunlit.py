"""What clouds leave of the sunlight that the air scatters once."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.clouds.airlight import TINY, AirTable
from skybake.clouds.compose import compose
from skybake.jit.arguments import flatten
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

_OF_OTHER_LIGHT = ("diffuse", "sunlit", "skylit", "ground", "glow")


def sunlit_share(table: AirTable) -> AirTable:
    """Return a table of light that the air scattered once, relative to all of that alone."""
    dark = {name: np.zeros_like(getattr(table, name)) for name in _OF_OTHER_LIGHT}
    single = table.single / np.maximum(table.single[:, -1:], TINY)
    return table._replace(single=single, **dark)


def seen_share(
    nodes: tuple[Floats, Floats, Array],
    places: tuple[npt.NDArray[np.int64], Array],
    passing: Floats,
) -> Floats:
    """Return what clouds leave of it in the light of pixels, shape (ray, channel).

    Parameters
    ----------
    nodes : tuple of ndarray
        `Cloudscape.sunlit_air`, and `through` and distances as of `Cloudscape.nodes`.
    places : tuple of ndarray, shape (ray, 4)
        As of `Cloudscape.find_places`.
    passing : ndarray of float32, shape (layer, ray, 3)
        As of `Cloudscape.see`.
    """
    lit, through, distance = nodes
    row, weight = places
    layers, count, channels = *passing.shape[:2], lit.shape[2]
    share = np.empty((count, channels), np.float32)
    whole, dark = np.ones_like(share), np.zeros((layers, count, channels), np.float32)
    given = [flatten(each) for each in (whole, row, weight, distance, lit, through, dark)]
    compose(*given, passing, 0, count, share, np.empty(count, np.float32))
    return share
