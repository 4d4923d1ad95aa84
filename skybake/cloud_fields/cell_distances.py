"""Distances between cells of a tile, exact along straight lines."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from skybake.jit.kernel import kernel
from skybake.jit.workers import ALL_CPUS


def cell_distances(
    cells: npt.NDArray[np.uint8], spacing: npt.NDArray[np.float64], unit: float
) -> npt.NDArray[np.uint8]:
    """Return how far each cell is from the nearest that is marked, rounded down.

    Parameters
    ----------
    cells : ndarray of uint8, shape (z, y, x)
        1 for those that are marked, 0 for others; periodic in y and x.
    spacing : ndarray of float64, shape (3,)
        Of cells along z, y and x. [km]
    unit : float
        Of the result. [km]

    Returns
    -------
    ndarray of uint8, shape (z, y, x)
        Between the nearest points of two cells, 255 where it is farther. [`unit`]
    """
    levels, rows = cells.shape[:2]
    dz, dy, dx = (float(each) for each in spacing)
    farthest = 255.0 * unit
    along = np.empty(cells.shape, np.float32)
    flat = np.empty(cells.shape, np.float32)
    out = np.empty(cells.shape, np.uint8)

    def first(begin: int, end: int) -> None:
        _along_x(cells, dx, farthest, along, begin, end)
        _along_y(along, dy, farthest, flat, begin, end)

    def then(begin: int, end: int) -> None:
        _along_z(flat, dz, farthest, unit, along, out, begin, end)

    ALL_CPUS.run_rows(levels, first, chunk=2)
    ALL_CPUS.run_rows(rows, then, chunk=16)
    return out


@kernel
def _along_x(cells, step, farthest, squared, first, last):
    """Write the square of the distance within rows, which are periodic."""
    _, rows, columns = cells.shape
    for k in range(first, last):
        for j in range(rows):
            row = squared[k, j]
            gap = farthest
            for n in range(2 * columns):
                i = n if n < columns else n - columns
                row[i] = 0.0 if cells[k, j, i] else gap * gap
                gap = 0.0 if cells[k, j, i] else min(gap + step, farthest)
            gap = farthest
            for n in range(2 * columns - 1, -1, -1):
                i = n if n < columns else n - columns
                row[i] = min(row[i], gap * gap)
                gap = 0.0 if cells[k, j, i] else min(gap + step, farthest)


@kernel
def _along_y(squared, step, farthest, nearest, first, last):
    """Write the same across rows, which are periodic."""
    _, rows, columns = squared.shape
    offsets = min(int(farthest / step) + 1, rows // 2)
    for k in range(first, last):
        for j in range(rows):
            row = nearest[k, j]
            for i in range(columns):
                row[i] = squared[k, j, i]
            for offset in range(1, offsets + 1):
                gap = np.float32((offset - 1) * step * (offset - 1) * step)
                low = squared[k, j - offset if j >= offset else j - offset + rows]
                high = squared[k, j + offset if j + offset < rows else j + offset - rows]
                for i in range(columns):
                    row[i] = min(row[i], min(low[i], high[i]) + gap)


@kernel
def _along_z(squared, step, farthest, unit, nearest, out, first, last):
    """Write the same across planes, and the distance in units."""
    levels, _, columns = squared.shape
    for j in range(first, last):
        for k in range(levels):
            row = nearest[k, j]
            for i in range(columns):
                row[i] = squared[k, j, i]
            for other in range(levels):
                apart = max(abs(other - k) - 1, 0) * step
                if apart > farthest:
                    continue
                gap = np.float32(apart * apart)
                values = squared[other, j]
                for i in range(columns):
                    row[i] = min(row[i], values[i] + gap)
            for i in range(columns):
                out[k, j, i] = min(int(math.sqrt(row[i]) / unit), 255)
