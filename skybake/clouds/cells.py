"""Voxels of a layer that are swept, in chunks, and light in them."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from skybake.clouds.transfer import Floats, Voxels
from skybake.jit.kernel import kernel

CHUNK = 192
"""Cells that are worked on together at most: what they hold stays in the cache meanwhile."""


class Cells(NamedTuple):
    """Some of the voxels of a tile, in the order of z, y and x.

    Attributes
    ----------
    rows, columns : int
        Of the tile, along y and x.
    is_whole : bool
        Whether these are all voxels, in chunks of a row.
    chunks : ndarray of int64, shape (z + 1,)
        Where the chunks of each plane begin, and where those of the last end.
    first : ndarray of int64, shape (chunk + 1,)
        Where the cells of each chunk begin, and where those of the last end.
    row, column : ndarray of int32, shape (cell,)
        Place of each in its plane.
    extinction : ndarray of float32, shape (cell,)
        Without forward peaks. [km⁻¹]
    beam : ndarray of float32, shape (cell,)
        Mean of the sun's beam.
    """

    rows: int
    columns: int
    is_whole: bool
    chunks: npt.NDArray[np.int64]
    first: npt.NDArray[np.int64]
    row: npt.NDArray[np.int32]
    column: npt.NDArray[np.int32]
    extinction: Floats
    beam: Floats


def all_cells(voxels: Voxels) -> Cells:
    """Return all voxels, in chunks of a row, so that moments (z, y, harmonic, x) are theirs."""
    levels, rows, columns = voxels.extinction.shape
    place = np.arange(rows * columns, dtype=np.int32)
    return Cells(
        rows,
        columns,
        True,
        np.arange(levels + 1) * rows,
        np.arange(levels * rows + 1) * columns,
        np.tile(place // columns, levels),
        np.tile(place % columns, levels),
        voxels.extinction.reshape(-1),
        voxels.beam.reshape(-1),
    )


def cloudy_cells(voxels: Voxels) -> Cells:
    """Return the voxels in which there is cloud."""
    extinction = voxels.extinction.reshape(-1)
    levels, rows, columns = voxels.extinction.shape
    at = np.flatnonzero(extinction > 0.0)
    planes = np.searchsorted(at, np.arange(levels + 1) * rows * columns)
    begins = [np.arange(begin, end, CHUNK) for begin, end in itertools.pairwise(planes.tolist())]
    chunks = np.cumsum([0, *(each.size for each in begins)])
    place = at % (rows * columns)
    return Cells(
        rows,
        columns,
        False,
        chunks,
        np.concatenate([*begins, planes[-1:]]),
        (place // columns).astype(np.int32),
        (place % columns).astype(np.int32),
        extinction[at],
        voxels.beam.reshape(-1)[at],
    )


@kernel
def spread_moments(cells, coarse, out):
    """Interpolate moments (z, y, harmonic, x) of voxels merged by two linearly to cells.

    `out` receives those of each chunk as (harmonic, cell).
    """
    levels, rows, harmonics, columns = coarse.shape
    for k in range(cells.chunks.size - 1):
        a, w = _below(k)
        low, high = max(a, 0), min(a + 1, levels - 1)
        for chunk in range(cells.chunks[k], cells.chunks[k + 1]):
            begin, end = cells.first[chunk], cells.first[chunk + 1]
            for p in range(harmonics):
                values = out[begin * harmonics + p * (end - begin) :]
                for n in range(end - begin):
                    j, v = _below(cells.row[begin + n])
                    i, u = _below(cells.column[begin + n])
                    south, north = j % rows, (j + 1) % rows
                    west, east = i % columns, (i + 1) % columns
                    total = np.float32(0.0)
                    for level, share in ((low, np.float32(1.0) - w), (high, w)):
                        here = coarse[level, south, p]
                        there = coarse[level, north, p]
                        one = here[west] + u * (here[east] - here[west])
                        other = there[west] + u * (there[east] - there[west])
                        total += share * (one + v * (other - one))
                    values[n] = total


@kernel
def _below(place):
    """Return the merged voxel whose middle is next below a voxel's, and the share of the other."""
    if place % 2:
        return (place - 1) // 2, np.float32(0.25)
    return place // 2 - 1, np.float32(0.75)


@kernel
def put_moments(cells, taken, moments):
    """Write moments of cells, each chunk as (harmonic, cell), to those of (z, y, harmonic, x)."""
    levels, _, harmonics, _ = moments.shape
    for k in range(levels):
        for chunk in range(cells.chunks[k], cells.chunks[k + 1]):
            begin, end = cells.first[chunk], cells.first[chunk + 1]
            for p in range(harmonics):
                values = taken[begin * harmonics + p * (end - begin) :]
                for n in range(end - begin):
                    j, i = cells.row[begin + n], cells.column[begin + n]
                    moments[k, j, p, i] = values[n]


@kernel
def mean_change(cells, harmonics, before, after):
    """Relative change of the mean radiance in cells between two states of them."""
    change = total = 0.0
    for chunk in range(cells.first.size - 1):
        begin, end = cells.first[chunk], cells.first[chunk + 1]
        old, new = before[begin * harmonics :], after[begin * harmonics :]
        for n in range(end - begin):
            change += abs(new[n] - old[n])
            total += abs(new[n])
    return change / max(total, 1e-30)
