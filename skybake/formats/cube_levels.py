"""Cubemaps in memory, as files with six faces in one take them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

Level = npt.NDArray[np.float32]


def check_levels(levels: Sequence[Level]) -> int:
    """Check the shapes of a cubemap's levels.

    Parameters
    ----------
    levels : sequence of ndarray, shape (6, n >> k, n >> k, 3)
        The largest first; not all levels down to one texel need be there.

    Returns
    -------
    int
        Edge of the largest. [pixel]

    Raises
    ------
    ValueError
        If the shapes are others.
    """
    edge = levels[0].shape[1] if len(levels) and levels[0].ndim == 4 else 0
    for k, level in enumerate(levels):
        if level.shape != (6, edge >> k, edge >> k, 3) or not edge >> k:
            raise ValueError(
                f"level {k} of a cubemap must have the shape (6, {edge >> k}, {edge >> k}, 3), "
                f"got {level.shape}"
            )
    if not edge:
        raise ValueError("a cubemap must have a level, got none")
    return edge
