"""Lookup of tables in numpy, as a graphics processor does it: to judge them by."""

from __future__ import annotations

from collections.abc import Mapping as Values

import numpy as np
import numpy.typing as npt

from skybake.luts.constants import Constants
from skybake.luts.table import Table, Texels
from skybake.optics.medium import Array


def sample(values: Texels, coordinates: tuple[Array, ...]) -> Array:
    """Read a texture, with a linear filter and its edges extended.

    Parameters
    ----------
    values : ndarray of float32, shape (height, width, channel) or (depth, height, width, channel)
        The texture.
    coordinates : tuple of ndarray of float64, broadcast to shape (...)
        Along the width, the height and the depth, 0 to 1 over the whole texture.

    Returns
    -------
    ndarray of float64, shape (..., channel)
    """
    found: Array = values.astype(np.float64)
    low, share = [], []
    for coordinate, size in zip(coordinates, values.shape[-2::-1], strict=True):
        place = np.clip(coordinate * size - 0.5, 0.0, size - 1.0)
        low.append(np.minimum(place.astype(np.int64), size - 2))
        share.append(place - low[-1])
    total: Array = np.zeros(())
    for corner in np.ndindex(*(2,) * len(low)):
        weights = (one if up else 1.0 - one for one, up in zip(share, corner, strict=True))
        nodes = tuple(one + up for one, up in zip(low, corner, strict=True))
        weight = np.prod(np.broadcast_arrays(*weights), axis=0)
        total = total + weight[..., None] * found[nodes[::-1]]
    return total


def look_up(table: Table, constants: Constants, inputs: Values[str, npt.ArrayLike]) -> Array:
    """Look a table up by what it is a table of.

    Parameters
    ----------
    table : Table
        The table.
    constants : Constants
        Those of its set.
    inputs : mapping of str to array_like
        By the names of its mapping's inputs.

    Returns
    -------
    ndarray of float64, shape (..., channel)
    """
    numbers = {
        name: value for name, (value, _) in constants.items() if not isinstance(value, tuple)
    }
    return sample(table.values, table.mapping.coordinates(table.size, {**numbers, **inputs}))
