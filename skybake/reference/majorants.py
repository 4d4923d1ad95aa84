"""Upper bounds of extinction around a place: what null collisions are drawn with."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.cloud_fields.chart import chart_stretch, plane_place
from skybake.cloud_fields.field import LINEAR, SURFACE, CloudField
from skybake.cloud_fields.patches import matters, patch_shift, patches_around, room_within
from skybake.cloud_fields.surface import STEP
from skybake.jit.kernel import kernel
from skybake.reference.air import Air

CELL = 0.2
"""Size of cells where voxels are smaller. [km]"""

FARTHEST = 8
"""Cells that a step through clear air may cross at most."""

_ROUNDING = 1.0 + 1e-6


class CloudBounds(NamedTuple):
    """Upper bounds of a layer's extinction in cells, with a plane of cells below and above it.

    Attributes
    ----------
    extinction : ndarray of float64, shape (z, y, x)
        Bound within `reach` of every point of a cell. [km⁻¹]
    reach : ndarray of float64, shape (z, y, x)
        In kilometres of the tile.
    cell : ndarray of float64, shape (3,)
        Size along z, y and x. [km]
    base : float
        Altitude of the second plane's lower faces. [km]
    """

    extinction: npt.NDArray[np.float64]
    reach: npt.NDArray[np.float64]
    cell: npt.NDArray[np.float64]
    base: float


def bound_clouds(field: CloudField) -> CloudBounds:
    """Bound a layer's extinction from above."""
    most, base = _most_in_voxels(field), float(field.base)
    if field.kind == LINEAR:
        # The outermost planes of voxels fade out beyond their faces, half a voxel of it in `base`.
        most = _dilate(np.pad(most, ((1, 1), (0, 0), (0, 0))))
        base -= 0.5 * float(field.spacing[0])
    steps = [_voxels_per_cell(n, size) for n, size in zip(most.shape, field.spacing, strict=True)]
    # A last cell in z may reach beyond the voxels: rows and columns have to divide evenly.
    steps[0] = max(1, round(CELL / field.spacing[0]))
    most = np.pad(most, ((0, -most.shape[0] % steps[0]), (0, 0), (0, 0)))
    shape = [size for n, step in zip(most.shape, steps, strict=True) for size in (n // step, step)]
    cells = np.pad(most.reshape(shape).max(axis=(1, 3, 5)), ((1, 1), (0, 0), (0, 0)))
    cell = field.spacing * steps
    bound = _dilate(cells)
    reach = np.full(cells.shape, cell.min())
    around = bound
    for n in range(2, FARTHEST + 1):
        around = _dilate(around)
        reach[around == 0.0] = n * cell.min()
    return CloudBounds(_ROUNDING * bound, reach, cell, base)


def _most_in_voxels(field: CloudField) -> npt.NDArray[np.float64]:
    """Extinction of each voxel, or its bound between nodes of a surface."""
    if field.kind != SURFACE:
        return field.values.astype(np.float64)
    width = min(field.edge, field.widest_edge)
    inside = np.maximum(field.extinction[:-1], field.extinction[1:])[:, None, None]
    bound: npt.NDArray[np.float64] = inside * np.clip(0.5 - _least_distance(field) / width, 0, 1)
    return bound


def _least_distance(field: CloudField) -> npt.NDArray[np.float64]:
    """Least distance to the displaced surface in each voxel, whose corners are nodes. [km]"""
    least = np.minimum(field.distance[:-1], field.distance[1:])
    for axis in (1, 2):
        least = np.minimum(least, np.roll(least, -1, axis))
    swing = float(np.abs(field.displacement[:, 0]).sum())
    return least * STEP - float(field.shift[0]) - swing


def _voxels_per_cell(count: int, size: float) -> int:
    """Return the largest divisor of `count` that keeps cells within `CELL`, at least 1."""
    most = max(1, round(CELL / size))
    return max(n for n in range(1, min(most, count) + 1) if count % n == 0)


def _dilate(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Maximum over neighbours, periodic in y and x; there is nothing below and above."""
    padded = np.pad(values, ((1, 1), (0, 0), (0, 0)))
    most = np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
    for axis in (1, 2):
        most = np.maximum(most, np.maximum(np.roll(most, 1, axis), np.roll(most, -1, axis)))
    return most


@kernel
def cloud_bound(field, bounds, radius, x, y, z, h):
    """Bound of a layer's extinction around a place [km⁻¹], and the distance it holds for [km]."""
    levels = bounds.extinction.shape[0]
    k = math.floor((h - bounds.base) / bounds.cell[0]) + 1
    if k < 0:
        return 0.0, bounds.base - h
    if k >= levels:
        return 0.0, h - bounds.base - (levels - 2) * bounds.cell[0]
    plane_x, plane_y = plane_place(field, radius, x, y, z)
    if field.patch == 0.0:
        most, reach = _bound_in_tile(bounds, k, plane_x, plane_y)
    else:
        most, reach = _bound_in_patches(field, bounds, k, plane_x, plane_y)
    # The plane's stretch changes by far less than this on the way.
    return most, 0.99 * reach / chart_stretch(field, radius, x, y, z)


@kernel
def _bound_in_patches(field, bounds, k, x, y):
    """Bound around a place of the plane, and the distance on it that it holds for."""
    ai, aj, a, bi, bj, b, ci, cj, c = patches_around(field, x, y)
    largest = max(a, b, c)
    most, reach = 0.0, room_within(field, 0.0, largest)
    for n in range(3):
        if n == 0:
            i, j, share = ai, aj, a
        elif n == 1:
            i, j, share = bi, bj, b
        else:
            i, j, share = ci, cj, c
        if not matters(share, largest):
            reach = min(reach, room_within(field, share, largest))
            continue
        east, north = patch_shift(field, i, j)
        bound, distance = _bound_in_tile(bounds, k, x + east, y + north)
        most = max(most, bound)
        reach = min(reach, distance)
    return most, reach


@kernel
def _bound_in_tile(bounds, k, x, y):
    _, rows, columns = bounds.extinction.shape
    j = math.floor(y / bounds.cell[1]) % rows
    i = math.floor(x / bounds.cell[2]) % columns
    return bounds.extinction[k, j, i], bounds.reach[k, j, i]


def air_peaks(air: Air) -> npt.NDArray[np.float64]:
    """Greatest extinction of the air among 2ⁿ nodes from each on; shape (n, node). [km⁻¹]"""
    rows = [air.extinction]
    while 2 ** len(rows) <= len(air.extinction):
        last = rows[-1]
        half = 2 ** (len(rows) - 1)
        rows.append(np.maximum(last, np.append(last[half:], np.zeros(half))))
    return np.array(rows)


@kernel
def air_bound(air, peaks, low, high):
    """Bound of the air's extinction between two altitudes. [km⁻¹]"""
    last = len(air.altitude) - 1
    top = air.altitude[-1]
    # Nodes are quadratic; one more on each side covers rounding.
    first = max(int(math.sqrt(max(low, 0.0) / top) * last) - 1, 0)
    end = min(int(math.sqrt(min(high, top) / top) * last) + 2, last)
    first = min(first, end)
    row = 0
    while 2 << row <= end - first + 1:
        row += 1
    return max(peaks[row, first], peaks[row, end + 1 - (1 << row)])
