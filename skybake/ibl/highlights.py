"""Small bright spots of a map, such as its sun, taken out of it as points of light.

Samples of a lobe would meet a spot of a few texels by chance, some texels of the result would
flash, and the spot's light would not be kept. Points are convolved exactly instead. What is
taken out of a texel is its excess over the median of the texels around, so that the two together
are the map. Light is neither clamped nor lost.
"""

from __future__ import annotations

import numpy as np

from skybake.ibl.cube import Cube, texel_directions, texel_sizes
from skybake.ibl.points import Points, no_points

BLOCKS = 32
"""Blocks along a face's edge, each with a median of its own: 2.8 degrees on average."""

EXCESS = 4.0
"""A texel of a spot, over the median around it."""

NOTABLE = 1e-5
"""Of all light: the least excess of a block that is taken out. The lobe of a point with so much
stands out of the sharpest filtered level by 1 %."""

MOST = 1024
"""Points, the strongest ones; the rest stays in the map."""


def split_highlights(cube: Cube) -> tuple[Cube, Points]:
    """Return a cube without its small bright spots, and these.

    Parameters
    ----------
    cube : ndarray of float32, shape (6, n, n, 3)
        All light; n is a power of 2.
    """
    edge = cube.shape[1]
    size = edge // min(BLOCKS, edge // 2)
    count = edge // size
    level = cube.sum(axis=-1)
    blocks = _blocks(level, count, size)
    middle = np.median(blocks, axis=-1)
    sizes = np.broadcast_to(texel_sizes(edge).astype(np.float32), level.shape)
    excess = _blocks(sizes, count, size) * np.maximum(blocks - EXCESS * middle[..., None], 0.0)
    notable = excess.sum(axis=-1) > NOTABLE * float((level * sizes).sum(dtype=np.float64))
    spots = (excess > 0.0) & notable[..., None]
    if not spots.any():
        return cube, no_points()
    block = np.argwhere(spots)
    if len(block) > MOST:
        strongest = np.argsort(-excess[spots], kind="stable")[:MOST]
        block = block[np.sort(strongest)]
    face, row, column, within = block.T
    y, x = row * size + within // size, column * size + within % size
    colours = _blocks(cube, count, size)[face, row, column]
    rest = np.median(colours, axis=1)
    flux = (cube[face, y, x].astype(np.float64) - rest) * sizes[face, y, x, None]
    smooth = cube.copy()
    smooth[face, y, x] = rest
    return smooth, Points(texel_directions(edge)[face, y, x].astype(np.float64), flux)


def _blocks(values: Cube, count: int, size: int) -> Cube:
    """Cut faces into blocks, shape (6, count, count, size * size, ...)."""
    rest = values.shape[3:]
    cut = values.reshape(6, count, size, count, size, *rest)
    return np.moveaxis(cut, 3, 2).reshape(6, count, count, size * size, *rest)
