"""Pixels of a row between two that look alike, which need no rays of their own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from skybake.jit.arguments import flatten
from skybake.jit.kernel import kernel
from skybake.jit.workers import Workers
from skybake.optics.medium import Array

Floats = npt.NDArray[np.float32]

_WIDE = 3.0
"""By how much more the pixels beyond two may differ from them, relative to what the two may."""

_NEAR = 2.5
"""Distance of the two at most, in sizes of a pixel: they are neighbours of the one between."""

_COARSEST = 0.004
"""Size of pixels above which each is seen: neighbours may be alike by chance. [rad]"""

_ROWS = 4
"""Rows that a thread takes at a time."""

_BLOCK = 16, 64
"""Rows and columns of pixels that are seen one after the other: they see the same clouds."""

See = Callable[[npt.NDArray[np.intp]], tuple[Floats, Floats]]


def see_rows(
    see: See, directions: Array, extent: Array, clear: Floats, tolerance: float, workers: Workers
) -> tuple[Floats, Floats]:
    """See the pixels of rows, every other of them where it differs from both its neighbours' mean.

    Parameters
    ----------
    see : callable
        Takes the numbers of pixels, row by row, and returns what `Cloudscape.see` does for them.
    directions : ndarray of float64, shape (row, column, 3)
        Unit vectors.
    extent : ndarray of float64, shape (row, column)
        Sizes of pixels. [rad]
    clear : ndarray of float32, shape (row, column, channel)
        Light without clouds.
    tolerance : float
        Difference of two pixels in light and in what passes, relative to all light, up to which
        that between them is their mean; so must those beyond be alike, less exactly.
    workers : Workers
        Threads that do the work.

    Returns
    -------
    seen, passing : ndarray of float32
        Of all pixels, as `Cloudscape.see` returns them.

    Notes
    -----
    Pixels depend on their row alone: maps may be made in bands.
    """
    rows, columns = extent.shape
    if columns < 3 or tolerance <= 0.0:
        return see(np.arange(rows * columns))
    order = _by_blocks(rows, columns)
    is_first = np.zeros((rows, columns), np.bool_)
    is_first[:, ::2] = is_first[:, -1] = True
    at = order[is_first.ravel()[order]]
    some_seen, some_passing = see(at)
    layers, _, channels = some_seen.shape
    seen = np.empty((layers, rows * columns, channels), np.float32)
    passing = np.empty((layers, rows * columns, 3), np.float32)
    seen[:, at], passing[:, at] = some_seen, some_passing
    is_due = np.zeros(rows * columns, np.bool_)
    flat = [flatten(np.ascontiguousarray(each)) for each in (directions, extent, clear)]

    def work(begin: int, end: int) -> None:
        fill_between(*flat, tolerance, begin, end, seen, passing, is_due)

    workers.run_rows(rows, work, chunk=_ROWS)
    rest = order[is_due[order]]
    seen[:, rest], passing[:, rest] = see(rest)
    return seen, passing


def _by_blocks(rows: int, columns: int) -> npt.NDArray[np.intp]:
    """Return the numbers of all pixels block by block."""
    every = np.arange(rows * columns).reshape(rows, columns)
    high, wide = _BLOCK
    blocks = [
        every[j : j + high, i : i + wide].ravel()
        for j in range(0, rows, high)
        for i in range(0, columns, wide)
    ]
    return np.concatenate(blocks)


@kernel
def fill_between(directions, extent, clear, tolerance, first, last, seen, passing, is_due):
    """Write the pixels that are the mean of two, and note which are not.

    Parameters
    ----------
    directions, extent, clear, tolerance
        As of `see_rows`.
    first, last : int
        Rows to do.
    seen, passing : ndarray of float32
        Of which those of even columns are known.
    is_due : ndarray of bool, shape (row * column,)
        Receives which others must be seen.
    """
    _, columns = extent.shape
    layers, _, channels = seen.shape
    for j in range(first, last):
        start = j * columns
        for i in range(1, columns - 1, 2):
            n = start + i
            reach = _NEAR * extent[j, i]
            apart = 0.0
            for axis in range(3):
                apart += (directions[j, i + 1, axis] - directions[j, i - 1, axis]) ** 2
            is_due[n] = True
            is_coarse = extent[j, i] > _COARSEST or apart > reach * reach
            if is_coarse or i < 3 or i + 3 >= columns:
                continue
            light = clear[j, i]
            if not _alike(seen, passing, light, n - 1, n + 1, tolerance):
                continue
            wide = _WIDE * tolerance
            if not _alike(seen, passing, light, n - 3, n - 1, wide):
                continue
            if not _alike(seen, passing, light, n + 1, n + 3, wide):
                continue
            is_due[n] = False
            for k in range(layers):
                for c in range(channels):
                    seen[k, n, c] = 0.5 * (seen[k, n - 1, c] + seen[k, n + 1, c])
                left, right = 1.0 - passing[k, n - 1, 0], 1.0 - passing[k, n + 1, 0]
                for c in range(2):
                    passing[k, n, c] = 0.5 * (passing[k, n - 1, c] + passing[k, n + 1, c])
                passing[k, n, 2] = 0.0
                if left + right > 0.0:
                    # Distances count where there is something.
                    both = left * passing[k, n - 1, 2] + right * passing[k, n + 1, 2]
                    passing[k, n, 2] = both / (left + right)


@kernel
def _alike(seen, passing, clear, a, b, tolerance):
    """Whether two pixels have about the same light and let about the same pass, in every layer."""
    layers, _, channels = seen.shape
    for k in range(layers):
        for c in range(2):
            if abs(passing[k, a, c] - passing[k, b, c]) > tolerance:
                return False
        behind = min(passing[k, a, 0], passing[k, b, 0])
        for c in range(channels):
            low, high = seen[k, a, c], seen[k, b, c]
            if abs(high - low) > tolerance * (max(low, high) + behind * max(clear[c], 0.0)):
                return False
    return True
