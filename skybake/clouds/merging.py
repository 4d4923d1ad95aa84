"""Voxels merged by two along every axis, and what is known of them spread again."""

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


def spread_pairs(coarse: Floats, out: Floats) -> None:
    """Interpolate moments (z, y, harmonic, x) of merged voxels linearly to the voxels."""
    for axis, is_periodic in ((0, False), (1, True), (3, True)):
        coarse = _spread_axis(coarse, axis, out.shape[axis], is_periodic=is_periodic)
    out[...] = coarse


def _spread_axis(values: Floats, axis: int, size: int, *, is_periodic: bool) -> Floats:
    place = (np.arange(size) + 0.5) / 2.0 - 0.5
    low = np.floor(place).astype(int)
    share = (place - low).astype(np.float32)
    count = values.shape[axis]
    if is_periodic:
        pair = low % count, (low + 1) % count
    else:
        pair = np.clip(low, 0, count - 1), np.clip(low + 1, 0, count - 1)
    share = share.reshape([-1 if each == axis else 1 for each in range(values.ndim)])
    a, b = (np.take(values, each, axis=axis) for each in pair)
    spread: Floats = a + share * (b - a)
    return spread
