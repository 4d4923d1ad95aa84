"""How far from a point there is no cloud, so that a ray may step over what is empty."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.surface import AT_BASE
from skybake.jit.kernel import inlined_kernel, kernel


def block_clearance(
    is_cloudy: npt.NDArray[np.bool_], block: npt.NDArray[np.float64]
) -> npt.NDArray[np.float32]:
    """Return the distance from every block to the nearest that may hold cloud.

    Parameters
    ----------
    is_cloudy : ndarray of bool, shape (z, y, x)
        Blocks that may hold cloud; periodic in y and x.
    block : ndarray of float64, shape (3,)
        Size of a block along z, y and x. [km]

    Returns
    -------
    ndarray of float32, shape (z, y, x)
        Between the nearest points of two blocks. [km]
    """
    squared = np.where(is_cloudy, 0.0, np.inf)
    for axis, size in enumerate(block):
        squared = _nearest_along(squared, axis, float(size), is_periodic=axis > 0)
    # A field without cloud is clear as far as its own period.
    farthest = float(np.max(block * is_cloudy.shape))
    return np.minimum(np.sqrt(squared), farthest).astype(np.float32)


def blocks_of(
    cells: npt.NDArray[np.bool_], spacing: npt.NDArray[np.float64], cells_per_block: tuple[int, ...]
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.float64]]:
    """Return which blocks hold a cell that is set, and the blocks' size. [km]"""
    block = np.empty(3)
    for axis, (size, step) in enumerate(zip(cells.shape, cells_per_block, strict=True)):
        count = max(1, round(size / step))
        edges = [(b * size / count, (b + 1) * size / count) for b in range(count)]
        slices = [slice(int(first), int(np.ceil(last - 1e-9))) for first, last in edges]
        taken = np.moveaxis(cells, axis, 0)
        cells = np.moveaxis(np.stack([taken[each].any(0) for each in slices]), 0, axis)
        block[axis] = spacing[axis] * size / count
    return cells, block


def _nearest_along(
    squared: npt.NDArray[np.float64], axis: int, size: float, *, is_periodic: bool
) -> npt.NDArray[np.float64]:
    count = squared.shape[axis]
    values = np.moveaxis(squared, axis, 0)
    nearest = values.copy()
    for offset in range(1, count // 2 + 1 if is_periodic else count):
        gap = (size * (offset - 1)) ** 2
        if is_periodic:
            for turned in (np.roll(values, offset, 0), np.roll(values, -offset, 0)):
                np.minimum(nearest, turned + gap, out=nearest)
        else:
            nearest[offset:] = np.minimum(nearest[offset:], values[:-offset] + gap)
            nearest[:-offset] = np.minimum(nearest[:-offset], values[offset:] + gap)
    return np.moveaxis(nearest, 0, axis)


@kernel
def voxel_clearance(field, x, y, altitude):
    """Distance from a point to the nearest block with voxels that are not empty. [km]"""
    return _outside(field, altitude) or _of_block(field, x, y, altitude)


@inlined_kernel
def surface_clearance(field, x, y, altitude, blur, detail):
    """Distance from a point to where displacement and blur may carry the surface. [km]"""
    outside = _outside(field, altitude)
    if outside > 0.0:
        return outside
    _, width, coarse, middle, fine, along_x, along_y, along_z = detail
    below = field.condensation - altitude - 0.5 * width - AT_BASE * (coarse + middle + fine)
    if blur > field.near_blur:
        return max(_of_block(field, x, y, altitude), below)
    levels, rows, columns = field.near_clearance.shape
    x, y = x * along_x, y * along_y
    i, j = (x - math.floor(x)) * columns, (y - math.floor(y)) * rows
    k = min((altitude - field.base) * along_z, levels - 0.5)
    i, j = min(i, columns - 0.5), min(j, rows - 0.5)
    clear = np.int32(field.near_clearance[np.uint32(k), np.uint32(j), np.uint32(i)])
    return max(field.near_unit * clear, below)


@kernel
def _outside(field, altitude):
    """Height above or below the layer, 0 within. [km]"""
    return max(altitude - field.top, field.base - altitude, 0.0)


@kernel
def _of_block(field, x, y, altitude):
    levels, rows, columns = field.clearance.shape
    fx, fy = x / field.period[0], y / field.period[1]
    i, j = (fx - math.floor(fx)) * columns, (fy - math.floor(fy)) * rows
    k = min(max((altitude - field.base) / field.block[0], 0.0), levels - 0.5)
    i, j = min(i, columns - 0.5), min(j, rows - 0.5)
    return float(field.clearance[np.uint32(k), np.uint32(j), np.uint32(i)])
