"""Voxels merged by two along every axis."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]


def merge_pairs(values: Floats) -> Floats:
    """Means of each two values along every axis; an odd last plane in z is joined by nothing."""
    levels, rows, columns = values.shape
    if levels % 2:
        values = np.concatenate([values, np.zeros((1, rows, columns), values.dtype)])
    blocks = values.reshape((levels + 1) // 2, 2, rows // 2, 2, columns // 2, 2)
    merged: Floats = blocks.mean(axis=(1, 3, 5), dtype=np.float32)
    return merged


def merge_levels(light: Array, levels: int) -> Array:
    """Means of each two levels of light, (channel, z); a lone last one is its own mean."""
    padded = np.concatenate([light, light[:, -1:]], axis=1) if light.shape[1] % 2 else light
    merged: Array = padded.reshape(len(light), levels, 2).mean(axis=2)
    return merged
